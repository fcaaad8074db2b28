"""How long the functions that a computation calls take, one by one."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from types import ModuleType
from typing import Any


@dataclass(frozen=True)
class Call:
    """One call of a function.

    Attributes:
        name: Of the function.
        seconds: That it took, of this thread on the processor: short calls beside other processes' work would be
            measured by how rarely these break in.
    """

    name: str
    seconds: float


@contextmanager
def timed_calls(functions: Sequence[tuple[ModuleType, str]]) -> Iterator[list[Call]]:
    """Time the calls that modules make to functions they name; each is added to the list when it is over.

    The names are bound to timed functions meanwhile, which adds a microsecond or so to a call and needs no hook in
    what is measured. A call is not split into those that it makes itself.

    Args:
        functions: Of each function the module that calls it, and its name there.
    """
    calls: list[Call] = []
    originals = [(module, name, getattr(module, name)) for module, name in functions]
    for module, name, function in originals:
        setattr(module, name, _timed(name, function, calls))
    try:
        yield calls
    finally:
        for module, name, function in originals:
            setattr(module, name, function)


def _timed(name: str, function: Callable[..., Any], calls: list[Call]) -> Callable[..., Any]:
    @wraps(function)
    def timed(*arguments: Any, **named: Any) -> Any:
        start = time.thread_time()
        result = function(*arguments, **named)
        calls.append(Call(name, time.thread_time() - start))
        return result

    return timed
