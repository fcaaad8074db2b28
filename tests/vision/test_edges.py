import numpy as np
import pytest

from app.vision.edges import Gradient, edge_pixels, gradient


def _field(norm: np.ndarray, x: float, y: float) -> Gradient:
    norm = norm.astype(np.float32)
    return Gradient(norm * np.float32(x), norm * np.float32(y), norm)


def test_a_step_has_four_times_its_height_before_blurring() -> None:
    image = np.zeros((9, 12), np.uint8)
    image[:, 6:] = 20
    field = gradient(image, sigma=0.3)
    # a blur of 0.3 px leaves almost all of the step between two columns
    assert field.x[4, 5] == pytest.approx(80, rel=0.01)
    assert field.x[4, 6] == pytest.approx(80, rel=0.01)
    assert not field.y.any()


def test_only_the_maxima_across_the_edge_stay() -> None:
    norm = np.zeros((7, 5))
    norm[2:5, 1:4] = [[50, 50, 50], [90, 90, 90], [60, 60, 60]]
    found = edge_pixels(_field(norm, 0, 1), 40, axis=0)
    assert found.rows.tolist() == [3, 3, 3]
    assert found.columns.tolist() == [1, 2, 3]
    assert not len(edge_pixels(_field(norm, 0, 1), 95, axis=0).rows)


def test_of_a_tie_the_first_pixel_is_taken() -> None:
    norm = np.zeros((6, 3))
    norm[2:4, 1] = 50
    assert edge_pixels(_field(norm, 0, 1), 40, axis=0).rows.tolist() == [2]


def test_the_threshold_must_be_exceeded() -> None:
    norm = np.zeros((5, 5))
    norm[2, 2] = 40
    assert not len(edge_pixels(_field(norm, 0, 1), 40, axis=0).rows)


@pytest.mark.parametrize(("degrees", "passes"), [(0, {1}), (38, {1}), (45, {0, 1}), (52, {0}), (90, {0})])
def test_directions_belong_to_the_passes_with_an_overlap_at_the_diagonal(degrees: float, passes: set[int]) -> None:
    norm = np.zeros((5, 5))
    norm[2, 2] = 100
    field = _field(norm, float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees))))
    assert {axis for axis in (0, 1) if len(edge_pixels(field, 40, axis).rows)} == passes


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 2), (2, 2)])
def test_an_image_without_an_inside_has_no_edges(shape: tuple[int, int]) -> None:
    field = gradient(np.arange(np.prod(shape), dtype=np.uint8).reshape(shape), 0.5)
    assert not len(edge_pixels(field, 1, 0).rows)


def test_the_border_is_left_out() -> None:
    image = np.random.default_rng(0).integers(0, 255, (20, 30)).astype(np.uint8)
    found = edge_pixels(gradient(image, 0.5), 5, axis=1)
    assert found.rows.min() == 1
    assert found.columns.max() == 28
