"""Vanishing points of lines that are known to meet."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.calibration.corrected_lines import CorrectedLines
from app.calibration.vanishing_points import deviations, vanishing_points

SIGMA = 0.002


def lines_towards(vector, number, rng, sigma=SIGMA):
    """Lines at random places of the frame towards a point of the image plane, of either sense."""
    middle = rng.uniform(-0.7, 0.7, (number, 2))
    towards = vector[:2] - vector[2] * middle
    angle = np.arctan2(towards[:, 1], towards[:, 0]) + rng.normal(0, sigma, number) + np.pi * rng.integers(0, 2, number)
    return middle, angle


def as_lines(*groups):
    middle, angle = (np.concatenate(each) for each in zip(*groups, strict=True))
    number = len(angle)
    return CorrectedLines(
        middle,
        angle,
        np.full(number, 0.3),
        np.full(number, SIGMA),
        np.ones(number),
        np.zeros((0, number, 2)),
        np.zeros((0, number)),
    )


def turned_away(one, other):
    """Angle in rad between two directions of either sense."""
    return float(np.arccos(min(1.0, abs(one @ other))))


def test_two_points_are_found_among_lines_without_order():
    rng = np.random.default_rng(1)
    ahead, upright = np.array([0.2, -0.1, 1.0]), np.array([0.02, 1.0, 0.05])
    nowhere = rng.uniform(-0.7, 0.7, (12, 2)), rng.uniform(0, np.pi, 12)
    lines = as_lines(lines_towards(ahead, 25, rng), lines_towards(upright, 15, rng), nowhere)
    found = vanishing_points(lines)
    assert len(found) == 2
    first, second = (point.vector for point in found)
    assert turned_away(first, ahead / np.linalg.norm(ahead)) < 0.003
    assert turned_away(second, upright / np.linalg.norm(upright)) < 0.01
    assert found[0].lines[:25].mean() > 0.9
    assert found[1].lines[25:40].mean() > 0.9


def test_parallel_lines_meet_at_infinity():
    rng = np.random.default_rng(2)
    found = vanishing_points(as_lines(lines_towards(np.array([1.0, 0.0, 0.0]), 20, rng)))
    assert len(found) == 1
    assert abs(found[0].vector[2]) < 0.01


def test_lines_without_order_meet_nowhere():
    rng = np.random.default_rng(3)
    spread = [
        vanishing_points(as_lines((rng.uniform(-0.7, 0.7, (30, 2)), rng.uniform(0, np.pi, 30)))) for _ in range(10)
    ]
    assert sum(map(len, spread)) <= 1


def test_too_few_lines_are_no_vanishing_point():
    rng = np.random.default_rng(4)
    assert vanishing_points(as_lines(lines_towards(np.array([0.0, 0.0, 1.0]), 2, rng))) == []
    assert vanishing_points(as_lines((np.zeros((0, 2)), np.zeros(0)))) == []


def test_the_covariance_is_that_of_repeated_draws():
    truth = np.array([0.9, 0.1, 1.0]) / np.linalg.norm([0.9, 0.1, 1.0])
    away, expected = [], []
    for seed in range(40):
        # edges called parallel differ by more than their noise, as the search assumes of any scene
        lines = as_lines(lines_towards(truth, 20, np.random.default_rng(seed), np.deg2rad(0.25)))
        point = vanishing_points(lines)[0]
        vector = point.vector * np.sign(point.vector @ truth)
        away.append(((vector - truth) ** 2).sum())
        expected.append(np.trace(point.covariance))
    assert np.mean(away) == pytest.approx(np.mean(expected), rel=0.5)


@settings(max_examples=40, deadline=None)
@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(-1, 1))
def test_a_line_towards_a_point_does_not_deviate(x, y, z):
    vector = np.array([x, y, z])
    if np.linalg.norm(vector) < 0.1:
        return
    rng = np.random.default_rng(5)
    middle = rng.uniform(-0.7, 0.7, (8, 2))
    towards = vector[:2] - vector[2] * middle
    far = np.hypot(*towards.T) > 1e-3
    lines = as_lines((middle[far], np.arctan2(towards[far, 1], towards[far, 0])))
    assert deviations(vector[None], lines).max(initial=0.0) < 1e-9
    assert deviations(-vector[None], lines).max(initial=0.0) < 1e-9
