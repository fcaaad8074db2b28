"""The first look at a pickle: opcode by opcode, nothing executed, everything not needed refused.

A pickle is a program for a stack machine. Of its 68 opcodes a NumPy object array of coordinates needs 39; the
others (calls by INST and OBJ, extension codes, persistent ids, DUP, long integers, out-of-band buffers, dicts and
sets) make a file suspicious enough to refuse it whole.
"""

from __future__ import annotations

import itertools
import pickletools
from collections.abc import Iterator
from typing import Any

from app.errors import InvalidFile, TooLarge

INTEGERS = frozenset({"INT", "BININT", "BININT1", "BININT2"})
ALLOWED = INTEGERS | {
    *("PROTO", "FRAME", "STOP", "MARK"),
    *("NONE", "NEWTRUE", "NEWFALSE", "FLOAT", "BINFLOAT"),
    *("UNICODE", "BINUNICODE", "SHORT_BINUNICODE", "BINBYTES", "SHORT_BINBYTES", "BYTEARRAY8"),
    *("EMPTY_TUPLE", "TUPLE", "TUPLE1", "TUPLE2", "TUPLE3", "EMPTY_LIST", "LIST", "APPEND", "APPENDS"),
    *("PUT", "BINPUT", "LONG_BINPUT", "MEMOIZE", "GET", "BINGET", "LONG_BINGET"),
    *("GLOBAL", "STACK_GLOBAL", "REDUCE", "BUILD"),
}
MEMO = frozenset({"PUT", "BINPUT", "LONG_BINPUT", "GET", "BINGET", "LONG_BINGET"})

OPCODE_LIMIT = 3_000_000
MEMO_LIMIT = 2_000_000
INTEGER_LIMIT = 2**31


def walk(data: bytes, *, where: str) -> Iterator[tuple[str, Any]]:
    """Decode a pickle opcode by opcode, refusing what a label file never holds.

    Args:
        data: The pickle, up to its end: bytes after STOP are refused too.
        where: The file, for messages.

    Yields:
        Name and argument of each opcode; nothing comes after STOP.

    Raises:
        InvalidFile: On an opcode outside the allowed set, a broken stream, trailing bytes.
        TooLarge: On too many opcodes.
    """
    opcodes = pickletools.genops(data)
    position = 0
    for count in itertools.count(1):
        try:
            opcode, argument, at = next(opcodes)
        except StopIteration:
            break
        except (ValueError, OverflowError, IndexError, Warning) as error:
            raise InvalidFile(
                "the pickle is broken or cut off",
                where=f"{where}: after byte {position} of the pickle",
                hint="copy or export the file again",
            ) from error
        position = at or 0
        if count > OPCODE_LIMIT:
            raise TooLarge("the pickle has too many steps", where=where, expected=f"at most {OPCODE_LIMIT:,}")
        _check(opcode.name, argument, f"{where}: byte {position} of the pickle")
        if opcode.name == "STOP" and position + 1 != len(data):
            raise InvalidFile("bytes follow after the end of the pickle", where=f"{where}: byte {position + 1} of it")
        yield opcode.name, argument


def _check(name: str, argument: Any, where: str) -> None:
    if name not in ALLOWED:
        raise InvalidFile(
            f"the pickle uses {name}, which no label file needs",
            where=where,
            expected="an object array of (n, 1, 2) coordinates",
            hint="save as .npz or .json instead",
        )
    if name in MEMO and not 0 <= argument < MEMO_LIMIT:
        raise InvalidFile(f"memo index {argument} is out of range", where=where, expected=f"0 to {MEMO_LIMIT - 1}")
    if name in INTEGERS and not -INTEGER_LIMIT <= argument < INTEGER_LIMIT:
        raise InvalidFile("an integer is out of range", where=where, expected="32 bits")
