"""Vanishing points from candidates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from app.review.strands import strands
from app.review.vanishing import deviations, vanishing_frame
from app.vision import Segments

SIZE = (640, 480)
Lines = Callable[..., Segments]


def box_edges(yaw: float, focal: float, seed: int) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Return images of 45 edges along three directions at right angles."""
    random = np.random.default_rng(seed)
    turn = np.array([[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]])
    ends = []
    while len(ends) < 45:
        start = random.uniform([-4, -3, 6], [4, 3, 14])
        stop = start + turn[:, len(ends) % 3] * random.uniform(1, 3)
        if min(start[2], stop[2]) > 2:
            ends.append(tuple(tuple(focal * end[:2] / end[2] + [319.5, 239.5]) for end in (start, stop)))
    return ends


@pytest.mark.parametrize(("yaw", "seed"), [(0.5, 1), (0.9, 2), (0.2, 3)])
def test_edges_of_a_box_point_to_the_frame_and_others_do_not(lines: Lines, yaw: float, seed: int) -> None:
    stray = [((100, 100), (200, 187)), ((400, 300), (450, 411))]
    traced = strands(lines([*box_edges(yaw, 520.0, seed), *stray]), SIZE)
    frame = vanishing_frame(traced)
    assert frame is not None
    assert frame.points @ frame.points.T == pytest.approx(np.eye(3), abs=1e-6)
    angle = np.rad2deg(deviations(frame, traced))
    assert np.percentile(angle[:45].min(axis=1), 75) < 1.0
    assert (np.argmin(angle[1:45:3], axis=1) == 0).mean() > 0.9  # upright edges point to the first
    assert frame.support.sum() > 0.8


def test_two_candidates_are_too_few(lines: Lines) -> None:
    assert vanishing_frame(strands(lines([((0, 0), (9, 9)), ((0, 9), (9, 0))]), SIZE)) is None


def test_candidates_all_alike_give_a_frame_without_trouble(lines: Lines) -> None:
    frame = vanishing_frame(strands(lines([((10, 10), (10, 200))] * 4), SIZE))
    assert frame is not None
    assert np.isfinite(frame.points).all()
