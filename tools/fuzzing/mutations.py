"""Changes to a file: bytes, numbers in either byte order, words, and pieces that go, come twice or trade places."""

from __future__ import annotations

import re
from dataclasses import dataclass

from hypothesis import strategies as st

NUMBERS = (
    0,
    1,
    2,
    7,
    127,
    128,
    255,
    256,
    32767,
    32768,
    65535,
    2**24,
    2**31 - 1,
    2**31,
    2**32 - 1,
    2**63 - 1,
    2**64 - 1,
)
WORDS = (
    b"", b"0", b"-1", b"-0", b"1e999", b"1e308", b"-1e-400", b"NaN", b"Infinity", b"9" * 400, b"0.1" + b"1" * 300,
    b"null", b"true", b'""', b"[]", b"{}", b"[[]]", b"[" * 60, b'{"a":' * 40, b"]", b"}", b",", b":", b'"',
    b'"\\ud800"',
    b'"\\u0000"', b"\x00", b"\xff", b"\xef\xbb\xbf", b"\r\n", b"\n", b"../", b"/", b"..", b"%YAML:1.0", b"---", b"&a ",
    b"*a", b"<<: *a", b"!!python/object/apply:os.system ", b"!!opencv-matrix", b"|O", b"<f8", b"True", b"(", b")",
)  # fmt: skip
TOKEN = re.compile(rb'-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?|"[^"]*"|[A-Za-z_]+|[^\sA-Za-z0-9]')


@dataclass(frozen=True)
class Change:
    """One change.

    Attributes:
        kind: Which, see `changed`.
        place: Where, as a share of the content in 1/65536.
        size: Bytes concerned, or which of several.
        value: What comes there.
    """

    kind: str
    place: int
    size: int
    value: int


KINDS = ("byte", "bit", "cut", "repeat", "move", "number", "word", "token", "token", "end")
CHANGES = st.lists(
    st.builds(Change, st.sampled_from(KINDS), st.integers(0, 65535), st.integers(1, 40), st.integers(0, 65535)),
    min_size=1,
    max_size=5,
)


def changed(content: bytes, changes: list[Change]) -> bytes:
    """Return the content with the changes made, one after the other."""
    data = bytearray(content)
    for change in changes:
        at = change.place * len(data) >> 16
        piece = bytes(data[at : at + change.size])
        match change.kind:
            case "byte" if data:
                data[at] = change.value & 255
            case "bit" if data:
                data[at] ^= 1 << (change.value & 7)
            case "cut":
                del data[at : at + change.size]
            case "repeat":
                data[at:at] = piece * (1 + change.value % 30)
            case "move":
                del data[at : at + change.size]
                target = change.value * len(data) >> 16
                data[target:target] = piece
            case "number":
                width = (1, 2, 4, 8)[change.size % 4]
                number = NUMBERS[change.value % len(NUMBERS)] & (1 << 8 * width) - 1
                data[at : at + width] = number.to_bytes(width, ("little", "big")[change.size // 4 % 2])
            case "word":
                data[at:at] = WORDS[change.value % len(WORDS)]
            case "token":
                replace_token(data, change)
            case _:
                del data[at:]
    return bytes(data)


def replace_token(data: bytearray, change: Change) -> None:
    """Put a word in the place of a number, a name, a text or a sign."""
    found = list(TOKEN.finditer(bytes(data[:20_000])))
    if found:
        token = found[change.place * len(found) >> 16]
        data[token.start() : token.end()] = WORDS[change.value % len(WORDS)]
