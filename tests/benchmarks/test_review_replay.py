"""The replay of a review: strokes touch what they come near, and plans end right."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.vision import Segments
from benchmarks.shared.review_replay import KEEP, Effort, Page, keep_by_clicks, keep_then_reject, with_suggestions
from benchmarks.shared.review_strokes import Strokes, brush_radius, strokes
from benchmarks.shared.review_touching import BESIDE, nearest_lines, touched_lines
from benchmarks.shared.review_turning import turned

CASES: dict[str, Any] = json.loads(
    (Path(__file__).parents[2] / "frontend/src/labelling/tools/stroke_cases.json").read_text()
)

LADDER = [[[100, 100 + 30 * step], [200, 100 + 30 * step]] for step in range(4)]


def ladder() -> Segments:
    return Segments.from_list([np.linspace(start, end, 101) for start, end in LADDER])


@cache
def ladder_strokes() -> Strokes:
    return strokes(ladder(), (640, 480))


def page(truth: list[int], family: list[int] | None = None) -> Page:
    return Page(ladder_strokes(), np.array(truth), np.full(len(truth), -1) if family is None else np.array(family))


def sets_of(segments: Segments, radius: float | None = None) -> set[tuple[int, ...]]:
    return {tuple(np.flatnonzero(each).tolist()) for each in strokes(segments, (640, 480), radius).touched}


def test_a_stroke_touches_what_lies_between_its_ends() -> None:
    sets = sets_of(ladder())
    assert (0, 1) in sets
    assert (0, 1, 2, 3) in sets
    assert (0, 2) not in sets, "a straight stroke can't pass over the line between"
    assert (0, 3) not in sets


def test_a_brush_touches_within_its_radius() -> None:
    near = Segments.from_list([np.linspace((100, 100), (200, 100), 101), np.linspace((220, 106), (320, 106), 101)])
    beside = Segments.from_list([*near, np.linspace((100, 118), (320, 118), 221)])
    assert (0, 1) in sets_of(beside, radius=4.0)
    assert (0, 2) in sets_of(beside, radius=8.0)


def test_the_brush_is_that_of_the_page() -> None:
    assert brush_radius((640, 480)) == pytest.approx(8 * 640 / (820 / 480 * 640))
    assert brush_radius((4000, 3000)) == 8.0


def test_strokes_touch_and_turn_as_on_the_page() -> None:
    lines = Segments.from_list([np.array(line, np.float32) for line in CASES["lines"]])
    probability = np.array(CASES["probability"])
    for case in CASES["strokes"]:
        start, end = np.array(case["stroke"], np.float64)
        touched = touched_lines(lines, start, end, CASES["radius"])
        ends = nearest_lines(lines, np.stack([start, end]), CASES["radius"])
        assert np.flatnonzero(touched).tolist() == case["touched"], case
        assert [None if line == BESIDE else line for line in ends.tolist()] == case["ends"], case
        assert np.flatnonzero(turned(touched[None], ends[None], probability)).tolist() == case["turned"], case


def test_the_raster_finds_what_the_rule_says() -> None:
    drawn = ladder_strokes()
    exact = np.stack([drawn.exactly(stroke) for stroke in range(len(drawn.touched))])
    assert (exact == drawn.touched).mean() > 0.95
    assert (drawn.lines == BESIDE).any(), "strokes may end beside the lines"


def test_one_stroke_keeps_all_and_a_key_rejects_the_rest() -> None:
    effort = keep_then_reject(page([1, 1, 1, 1]))
    assert (effort.actions, effort.wrong) == (3, 0)  # stroke, R, Enter


def test_a_lone_true_line_costs_a_click() -> None:
    assert keep_then_reject(page([0, 0, 1, 0])).actions == 3
    assert keep_by_clicks(page([0, 0, 1, 0])).actions == 3
    assert keep_by_clicks(page([0, 0, 0, 0])).actions == 2


def test_right_suggestions_cost_one_key_and_a_wrong_one_one_more() -> None:
    truth = page([1, 0, 1, 0])
    without = keep_then_reject(truth)
    right = np.array([0.9, 0.1, 0.9, 0.1])
    assert with_suggestions(truth, right, 0.5, 0.5, without).actions == 1, "Shift+Enter"
    wrong = np.array([0.9, 0.1, 0.9, 0.8])
    assert with_suggestions(truth, wrong, 0.5, 0.5, without).actions == 2
    assert with_suggestions(truth, wrong, 0.85, 0.15, without).actions == 3, "S, R for what is left open, Enter"
    upside_down = np.array([0.1, 0.9, 0.1, 0.9])
    assert with_suggestions(truth, upside_down, 0.5, 0.5, without).actions <= without.actions


def test_one_stroke_turns_two_wrong_ones_and_leaves_the_right_one_between() -> None:
    truth = page([0, 1, 0, 1])
    without = keep_then_reject(truth)
    suggested = np.array([0.8, 0.95, 0.7, 0.9])
    assert with_suggestions(truth, suggested, 0.5, 0.5, without).actions == 2, "stroke, Shift+Enter"
    assert with_suggestions(truth, suggested, 0.5, 0.5, without, turning=False).actions == 3
    alike = np.array([0.8, 0.75, 0.7, 0.9])
    assert with_suggestions(truth, alike, 0.5, 0.5, without).actions == 3, "what is as likely would turn too"


def test_one_stroke_turns_kept_and_rejected_ones() -> None:
    costly = Effort(9, 0, 0, 0, 0)
    found = with_suggestions(page([0, 1, 1, 0]), np.array([0.6, 0.45, 0.3, 0.1]), 0.5, 0.5, costly)
    assert (found.actions, found.strokes) == (2, 1)


def test_a_family_is_judged_by_a_click_and_a_key() -> None:
    far = Segments.from_list([np.linspace((100, 60 * k), (200, 60 * k), 101) for k in range(1, 8)])
    touched = strokes(far, (640, 480))
    truth = np.array([1, 0, 1, 0, 1, 0, 1])
    apart, together = np.full(7, -1), np.where(truth == KEEP, 0, -1)
    assert keep_then_reject(Page(touched, truth, apart)).actions == 6
    assert keep_then_reject(Page(touched, truth, together)).actions == 4


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
