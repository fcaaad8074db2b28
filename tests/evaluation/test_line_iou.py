from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.evaluation import nearest_samples
from app.evaluation.line_iou import line_iou_matrix
from app.vision.segments import Segments

ANGLES = [0, 17, 45, 60, 90, 133]


def iou(a: NDArray[np.floating], b: NDArray[np.floating], tau: float = 3.0) -> float:
    return line_iou_matrix(Segments.from_list([a]), Segments.from_list([b]), tau).toarray()[0, 0]


def scene(seed: int, count: int = 25) -> list[NDArray[np.float64]]:
    """Slightly bent lines in all directions, close enough to meet."""
    random = np.random.default_rng(seed)
    lines = []
    for _ in range(count):
        length = random.uniform(20, 200)
        along = np.arange(-length / 2, length / 2)
        bent = np.stack([along, random.uniform(-4e-4, 4e-4) * along**2], axis=1)
        lines.append(bent @ rotation(random.uniform(0, 360)) + random.uniform(0, 300, 2))
    return lines


def rotation(degrees: float) -> NDArray[np.float64]:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, s], [-s, c]])


def disturbed(lines: list[NDArray[np.float64]], seed: int) -> list[NDArray[np.float64]]:
    random = np.random.default_rng(seed)
    return [line + random.normal(0, 1.5, 2) + random.normal(0, 0.3, line.shape) for line in lines]


def test_equal_lines_have_1_and_lines_apart_0(line) -> None:
    assert iou(line(300, 33), line(300, 33)) == pytest.approx(1)
    assert iou(line(300, 33), line(300, 33, (900.0, 900.0))) == 0


@pytest.mark.parametrize("angle", ANGLES)
def test_a_cross_counts_for_nothing(line, angle) -> None:
    assert iou(line(300, angle), line(300, angle + 90)) == 0


def test_half_a_line_has_half_the_cover(line) -> None:
    # the cover reaches 3 px beyond the half: m = (200 + 203) / 2
    m = (200 + 400 * 204 / 401) / 2
    assert iou(line(400)[:201], line(400)) == pytest.approx(m / (600 - m))


def test_the_value_by_its_definition_on_lines_that_overlap_in_part(line) -> None:
    # 300 px each, shifted along themselves by 100: 200 px shared, and 3 px on
    m = 300 * 204 / 301
    assert iou(line(300), line(300, 0, (600.0, 500.0))) == pytest.approx(m / (600 - m))


@pytest.mark.parametrize("angle", ANGLES)
def test_the_shift_accepted_is_3_px_in_every_direction(line, angle) -> None:
    normal = np.array([-np.sin(np.radians(angle)), np.cos(np.radians(angle))])
    assert iou(line(400, angle), line(400, angle) + 2.99 * normal) > 0.98
    assert iou(line(400, angle), line(400, angle) + 3.02 * normal) < 0.02


@pytest.mark.parametrize("angle", ANGLES)
def test_the_turn_accepted_at_half_cover_is_1_28_degrees_in_every_direction(line, angle) -> None:
    # about the middle, 2/3 of the length stay within 3 px: sin(turn) = 3 / (400 / 3)
    assert iou(line(400, angle), line(400, angle + 1.27)) >= 0.5
    assert iou(line(400, angle), line(400, angle + 1.31)) < 0.5


def test_tangents_count_to_15_degrees(line) -> None:
    # lines that cross lie within 3 px of each other around the crossing; whether it counts is a matter of angle
    assert iou(line(100, 0), line(100, 14.5)) > 0.05
    assert iou(line(100, 0), line(100, 15.5)) == 0


def test_tau_is_the_distance_accepted(line) -> None:
    assert iou(line(200), line(200, center=(500.0, 504.0)), tau=5.0) == pytest.approx(1)
    assert iou(line(200), line(200, center=(500.0, 504.0)), tau=1.0) == 0


def test_a_segment_without_length_matches_nothing(line) -> None:
    point = np.array([[500.0, 500.0]])
    assert iou(point, point) == 0
    assert iou(point, line(100)) == 0


def test_no_segments_give_an_empty_matrix(line) -> None:
    some = Segments.from_list([line(50)])
    assert line_iou_matrix(Segments.empty(), some).shape == (0, 1)
    assert line_iou_matrix(some, Segments.empty()).shape == (1, 0)


def test_the_matrix_is_symmetric() -> None:
    a, b = Segments.from_list(scene(1)), Segments.from_list(disturbed(scene(1), 2))
    assert line_iou_matrix(a, b).toarray() == pytest.approx(line_iou_matrix(b, a).toarray().T, abs=1e-12)


MOTIONS: dict[str, Callable[[NDArray[np.float64]], NDArray[np.float64]]] = {
    "turned by 90 degrees": lambda points: points @ rotation(90),
    "turned by 31 degrees": lambda points: points @ rotation(31),
    "mirrored": lambda points: points * [-1, 1],
    "translated": lambda points: points + np.array([123.4, -77.7]),
    "reversed": lambda points: points[::-1],
}


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_moving_both_sides_changes_nothing(name, seed) -> None:
    move = MOTIONS[name]
    lines = scene(seed)
    others = disturbed(lines, seed + 10)
    before = line_iou_matrix(Segments.from_list(lines), Segments.from_list(others)).toarray()
    after = line_iou_matrix(
        Segments.from_list([move(line) for line in lines]), Segments.from_list([move(line) for line in others])
    ).toarray()
    assert np.median(before.diagonal()) > 0.9
    # a sample that lies at the very edge of 3 px may fall to either side by rounding
    assert after == pytest.approx(before, abs=0.02)
    assert np.median(np.abs(after - before)[before > 0]) < 1e-4


def literal_cover(a: NDArray[np.float64], b: NDArray[np.float64], tau: float) -> float:
    """Share of straight line a's samples near b, by distances to all pieces of b; no regard to tangents."""
    covered = 0
    for point in a:
        best = np.inf
        for begin, end in pairwise(b):
            piece = end - begin
            t = np.clip((point - begin) @ piece / (piece @ piece), 0, 1)
            best = min(best, float(np.hypot(*(point - begin - t * piece))))
        covered += best <= tau
    return covered / len(a)


@settings(max_examples=25, deadline=None)
@given(
    st.floats(0, 180),
    st.floats(-6, 6),
    st.floats(-50, 50),
    st.integers(10, 60),
    st.floats(0, 14),
)
def test_equals_its_definition_on_straight_lines(angle, across, along, length, turn) -> None:
    base = np.stack([np.arange(61) - 30.0, np.zeros(61)], axis=1)
    other = np.stack([np.arange(length + 1) - length / 2, np.zeros(length + 1)], axis=1) @ rotation(turn)
    a, b = base @ rotation(angle), (other + np.array([along, across])) @ rotation(angle)
    m = (60 * literal_cover(a, b, 3) + length * literal_cover(b, a, 3)) / 2
    # one sample more or less, where it lies at the edge
    assert iou(a, b) == pytest.approx(m / (60 + length - m), abs=1.01 / length)


def test_a_bound_on_memory_changes_no_value(monkeypatch: pytest.MonkeyPatch) -> None:
    a, b = Segments.from_list(scene(4)), Segments.from_list(disturbed(scene(4), 5))
    whole = line_iou_matrix(a, b).toarray()
    monkeypatch.setattr(nearest_samples, "_PAIRS_LISTED", 50)
    assert line_iou_matrix(a, b).toarray() == pytest.approx(whole, abs=1e-12)
