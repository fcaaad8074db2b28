"""A stack machine that reads NumPy's pickles and can do nothing else.

It knows five names, each a stand-in that only records what it was given; no module is imported, no class looked up,
no attribute set, nothing called. So `pickle.Unpickler`, whose BUILD may change even a stand-in, isn't needed at all.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from app.errors import InvalidFile


@dataclass(frozen=True)
class InertName:
    """A global that the pickle names, as words."""

    module: str
    name: str


@dataclass
class InertType:
    """A NumPy dtype as the pickle describes it: ``code`` such as ``f8``, byte order ``<``, ``>``, ``=`` or ``|``."""

    code: str
    order: str = "="
    built: bool = False


@dataclass
class InertArray:
    """A NumPy array as the pickle describes it.

    Attributes:
        shape: The shape, unchecked.
        type: Its dtype.
        fortran: Whether ``data`` is in column-major order.
        data: Bytes of numbers, or the list of elements of an object array in row-major order.
    """

    shape: tuple[int, ...] = ()
    type: InertType | None = None
    fortran: bool = False
    data: bytes | bytearray | list[Any] | None = None


class _Mark:
    """Where a group of stack entries begins."""


NDARRAY = InertName("numpy", "ndarray")
DTYPE = InertName("numpy", "dtype")
ENCODE = InertName("_codecs", "encode")
RECONSTRUCT = tuple(InertName(f"numpy.{core}.multiarray", "_reconstruct") for core in ("core", "_core"))
FROM_BUFFER = tuple(InertName(f"numpy.{core}.numeric", "_frombuffer") for core in ("core", "_core"))
KNOWN = {NDARRAY, DTYPE, ENCODE, *RECONSTRUCT, *FROM_BUFFER}

_MARK = _Mark()

STACK_LIMIT = 10_000
"""Python's own writer appends to a list after a thousand elements."""
TUPLE_LIMIT = 16
"""The longest that NumPy writes is the state of a data type, with nine."""


def is_usable_shape(shape: tuple[Any, ...]) -> bool:
    """Whether these are the dimensions of an array that could exist: at most 8, their product below 2^40."""
    whole = len(shape) <= 8 and all(type(n) is int and n >= 0 for n in shape)
    return whole and math.prod(max(n, 1) for n in shape) < 2**40


def interpret(program: Iterable[tuple[str, Any]], *, encoded_limit: int, where: str) -> Any:
    """Run the opcodes of a pickle on stand-ins.

    Args:
        program: Name and argument of each opcode, as `app.formats.pickle_gate.walk` yields them.
        encoded_limit: Bytes that all latin-1 strings together may become; a real file needs no more than its own size.
        where: The file, for messages.

    Returns:
        What the pickle leaves: an `InertArray` if it is an array, else plain Python values.

    Raises:
        InvalidFile: If the pickle names anything unknown, or its steps make no sense.
    """
    machine = _Machine(encoded_limit, where)
    for name, argument in program:
        if name == "STOP":
            return machine.pop()
        machine.step(name, argument)
        if len(machine.stack) > STACK_LIMIT:
            raise machine.broken("too much waits to be used")
    raise InvalidFile("the pickle has no end", where=where)


class _Machine:
    def __init__(self, encoded_limit: int, where: str) -> None:
        self.stack: list[Any] = []
        self.memo: dict[int, Any] = {}
        self.encoded_left = encoded_limit
        self.where = where

    def step(self, name: str, argument: Any) -> None:
        match name:
            case "PROTO" | "FRAME":
                pass
            case "MARK":
                self.stack.append(_MARK)
            case "NONE":
                self.stack.append(None)
            case "NEWTRUE" | "NEWFALSE":
                self.stack.append(name == "NEWTRUE")
            case "EMPTY_TUPLE":
                self.stack.append(())
            case "EMPTY_LIST":
                self.stack.append([])
            case "TUPLE" | "LIST":
                items = self.pop_to_mark()
                self.stack.append(self.flat_tuple(items) if name == "TUPLE" else items)
            case "TUPLE1" | "TUPLE2" | "TUPLE3":
                items = [self.pop() for _ in range(int(name[-1]))]
                self.stack.append(self.flat_tuple(items[::-1]))
            case "APPEND":
                item = self.pop()
                self.top_list().append(item)
            case "APPENDS":
                items = self.pop_to_mark()
                self.top_list().extend(items)
            case "PUT" | "BINPUT" | "LONG_BINPUT":
                self.memo[argument] = self.top()
            case "MEMOIZE":
                self.memo[len(self.memo)] = self.top()
            case "GET" | "BINGET" | "LONG_BINGET":
                if argument not in self.memo:
                    raise self.broken("it refers to something it never stored")
                self.stack.append(self.memo[argument])
            case "GLOBAL":
                self.stack.append(self.known(*argument.split(" ", 1)))
            case "STACK_GLOBAL":
                name, module = self.pop(), self.pop()
                self.stack.append(self.known(module, name))
            case "REDUCE":
                arguments, name = self.pop(), self.pop()
                self.stack.append(self.reduce(name, arguments))
            case "BUILD":
                state = self.pop()
                self.build(self.top(), state)
            case _:  # the gate lets only opcodes through that push their argument
                self.stack.append(argument)

    def broken(self, why: str) -> InvalidFile:
        return InvalidFile(
            f"the pickle makes no sense: {why}", where=self.where, expected="an object array that numpy.save wrote"
        )

    def top(self) -> Any:
        if not self.stack or self.stack[-1] is _MARK:
            raise self.broken("a step finds nothing to work on")
        return self.stack[-1]

    def pop(self) -> Any:
        value = self.top()
        self.stack.pop()
        return value

    def pop_to_mark(self) -> list[Any]:
        for index in range(len(self.stack) - 1, -1, -1):
            if self.stack[index] is _MARK:
                items = self.stack[index + 1 :]
                del self.stack[index:]
                return items
        raise self.broken("a group ends that never began")

    def flat_tuple(self, items: list[Any]) -> tuple[Any, ...]:
        nested = (item for item in items if type(item) is tuple)
        if len(items) > TUPLE_LIMIT or any(type(inner) is tuple for item in nested for inner in item):
            raise self.broken("a tuple is too long, or nested too deep")
        return tuple(items)

    def top_list(self) -> list[Any]:
        if not isinstance(self.top(), list):
            raise self.broken("it appends to something that is no list")
        return self.stack[-1]

    def known(self, module: Any, name: Any) -> InertName:
        if isinstance(module, str) and isinstance(name, str) and InertName(module, name) in KNOWN:
            return InertName(module, name)
        raise InvalidFile(
            f"the pickle names {module!s:.80}.{name!s:.80}, which is not part of a coordinate array",
            where=self.where,
            expected="NumPy arrays only",
            hint="nothing of it was run; save as .npz or .json instead",
        )

    def reduce(self, name: Any, arguments: Any) -> Any:
        if isinstance(name, InertName):
            match name, arguments:
                case InertName("numpy", "dtype"), (str(code), bool() | 0 | 1, bool() | 0 | 1):
                    return InertType(code)
                case InertName("_codecs", "encode"), (str(text), "latin1" | "latin-1"):
                    return self.encode(text)
                case InertName(_, "_reconstruct"), (InertName("numpy", "ndarray"), (0,), b"b"):
                    return InertArray()
                case InertName(_, "_frombuffer"), (bytes() | bytearray() as data, InertType() as kind, shape, order):
                    return InertArray(self.shape(shape), kind, order == "F", data)
        raise self.broken("it calls something that is not called that way")

    def encode(self, text: str) -> bytes:
        self.encoded_left -= len(text)
        if self.encoded_left < 0:
            raise self.broken("its strings grow beyond the file")
        try:
            return text.encode("latin-1")
        except UnicodeEncodeError as error:
            raise self.broken("a string of bytes holds other characters") from error

    def build(self, value: Any, state: Any) -> None:
        match value, state:
            case InertType(built=False), (int(), str(order), None, None, None, int(), int(), int()):
                value.order, value.built = order, True
            case InertArray(type=None), (
                1,
                shape,
                InertType() as kind,
                bool() | 0 | 1 as fortran,
                (bytes() | bytearray() | list()) as data,
            ):
                value.shape, value.type, value.fortran, value.data = self.shape(shape), kind, bool(fortran), data
            case InertType(), _:
                raise self.broken("a data type has fields or is set twice")
            case _:
                raise self.broken("it sets the state of something that has none")

    def shape(self, shape: Any) -> tuple[int, ...]:
        if isinstance(shape, tuple) and is_usable_shape(shape):
            return shape
        raise self.broken("an array has no usable shape")
