"""Figures of large datasets are remembered for a minute, renewed in the background, and never shown when old."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime, timedelta

import pytest

from app.errors import NotFound
from app.services.remembering import FRESH, MOST, OLD, Remembered

MOMENT = timedelta(seconds=1)


def test_a_fresh_figure_is_counted_once(now: datetime) -> None:
    remembered = Remembered()
    figures = iter(range(9))
    assert remembered.get("a", now, lambda: next(figures)) == 0
    assert remembered.get("a", now + FRESH, lambda: next(figures)) == 0
    assert remembered.get("b", now, lambda: next(figures)) == 1


def test_an_older_one_is_shown_and_counted_anew_meanwhile(now: datetime) -> None:
    remembered = Remembered()
    counted = threading.Event()

    def count() -> str:
        counted.set()
        return "new"

    remembered.get("a", now, lambda: "first")
    later = now + FRESH + MOMENT
    assert remembered.get("a", later, count) == "first"
    assert counted.wait(30)
    for thread in threading.enumerate():
        if thread.name == "counting":
            thread.join(30)
    assert remembered.get("a", later, lambda: pytest.fail("it is fresh")) == "new"


def test_an_old_one_is_never_shown(now: datetime) -> None:
    remembered = Remembered()
    remembered.get("a", now, lambda: "first")
    assert remembered.get("a", now + OLD + MOMENT, lambda: "second") == "second"


def test_of_several_who_wait_one_counts(now: datetime) -> None:
    remembered = Remembered()
    calls: list[int] = []
    everyone = threading.Barrier(4)

    def count() -> int:
        calls.append(1)
        return len(calls)

    def ask(_: int) -> int:
        everyone.wait(30)
        return remembered.get("a", now, count)

    with ThreadPoolExecutor(4) as threads:
        assert list(threads.map(ask, range(4))) == [1, 1, 1, 1]


def test_what_fails_is_told_and_not_remembered(now: datetime) -> None:
    remembered = Remembered()

    def fail() -> int:
        raise NotFound("there is no dataset x")

    with pytest.raises(NotFound):
        remembered.get("a", now, fail)
    assert remembered.get("a", now, lambda: 1) == 1


def test_the_oldest_are_forgotten(now: datetime) -> None:
    remembered = Remembered()
    for key in range(MOST + 1):
        remembered.get(key, now, lambda key=key: key)
    assert remembered.get(MOST, now, lambda: -1) == MOST
    assert remembered.get(0, now, lambda: -1) == -1
