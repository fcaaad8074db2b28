"""A function over many items in real processes, some of which are really killed."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from app.errors import InvalidInput
from app.jobs.mapping import Outcome, map_in_processes


def square(number: int) -> int:
    return number * number


def refuse_odd(number: int) -> int:
    if number % 2:
        raise InvalidInput("odd", where=str(number))
    return number


def break_at_three(number: int) -> int:
    if number == 3:
        raise ZeroDivisionError("a fault of ours")
    return number


def die_at_three(number: int) -> int:
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def die_once(marker: Path) -> str:
    if not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return marker.name


def by_item(outcomes: list[Outcome[int, int]]) -> dict[int, Outcome[int, int]]:
    assert len({outcome.item for outcome in outcomes}) == len(outcomes)
    return {outcome.item: outcome for outcome in outcomes}


def test_every_item_has_one_outcome() -> None:
    found = by_item(list(map_in_processes(square, range(20), 2)))
    assert {item: outcome.result for item, outcome in found.items()} == {n: n * n for n in range(20)}


def test_nothing_to_do_ends_at_once() -> None:
    assert list(map_in_processes(square, [], 2)) == []


def test_an_item_that_fails_fails_alone() -> None:
    found = by_item(list(map_in_processes(refuse_odd, range(6), 2)))
    assert [found[n].result for n in (0, 2, 4)] == [0, 2, 4]
    for number in (1, 3, 5):
        error = found[number].error
        assert isinstance(error, InvalidInput)
        assert error.where == str(number)


def test_a_fault_of_ours_is_raised() -> None:
    with pytest.raises(ZeroDivisionError, match="ours"):
        list(map_in_processes(break_at_three, range(6), 2))


def test_an_item_that_kills_its_worker_is_given_up_and_the_others_are_not() -> None:
    found = by_item(list(map_in_processes(die_at_three, range(6), 1)))
    assert sorted(found) == list(range(6))
    assert found[3].result is None
    assert found[3].error is not None
    assert found[3].error.code == "unavailable"
    assert all(found[n].result == n for n in range(6) if n != 3)


def test_a_worker_that_is_killed_once_costs_nothing(tmp_path: Path) -> None:
    markers = [tmp_path / name for name in ("a", "b", "c")]
    outcomes = list(map_in_processes(die_once, markers, 2))
    assert sorted(outcome.result or "" for outcome in outcomes) == ["a", "b", "c"]
