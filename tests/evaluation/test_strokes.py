from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.evaluation.strokes import Pattern, Stroke, along, dashes, draw_stroke

GREEN = (0, 255, 0)


def drawn(points: list[tuple[float, float]], pattern: Pattern = Pattern.SOLID, unit: float = 2.0, size: int = 81):
    canvas = np.full((size, size, 3), 200, np.uint8)
    draw_stroke(canvas, [np.array(points, dtype=float)], Stroke(GREEN, pattern), unit)
    return canvas


def test_the_centre_of_pixel_x_y_is_drawn_at_that_pixels_centre() -> None:
    assert drawn([(10, 40), (70, 40)])[40, 40].tolist() == list(GREEN)


@pytest.mark.parametrize("offset", [0.0, 0.25, 0.5, 0.75])
def test_a_position_between_pixels_is_kept(offset: float) -> None:
    canvas = drawn([(10, 40 + offset), (70, 40 + offset)]).astype(float)
    darkness = 200 - canvas[:, 40, 0]
    assert (darkness * np.arange(81)).sum() / darkness.sum() == pytest.approx(40 + offset, abs=0.1)


def test_a_line_has_a_dark_casing_so_that_it_stands_out_on_its_own_colour() -> None:
    canvas = np.empty((81, 81, 3), np.uint8)
    canvas[:] = GREEN
    draw_stroke(canvas, [np.array([[10.0, 40], [70, 40]])], Stroke(GREEN, Pattern.SOLID), 3.0)
    column = canvas[:, 40, 1].astype(int)
    assert column[40] == 255  # green, and darker beside
    assert column.min() < 120


def test_nothing_is_drawn_away_from_the_line() -> None:
    canvas = drawn([(10, 40), (70, 40)])
    assert (canvas[:35] == 200).all()
    assert (canvas[46:] == 200).all()
    assert (canvas[:, :6] == 200).all()


def test_patterns_interrupt_the_line() -> None:
    def gaps(pattern: Pattern) -> int:
        covered = drawn([(5, 40), (75, 40)], pattern)[40, 5:76, 0] < 30
        return int((np.diff(covered.astype(int)) == -1).sum())

    assert gaps(Pattern.SOLID) == 0
    assert 3 <= gaps(Pattern.DASHED) <= 6
    assert gaps(Pattern.DOTTED) >= 10


@pytest.mark.parametrize("pattern", Pattern)
def test_a_point_and_points_far_outside_are_drawn_without_harm(pattern: Pattern) -> None:
    assert (drawn([(40, 40)], pattern)[40, 40] != 200).any()
    assert drawn([(-3e4, 40), (40, 40), (3e4, 40)], pattern).shape == (81, 81, 3)
    assert (drawn([(5e8, 5e8), (6e8, 5e8)]) == 200).all()


def test_large_pictures_are_drawn_without_a_larger_mask() -> None:
    canvas = np.full((3000, 6000, 3), 200, np.uint8)
    draw_stroke(canvas, [np.array([[100.0, 1500], [5900, 1500]])], Stroke(GREEN, Pattern.SOLID), 7.0)
    assert canvas[1500, 3000].tolist() == list(GREEN)
    assert (canvas[1480] == 200).all()


def test_dashes_begin_and_end_with_a_whole_one() -> None:
    cut = dashes(np.array([[0.0, 0], [100, 0]]), 10, 8)
    assert cut[0][0, 0] == 0
    assert cut[-1][-1, 0] == pytest.approx(100)
    lengths = [piece[-1, 0] - piece[0, 0] for piece in cut]
    assert lengths == pytest.approx([lengths[0]] * len(cut))
    assert len(cut) == 6


def test_a_dash_follows_a_corner() -> None:
    corner = np.array([[0.0, 0], [10, 0], [10, 40]])
    assert dashes(corner, 20, 10)[0].tolist()[1] == [10, 0]


@settings(deadline=None)
@given(st.lists(st.tuples(st.floats(-500, 500), st.floats(-500, 500)), min_size=1, max_size=6), st.floats(1, 40))
def test_points_along_a_line_keep_its_ends(points: list[tuple[float, float]], spacing: float) -> None:
    found = along(np.array(points), spacing)
    assert found[0] == pytest.approx(np.array(points[0]))
    assert found[-1] == pytest.approx(np.array(points[-1]))
