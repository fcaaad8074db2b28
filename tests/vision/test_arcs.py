"""Arcs from moments: the fit, its direction, and places along it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.vision.arcs import ends, fit_pieces, positions, project
from app.vision.chaining import find_runs

LARGEST_CURVATURE = 1e-3


def circle_points(
    radius: float, length: float, angle: float, center: tuple[float, float] = (0, 0), noise: float = 0.0
) -> np.ndarray:
    """Points 1 px apart on an arc through ``center`` with direction ``angle`` in its middle."""
    u = np.linspace(-length / 2, length / 2, int(length) + 1)
    x, y = radius * np.sin(u / radius), 2 * radius * np.sin(u / radius / 2) ** 2
    y = y + np.random.default_rng(1).normal(0, noise, len(u))
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x - s * y + center[0], s * x + c * y + center[1]], axis=1)


def taubin_by_svd(points: np.ndarray) -> tuple[np.ndarray, float]:
    """Centre and radius of Taubin's circle, from the singular value decomposition of all points."""
    mean = points.mean(axis=0)
    local = points - mean
    square = (local**2).sum(axis=1)
    scaled = (square - square.mean()) / (2 * np.sqrt(square.mean()))
    A, B, C = np.linalg.svd(np.column_stack([scaled, local]), full_matrices=False)[2][2]
    A /= 2 * np.sqrt(square.mean())
    center = -np.array([B, C]) / (2 * A)
    return center + mean, float(np.sqrt((center**2).sum() + square.mean()))


def center_of_arc(arc: np.ndarray) -> tuple[np.ndarray, float]:
    """Centre and radius of a fitted arc; it bends against its normal for a positive bend."""
    normal = np.array([-arc["tangent"][0, 1], arc["tangent"][0, 0]])
    radius = 1 / (2 * arc["bend"][0])
    return arc["foot"][0] - radius * normal, abs(radius)


@given(
    radius=st.floats(1001, 1e9),
    length=st.floats(30, 250),
    angle=st.floats(-3.1, 3.1),
    x=st.floats(0, 8000),
    y=st.floats(0, 6000),
)
def test_an_exact_arc_is_found_wherever_it_lies(
    probes, radius: float, length: float, angle: float, x: float, y: float
) -> None:
    points = circle_points(radius, length, angle, (x, y))
    arc = probes.fit([points])
    # rounding of coordinates of thousands of px leaves about 1e-12 px, times 8 / length^2 in curvature
    assert abs(2 * arc["bend"][0]) == pytest.approx(1 / radius, rel=1e-5, abs=1e-9)
    assert np.abs(probes.project(arc, points)[1]).max() < 1e-6
    assert arc["rms"][0] < 1e-4


@pytest.mark.parametrize("radius", [1100.0, 2500.0])
@pytest.mark.parametrize("noise", [0.05, 0.3])
def test_the_fit_is_taubins(probes, radius: float, noise: float) -> None:
    points = circle_points(radius, 400, 0.4, (700, 300), noise)
    arc = probes.fit([points])
    center, fitted = center_of_arc(arc)
    expected_center, expected = taubin_by_svd(points)
    assert fitted == pytest.approx(expected, rel=1e-8)
    assert center == pytest.approx(expected_center, abs=1e-4)
    distances = np.abs(np.hypot(*(points - center).T) - fitted)
    assert arc["rms"][0] == pytest.approx(np.sqrt((distances**2).mean()), rel=1e-3)


@given(angle=st.floats(-3.1, 3.1), x=st.floats(-3000, 3000), y=st.floats(-3000, 3000))
def test_a_moved_and_turned_run_gives_the_moved_and_turned_arc(probes, angle: float, x: float, y: float) -> None:
    points = circle_points(1500, 120, 0.0, noise=0.2)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    one, other = probes.fit([points]), probes.fit([points @ turn + [x, y]])
    for name in ("bend", "low", "high", "rms"):
        assert other[name] == pytest.approx(one[name], rel=1e-6, abs=1e-9)
    assert other["foot"] == pytest.approx(one["foot"] @ turn + [x, y], abs=1e-6)
    assert other["tangent"] == pytest.approx(one["tangent"] @ turn, abs=1e-8)


def test_few_points_make_the_line_of_least_squares(probes) -> None:
    points = circle_points(300, 22, 0.3, (50, 60), noise=0.3)
    arc = probes.fit([points])
    assert arc["bend"][0] == 0
    principal = np.linalg.svd(points - points.mean(axis=0))[2][0]
    assert abs(arc["tangent"][0] @ principal) == pytest.approx(1, abs=1e-12)
    assert arc["foot"][0] == pytest.approx(points.mean(axis=0))
    assert probes.fit([circle_points(1500, 23, 0.3)])["bend"][0] != 0


def test_a_line_has_no_curvature(probes) -> None:
    arc = probes.fit([np.stack([np.arange(50.0), 3 + 0.5 * np.arange(50.0)], axis=1)])
    assert arc["bend"][0] == pytest.approx(0, abs=1e-12)
    assert arc["rms"][0] == pytest.approx(0, abs=1e-6)


def test_a_curvature_over_the_limit_is_held_at_it(probes) -> None:
    arc = probes.fit([circle_points(200, 60, 0.3, (50, 60))])
    assert abs(2 * arc["bend"][0]) == pytest.approx(LARGEST_CURVATURE, rel=1e-3)
    # u^2 over a length L has the standard deviation L^2 / (6 sqrt(5))
    left = (1 / 200 - LARGEST_CURVATURE) * 60**2 / (12 * np.sqrt(5))
    assert arc["rms"][0] == pytest.approx(left, rel=0.05)


@pytest.mark.parametrize("count", [1, 2])
def test_too_few_points_for_a_direction_are_no_trouble(probes, count: int) -> None:
    arc = probes.fit([np.array([[5.0, 6.0]] * count)])
    assert arc["foot"][0].tolist() == [5.0, 6.0]
    assert arc["rms"][0] == 0
    assert np.isfinite([arc[name][0] for name in ("low", "high", "bend")]).all()


@given(cut=st.integers(2, 198), noise=st.sampled_from([0.0, 0.2]))
def test_the_moments_of_two_parts_give_the_fit_of_the_whole(probes, cut: int, noise: float) -> None:
    points = circle_points(1400, 200, 1.1, (3000, 2000), noise)
    parts, whole = probes.fit([points[:cut], points[cut:]]), probes.fit([points])
    joined = probes.join(parts[:1], parts[1:])
    assert joined["sums"][0, 0] == len(points)
    for name in ("foot", "tangent", "bend"):
        assert joined[name] == pytest.approx(whole[name], rel=1e-6, abs=1e-9)
    assert joined["rms"] == pytest.approx(whole["rms"], rel=1e-6, abs=1e-4)
    # the ends are those of the parts, which differ from the whole by what they miss each other
    assert joined["low"] == pytest.approx(whole["low"], abs=0.02)
    assert joined["high"] == pytest.approx(whole["high"], abs=0.02)


@pytest.mark.parametrize(("longer", "shorter"), [(0, 1), (1, 0)])
def test_a_flipped_part_changes_its_sides_with_the_longer_ones(probes, longer: int, shorter: int) -> None:
    runs = [np.stack([x, np.full(len(x), 5.0)], axis=1) for x in (np.arange(40.0), np.arange(70.0, 50.0, -1))]
    if longer:
        runs = [np.stack([x, np.full(len(x), 5.0)], axis=1) for x in (np.arange(20.0), np.arange(70.0, 25.0, -1))]
    arcs = probes.fit(runs, np.array([[1.0, 2.0, 100.0], [10.0, 20.0, 1000.0]]))
    joined = probes.join(arcs[:1], arcs[1:], leave_end=True, enter_start=False)
    expected = arcs["traits"][longer] + arcs["traits"][shorter][[1, 0, 2]]
    assert joined["traits"][0].tolist() == expected.tolist()
    assert joined["tangent"][0] == pytest.approx(arcs["tangent"][longer])
    assert joined["high"][0] - joined["low"][0] == pytest.approx(70)


@pytest.mark.parametrize("curvature", [5e-4, -5e-4])
@pytest.mark.parametrize("step", [1, -1])
def test_an_arc_runs_from_its_first_point_to_its_last(probes, curvature: float, step: int) -> None:
    x = np.arange(101.0)
    points = np.stack([x + 10, 20 + 0.5 * curvature * (x - 50) ** 2], axis=1)[::step]
    arc = probes.fit([points])
    along, distances = probes.project(arc, points)
    assert np.abs(distances).max() < 1e-3
    assert (np.diff(along) > 0).all()
    assert ends(arc)[0] == pytest.approx(points[[0, -1]], abs=1e-3)
    assert probes.place(arc, along)[0] == pytest.approx(points, abs=1e-3)


@given(radius=st.floats(1001, 1e7), u=st.floats(-120, 120), distance=st.floats(-20, 20))
def test_projecting_undoes_placing(probes, radius: float, u: float, distance: float) -> None:
    arc = probes.fit([circle_points(radius, 100, 0.7, (300, 200))])
    place, direction = probes.place(arc, np.array([u]))
    assert np.hypot(*direction[0]) == pytest.approx(1)
    assert positions(arc, np.array([u])) == pytest.approx(place)
    point = place + distance * np.array([[-direction[0, 1], direction[0, 0]]])
    along, away = probes.project(arc, point)
    assert (along[0], away[0]) == (pytest.approx(u, abs=1e-6), pytest.approx(distance, abs=1e-6))
    assert project(arc, point)[0] == pytest.approx(u, abs=1e-6)


@pytest.mark.parametrize(("norm", "tangent"), [(90.0, [1.0, 0.0]), (-90.0, [-1.0, 0.0])])
def test_a_piece_is_directed_so_that_the_bright_side_is_that_of_its_normal(edges_of, norm: float, tangent) -> None:
    edges = edges_of(np.arange(10, 50), np.full(40, 30.0), norm=norm)
    bright = edges.gray[31:] if norm > 0 else edges.gray[:30]
    bright[:] = 200
    runs = find_runs(edges, 0, 30, 60), find_runs(edges, 1, 30, 60)
    arcs = fit_pieces(edges, runs)
    assert len(arcs) == 3
    assert arcs["tangent"][0] == pytest.approx(tangent)
    assert arcs["traits"][0].tolist() == [0, 40 * 200, 40 * 90]
    assert (arcs["first_piece"][0], arcs["last_piece"][0], arcs["first_join"][0]) == (0, 0, -1)
    assert sorted(ends(arcs[:1])[0, :, 0]) == pytest.approx([10, 49])
