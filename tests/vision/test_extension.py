"""Extension: how far an arc follows the points beyond its ends."""

from typing import Any

import numpy as np
import pytest

from app.vision.arcs import ends
from app.vision.extension import extend
from app.vision.merging import not_merged
from app.vision.native.records import ARC


@pytest.fixture
def extended(probes, edges_of):
    """Return a function that extends the arc from (x0, 30) to (x1, 30) over points in columns of row 30."""

    def run(x0: float, x1: float, columns: list[int] | range | np.ndarray, **of_points: Any) -> list[float]:
        """First and last column of the extended arc."""
        x = np.linspace(x0, x1, 40)
        records = np.zeros(3, ARC)
        records[:1] = probes.fit([np.stack([x, np.full(40, 30.0)], axis=1)])
        columns = np.asarray(columns)
        extend(not_merged(records), edges_of(columns, np.full(len(columns), 30.0), **of_points))
        return ends(records[:1])[0, :, 0].round(6).tolist()

    return run


def test_an_arc_follows_its_points_for_at_most_its_own_length(extended) -> None:
    # and for two px more, see the rounded corners below
    assert extended(60, 100, range(160)) == [18, 142]
    assert extended(100, 60, range(160)) == [142, 18]


def test_it_stops_where_the_points_stop(extended) -> None:
    assert extended(60, 100, range(52, 123)) == [52, 122]


def test_small_gaps_are_stepped_over_and_large_ones_are_not(extended) -> None:
    assert extended(30, 79, [*range(30, 80), *range(83, 95), *range(103, 110)]) == [30, 94]


def test_most_steps_need_a_point(extended) -> None:
    assert extended(30, 60, [*range(30, 61), *range(64, 160, 4)]) == [30, 60]


def test_what_runs_in_another_direction_is_not_followed(extended) -> None:
    assert extended(60, 100, range(160), slope=1.5) == [60, 100]


def test_two_points_of_a_rounded_corner_belong_to_the_edge(extended) -> None:
    columns = np.arange(50, 111)
    rounded = np.where((columns < 60) | (columns > 100), 0.8, 0.0)
    assert extended(60, 100, columns, slope=rounded) == [58, 102]


def test_a_short_arc_stays_as_it_is(extended) -> None:
    assert extended(30, 50, range(160)) == [30, 50]


def test_beyond_the_image_there_is_nothing(extended) -> None:
    assert extended(10, 150, range(160)) == [0, 159]


def test_the_fit_stays_as_it_is(probes, edges_of) -> None:
    records = np.zeros(3, ARC)
    x = np.linspace(60, 100, 40)
    records[:1] = probes.fit([np.stack([x, 30 + 1e-4 * (x - 80) ** 2], axis=1)])
    before = records.copy()
    extend(not_merged(records), edges_of(range(160), np.full(160, 30.0)))
    assert records["high"][0] > before["high"][0]
    for name in ("sums", "foot", "tangent", "bend", "rms"):
        assert np.array_equal(records[name], before[name])
