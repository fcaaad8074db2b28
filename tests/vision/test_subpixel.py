import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.vision.edges import edge_pixels, gradient
from app.vision.subpixel import EdgePoints, parabola_offset, refine


def half_plane(angle: float, offset: float, size: int = 61) -> np.ndarray:
    """Share of each pixel's area beyond a line at ``angle``, ``offset`` px beyond the image's centre; exact.

    The area of a unit square beyond a line is the convolution of two boxes as wide as the normal's components.
    """
    normal = np.array([-np.sin(angle), np.cos(angle)])
    y, x = np.mgrid[:size, :size] - size // 2
    distance = x * normal[0] + y * normal[1] - offset
    a, b = np.sort(np.abs(normal))
    if a < 1e-9:
        return np.clip(distance + 0.5, 0, 1)

    def ramp(t: np.ndarray) -> np.ndarray:
        return np.maximum(t, 0) ** 2

    corners = ramp(distance + (a + b) / 2) + ramp(distance - (a + b) / 2)
    return (corners - ramp(distance + (b - a) / 2) - ramp(distance - (b - a) / 2)) / (2 * a * b)


def measure(angle: float, offset: float, sigma: float = 1.0) -> np.ndarray:
    """Signed distances in px of the points found from the true line, points near the border left out."""
    image = (50 + 150 * half_plane(angle, offset)).astype(np.float32)
    field = gradient(image, sigma)
    errors = []
    for axis in (0, 1):
        points = refine(edge_pixels(field, 100, axis), field, field).points()
        inside = (points > 5).all(axis=1) & (points < 55).all(axis=1)
        relative = points[inside] - 30
        errors.append(relative @ np.array([-np.sin(angle), np.cos(angle)]) - offset)
    return np.concatenate(errors)


def test_the_parabola_is_exact_for_parabolas() -> None:
    peak = np.array([-0.5, -0.2, 0.0, 0.31, 0.5])
    values = [10 - 3 * (k - peak) ** 2 for k in (-1, 0, 1)]
    assert parabola_offset(*values) == pytest.approx(peak)


def test_three_equal_values_have_no_offset() -> None:
    ones = np.ones(1)
    assert parabola_offset(ones, ones, ones).tolist() == [0.0]


@given(angle=st.floats(0, np.pi), offset=st.floats(-0.5, 0.5))
def test_an_anti_aliased_edge_is_found_within_a_tenth_of_a_pixel(angle: float, offset: float) -> None:
    errors = measure(angle, offset)
    assert len(errors) > 30
    assert np.abs(errors).max() < 0.1


def test_the_error_over_all_edges_is_small_and_without_bias() -> None:
    rng = np.random.default_rng(7)
    errors = [
        measure(float(a), float(o)) for a, o in zip(rng.uniform(0, np.pi, 60), rng.uniform(-0.5, 0.5, 60), strict=True)
    ]
    everything = np.concatenate(errors)
    assert np.sqrt((everything**2).mean()) <= 0.025
    assert abs(everything.mean()) < 0.01


@pytest.mark.parametrize("offset", [0.0, 0.2, 0.45])
def test_upright_and_level_edges_have_no_constant_bias(offset: float) -> None:
    for angle in (0.0, np.pi / 2):
        assert abs(measure(angle, offset).mean()) <= 0.03


def test_the_position_comes_from_the_image_before_equalisation() -> None:
    plain = gradient((50 + 100 * half_plane(0.0, 0.3)).astype(np.float32), 1.0)
    shifted = gradient((50 + 100 * half_plane(0.0, 0.0)).astype(np.float32), 1.0)
    points = refine(edge_pixels(shifted, 50, 0), shifted, plain)
    assert points.across.mean() == pytest.approx(30.3, abs=0.03)


def test_a_point_without_a_plain_maximum_keeps_its_equalised_position() -> None:
    strong = gradient((50 + 100 * half_plane(0.0, 0.3)).astype(np.float32), 1.0)
    flat = gradient(np.full((61, 61), 9, np.uint8), 1.0)
    points = refine(edge_pixels(strong, 50, 0), strong, flat)
    assert points.across.mean() == pytest.approx(30.3, abs=0.03)


def test_slope_sign_and_index_describe_the_edge() -> None:
    angle = np.radians(20.0)
    field = gradient((200 * half_plane(angle, 0.1)).astype(np.float32), 1.0)
    points: EdgePoints = refine(edge_pixels(field, 100, 0), field, field)
    middle = np.abs(points.along - 30) < 20
    assert points.slope[middle] == pytest.approx(np.tan(angle), abs=0.02)
    assert (points.sign == 1).all()
    rows = np.arange(len(points))
    assert np.array_equal(points.find(points.along, np.rint(points.across).astype(np.int64))[middle], rows[middle])
    outside = points.find(np.array([-1, 61, 3]), np.array([3, 3, -1]))
    assert outside.tolist() == [-1, -1, -1]
