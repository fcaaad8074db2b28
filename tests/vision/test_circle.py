import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.vision.circle import distances, fit_circles, moment_sums, shift_sums


def arc(radius: float, length: float, angle: float, center: tuple[float, float], noise: float = 0.0) -> np.ndarray:
    """Points 1 px apart on an arc through ``center`` with direction ``angle`` in its middle."""
    u = np.linspace(-length / 2, length / 2, int(length) + 1)
    turned = u / radius
    x, y = radius * np.sin(turned), 2 * radius * np.sin(turned / 2) ** 2
    y = y + np.random.default_rng(1).normal(0, noise, len(u))
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x - s * y + center[0], s * x + c * y + center[1]], axis=1)


def fit(points: np.ndarray, limit: float = np.inf):
    return fit_circles(*moment_sums(points, np.array([0, len(points)])), limit)


@given(
    radius=st.floats(300, 1e9),
    length=st.floats(30, 250),
    angle=st.floats(-3.1, 3.1),
    x=st.floats(0, 8000),
    y=st.floats(0, 6000),
)
def test_an_exact_arc_is_found_whatever_its_radius(
    radius: float, length: float, angle: float, x: float, y: float
) -> None:
    points = arc(radius, length, angle, (x, y))
    circles = fit(points)
    # rounding of coordinates of thousands of px leaves about 1e-12 px, times 8 / length^2 in curvature
    assert abs(2 * circles.coefficients[0, 0]) == pytest.approx(1 / radius, rel=1e-5, abs=1e-9)
    assert np.abs(distances(circles.coefficients, points - circles.centre)).max() < 1e-6
    assert circles.rms[0] < 1e-4


def test_the_coefficients_are_normalised() -> None:
    A, B, C, D = fit(arc(400, 120, 0.7, (100, 50), noise=0.3)).coefficients[0]
    assert pytest.approx(1, abs=1e-12) == B * B + C * C - 4 * A * D


def test_a_straight_line_has_no_curvature() -> None:
    points = np.stack([np.arange(50.0), 3 + 0.5 * np.arange(50.0)], axis=1)
    circles = fit(points)
    assert circles.coefficients[0, 0] == pytest.approx(0, abs=1e-12)
    assert circles.rms[0] == pytest.approx(0, abs=1e-6)


def test_the_rms_is_that_of_the_distances() -> None:
    points = arc(900, 150, 0.4, (700, 300), noise=0.4)
    circles = fit(points)
    measured = distances(circles.coefficients, points - circles.centre)
    assert circles.rms[0] == pytest.approx(np.sqrt((measured**2).mean()), rel=1e-3)


def test_distances_are_exact_for_circle_and_line() -> None:
    unit = np.array([0.5, 0.0, 0.0, -0.5])  # x^2 + y^2 = 1
    assert distances(unit, np.array([[3.0, 4.0], [0.0, 0.5], [1.0, 0.0]])) == pytest.approx([4, -0.5, 0])
    line = np.array([0.0, 0.6, 0.8, -5.0])
    assert distances(line, np.array([[3.0, 4.0], [0.0, 0.0]])) == pytest.approx([0, -5])


@given(
    points=st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=1, max_size=20),
    by=st.tuples(st.floats(-40, 40), st.floats(-40, 40)),
)
def test_shifted_sums_are_the_sums_about_the_other_origin(
    points: list[tuple[float, float]], by: tuple[float, float]
) -> None:
    array = np.array(points)
    origin, sums = moment_sums(array, np.array([0, len(array)]))
    x, y = (array - origin[0] - by).T
    z = x * x + y * y
    expected = [len(x), *(term.sum() for term in (x, y, x * x, x * y, y * y, x * z, y * z, z * z))]
    assert shift_sums(sums, np.array([by]))[0] == pytest.approx(expected, rel=1e-9, abs=1e-4)


def test_moments_of_two_halves_add_up_to_the_whole() -> None:
    points = arc(500, 200, 1.1, (3000, 2000), noise=0.2)
    origin, sums = moment_sums(points, np.array([0, 80, len(points)]))
    together = sums[:1] + shift_sums(sums[1:], origin[:1] - origin[1:])
    merged, whole = fit_circles(origin[:1], together), fit(points)
    assert merged.rms == pytest.approx(whole.rms, rel=1e-9)
    assert merged.centre == pytest.approx(whole.centre)
    assert np.abs(merged.coefficients) == pytest.approx(np.abs(whole.coefficients), rel=1e-6, abs=1e-9)


def test_a_curvature_over_the_limit_is_held_at_it() -> None:
    points = arc(200, 60, 0.3, (50, 60))
    held = fit(points, 1 / 1000)
    assert abs(2 * held.coefficients[0, 0]) == pytest.approx(1 / 1000, rel=1e-3)
    # u^2 over a length L has the standard deviation L^2 / (6 sqrt(5))
    left = (1 / 200 - 1 / 1000) * 60**2 / (12 * np.sqrt(5))
    assert held.rms[0] == pytest.approx(left, rel=0.05)


def test_the_limit_zero_fits_a_line() -> None:
    line = fit(arc(200, 60, 0.3, (50, 60)), 0.0)
    assert line.coefficients[0, 0] == 0
    direction = np.array([-line.coefficients[0, 2], line.coefficients[0, 1]])
    assert abs(direction @ [np.cos(0.3), np.sin(0.3)]) == pytest.approx(1, abs=1e-6)


def test_one_point_gives_a_line_through_it() -> None:
    circles = fit(np.array([[5.0, 6.0]]))
    assert circles.centre.tolist() == [[5.0, 6.0]]
    assert circles.rms.tolist() == [0.0]


def test_no_runs_give_no_circles() -> None:
    origin, sums = moment_sums(np.zeros((0, 2)), np.zeros(1, np.int64))
    assert len(fit_circles(origin, sums).rms) == 0
