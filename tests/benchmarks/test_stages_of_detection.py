"""What the benchmark of the stages of detection times and counts."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

from app.vision import DetectionParameters, Segments
from app.vision.arcs import ends
from app.vision.native.records import ARC
from benchmarks.shared.arc_polylines import STEP, arc_polylines
from benchmarks.shared.call_times import Call, timed_calls
from benchmarks.shared.findable import are_covered, are_found
from benchmarks.shared.stage_survival import survival
from benchmarks.shared.stage_times import CALLS, LSD, REST, STAGES, WHOLE, by_stage, stage_times


@pytest.fixture
def step() -> np.ndarray:
    """A step along row 40, its bright side below, blurred a little so that points lie between pixels."""
    image = np.full((80, 200), 160, np.uint8)
    image[:40] = 60
    image[40] = 120
    return image


def test_an_arc_becomes_a_polyline_along_its_circle() -> None:
    arcs = np.zeros(3, ARC)
    arcs["foot"] = [[50, 20], [50, 20], [7, 8]]
    arcs["tangent"] = [[1, 0], [1, 0], [0, 1]]
    arcs["bend"] = [0, 1 / 600, 0]
    arcs["low"], arcs["high"] = [-20, -30, 0], [40, 30, 0]
    polylines = arc_polylines(arcs)
    assert len(polylines) == 3
    for index, (start, end) in enumerate(ends(arcs)):
        assert polylines[index][0] == pytest.approx(start, abs=1e-4)
        assert polylines[index][-1] == pytest.approx(end, abs=1e-4)
        assert np.hypot(*np.diff(polylines[index], axis=0).T).max() <= STEP + 0.1
    assert (polylines[0][:, 1] == 20).all()
    radii = np.hypot(polylines[1][:, 0] - 50, polylines[1][:, 1] + 280)
    assert radii == pytest.approx(300, abs=1e-3), "the centre lies against the normal"
    assert len(arc_polylines(arcs[:0])) == 0


def test_calls_are_timed_in_order_and_names_put_back() -> None:
    module = ModuleType("module")
    vars(module).update(twice=lambda value: 2 * value, fail=lambda: 1 / 0)
    before = dict(vars(module))

    def run(calls: list[Call]) -> None:
        with timed_calls([(module, "twice"), (module, "fail")]) as made:
            assert [module.twice(4), module.twice(value=5)] == [8, 10]
            calls.extend(made)
            module.fail()

    calls: list[Call] = []
    with pytest.raises(ZeroDivisionError):
        run(calls)
    assert [call.name for call in calls] == ["twice", "twice"]
    assert vars(module) == before


def test_seconds_add_up_by_stage_and_other_calls_are_refused() -> None:
    calls = [Call(name, 2.0**index) for index, (name, _) in enumerate(CALLS)]
    seconds = by_stage(calls)
    assert tuple(seconds) == STAGES[:-1]
    assert sum(seconds.values()) == 2.0 ** len(CALLS) - 1
    assert seconds["chaining and splitting"] == 4.0 + 8.0
    with pytest.raises(RuntimeError, match="have changed"):
        by_stage(calls[::-1])


def test_every_stage_of_detect_is_timed(step: np.ndarray) -> None:
    times = stage_times([step, step], 50, 1)
    assert set(times) == {*STAGES, WHOLE, LSD}
    assert all(each.shape == (2,) and (each > 0).all() for each in times.values())
    assert sum(times[name] for name in STAGES) == pytest.approx(times[WHOLE])
    assert (times[REST] < times[WHOLE]).all()


def test_a_line_is_followed_through_the_stages(step: np.ndarray) -> None:
    along, beside, across = [[10, 40], [190, 40]], [[10, 50], [190, 50]], [[100, 5], [100, 75]]
    left = survival(step, Segments.from_list([along, beside, across]), DetectionParameters(min_length=50))
    assert all(each.tolist() == [True, False, False] for each in left.findable.values())
    assert list(left.findable) == [
        "supported",
        "chained",
        "merged",
        "extended",
        "merged after extension",
        "de-duplicated",
        "validated",
        "matched",
    ]
    assert left.candidates == dict.fromkeys(list(left.findable)[1:], 1)


def test_a_line_in_pieces_is_covered_but_not_found() -> None:
    lines = Segments.from_list([[[0, 0], [100, 0]], [[0, 50], [100, 50]]])
    pieces = Segments.from_list([[[x, 0], [x + 16, 0]] for x in range(0, 100, 20)])
    assert are_covered(lines, pieces).tolist() == [True, False]
    assert are_found(lines, pieces).tolist() == [False, False]
    assert are_found(lines, lines.select(np.array([True, False]))).tolist() == [True, False]
    assert are_found(lines, Segments.empty()).tolist() == [False, False]
