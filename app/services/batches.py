"""Long lists of ids in pieces: databases bound the number of parameters of one statement."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import TypeVar

Item = TypeVar("Item")

BATCH = 10_000


def in_batches(items: Sequence[Item], size: int = BATCH) -> Iterator[Sequence[Item]]:
    """Yield the items in order, at most ``size`` at a time."""
    for start in range(0, len(items), size):
        yield items[start : start + size]


def batches_of(items: Iterable[Item], size: int = BATCH) -> Iterator[list[Item]]:
    """Yield the items in order, at most ``size`` at a time; no more than these are taken from where they come from."""
    left = iter(items)
    while batch := list(islice(left, size)):
        yield batch
