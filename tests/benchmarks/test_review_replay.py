"""The replay of a review: strokes touch what they come near, and plans end right."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.vision import Segments
from benchmarks.shared.review_replay import KEEP, Page, keep_by_clicks, keep_then_reject, with_suggestions
from benchmarks.shared.review_strokes import brush_radius, strokes

LADDER = [[[100, 100 + 30 * step], [200, 100 + 30 * step]] for step in range(4)]


def ladder() -> Segments:
    return Segments.from_list([np.linspace(start, end, 101) for start, end in LADDER])


def page(truth: list[int], family: list[int] | None = None) -> Page:
    touched = strokes(ladder(), (640, 480)).astype(np.float32)
    return Page(touched, np.array(truth), np.full(len(truth), -1) if family is None else np.array(family))


def test_a_stroke_touches_what_lies_between_its_ends() -> None:
    sets = {tuple(np.flatnonzero(each)) for each in strokes(ladder(), (640, 480))}
    assert (0, 1) in sets
    assert (0, 1, 2, 3) in sets
    assert (0, 2) not in sets, "a straight stroke can't pass over the line between"
    assert (0, 3) not in sets


def test_a_brush_touches_within_its_radius() -> None:
    near = Segments.from_list([np.linspace((100, 100), (200, 100), 101), np.linspace((220, 106), (320, 106), 101)])
    beside = Segments.from_list([*near, np.linspace((100, 118), (320, 118), 221)])
    assert tuple(strokes(beside, (640, 480), radius=8.0).sum(axis=1).tolist()).count(2) > 0
    assert {tuple(np.flatnonzero(each)) for each in strokes(beside, (640, 480), radius=4.0)} >= {(0, 1)}


def test_the_brush_is_that_of_the_page() -> None:
    assert brush_radius((640, 480)) == pytest.approx(8 * 640 / (820 / 480 * 640))
    assert brush_radius((4000, 3000)) == 8.0


def test_one_stroke_keeps_all_and_a_key_rejects_the_rest() -> None:
    effort = keep_then_reject(page([1, 1, 1, 1]))
    assert (effort.actions, effort.wrong) == (3, 0)  # hold, stroke, R


def test_a_lone_true_line_costs_a_click() -> None:
    assert keep_then_reject(page([0, 0, 1, 0])).actions == 3
    assert keep_by_clicks(page([0, 0, 1, 0])).actions == 3
    assert keep_by_clicks(page([0, 0, 0, 0])).actions == 1


def test_right_suggestions_cost_one_key_and_a_wrong_one_two_more() -> None:
    truth = page([1, 0, 1, 0])
    without = keep_then_reject(truth)
    right = np.array([0.9, 0.1, 0.9, 0.1])
    assert with_suggestions(truth, right, 0.5, 0.5, without).actions == 1
    wrong = np.array([0.9, 0.1, 0.9, 0.8])
    assert with_suggestions(truth, wrong, 0.5, 0.5, without).actions == 3
    assert with_suggestions(truth, wrong, 0.85, 0.15, without).actions == 2, "what is left open is rejected by R"
    upside_down = np.array([0.1, 0.9, 0.1, 0.9])
    assert with_suggestions(truth, upside_down, 0.5, 0.5, without).actions <= without.actions


def test_a_family_is_judged_by_a_click_and_a_key() -> None:
    far = Segments.from_list([np.linspace((100, 60 * k), (200, 60 * k), 101) for k in range(1, 8)])
    touched = strokes(far, (640, 480)).astype(np.float32)
    truth = np.array([1, 0, 1, 0, 1, 0, 1])
    apart, together = np.full(7, -1), np.where(truth == KEEP, 0, -1)
    assert keep_then_reject(Page(touched, truth, apart)).actions == 6
    assert keep_then_reject(Page(touched, truth, together)).actions == 3


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.integers(0, 1), min_size=4, max_size=4),
    st.lists(st.floats(0, 1), min_size=4, max_size=4),
    st.lists(st.integers(-1, 1), min_size=4, max_size=4),
    st.sampled_from([(0.5, 0.5), (0.9, 0.1)]),
)
def test_every_verdict_is_right_in_the_end(
    truth: list[int], probability: list[float], family: list[int], thresholds: tuple[float, float]
) -> None:
    judged = page(truth, family)
    without = keep_then_reject(judged)
    for effort in (without, with_suggestions(judged, np.array(probability), *thresholds, without)):
        assert effort.wrong == 0
        assert 1 <= effort.actions <= 4 + 3
