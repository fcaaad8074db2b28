"""Statistics of decisions: counted once, never twice, and nothing that comes later is missed."""

from __future__ import annotations

from datetime import UTC, date, datetime, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.services.statistics import Statistics, statistics_of
from app.services.time_bins import AWAY, BINS, EDGES, histogram, lower_end, quantiles
from app.services.work_logs import SETTLED, WorkLogs

milliseconds = st.lists(st.integers(0, 200_000), min_size=1, max_size=60)


def bin_in_python(time: int) -> int:
    return next(number for number in reversed(range(BINS)) if lower_end(number) <= time)


def counted(times: list[int]) -> dict[int, int]:
    bins = [bin_in_python(time) for time in times]
    return {number: bins.count(number) for number in set(bins)}


@given(milliseconds)
def test_bars_hold_every_time_once(times) -> None:
    bars = histogram(counted(times))
    assert bars == np.histogram(times, [*EDGES, 10**9])[0].tolist()


@given(milliseconds)
def test_quartiles_are_right_to_a_bin(times) -> None:
    exact = np.quantile(np.minimum(times, AWAY), (0.25, 0.5, 0.75), method="inverted_cdf")
    for found, true in zip(quantiles(counted(times), (0.25, 0.5, 0.75)), exact, strict=True):
        width = 50 if true < 10_000 else 1_000
        assert found is not None
        assert abs(found - true) <= width


def test_nobody_took_any_time() -> None:
    assert quantiles({}, (0.5,)) == [None]


def statistics(office, logs: WorkLogs, *, later: timedelta = timedelta()) -> Statistics:
    log = logs.of(office.dataset_id, office.now + later)
    with office.database.read() as session:
        return statistics_of(session, office.dataset(session), log)


def test_what_was_done_by_whom_and_how_fast(office) -> None:
    one, two, three, four = office.segments[office.first]
    decide, first = office.decide, office.first
    decide(first, {one: "keep"}, "Mara", elapsed_ms=900, suggestion=0.9)
    decide(first, {two: "reject"}, "Mara", elapsed_ms=1_100, suggestion=0.8, reason="car")
    judged = [office.wish(three, "reject", kind="accept", suggestion=0.1), office.wish(four, "reject", kind="accept")]
    decide(first, judged, "Jon", minutes=70)
    group = office.wish(one, "ambiguous", elapsed_ms=400_000)
    undo = office.wish(one, "keep", kind="undo", target_group_id=group.group_id, elapsed_ms=50)
    decide(first, [group, undo], "Jon", minutes=24 * 60)
    found = statistics(office, WorkLogs(office.database))
    assert (found.images.open, found.decisions) == (3, 5)
    assert [(each.hour.hour, each.decisions) for each in found.hours] == [(12, 2), (13, 2), (12, 1)]
    assert [(each.day, each.decisions) for each in found.days] == [(date(2025, 6, 1), 4), (date(2025, 6, 2), 1)]
    assert found.hours[0].hour == datetime(2025, 6, 1, 12, tzinfo=UTC)
    jon, mara = found.people
    assert (jon.person, jon.decisions, jon.undone, jon.times.count) == ("Jon", 3, 1, 1)
    assert (mara.person, mara.decisions, mara.undone) == ("Mara", 2, 0)
    assert mara.per_hour == pytest.approx(2 / (2_000 / 3_600_000))
    assert jon.hours == pytest.approx(AWAY / 3_600_000)  # who is away for minutes doesn't work
    assert mara.times.median == pytest.approx(950)
    assert (found.suggestions.shown, found.suggestions.agreed, found.suggestions.accepted) == (3, 2, 2)
    assert {each.reason: each.count for each in found.reasons if each.count} == {"car": 1}
    assert {each.verdict: each.times.count for each in found.verdicts} == {"keep": 1, "reject": 1, "ambiguous": 1}
    assert found.agreement.reviews == 0


def test_counts_are_remembered_and_still_right(office, count_queries) -> None:
    logs = WorkLogs(office.database)
    one, two, three, _ = office.segments[office.first]
    office.decide(office.first, {one: "keep"}, elapsed_ms=100)
    assert statistics(office, logs).decisions == 1
    later = 2 * SETTLED
    for _ in range(2):
        assert statistics(office, logs, later=later).decisions == 1
    office.decide(office.first, {two: "keep"}, minutes=15)
    office.decide(office.first, {three: "keep"}, minutes=19)
    for minutes in (20, 26, 90):
        found = statistics(office, logs, later=timedelta(minutes=minutes))
        assert (found.decisions, found.people[0].times.count) == (3, 1)
    assert found == statistics(office, WorkLogs(office.database), later=timedelta(minutes=90))


def test_finished_images_by_day(small_office) -> None:
    office = small_office
    office.finish(office.first, "krrr")
    found = statistics(office, WorkLogs(office.database))
    assert [(each.day, each.decisions, each.done) for each in found.days] == [(date(2025, 6, 1), 4, 1)]
    assert found.images.done == 1
