"""Reading an image between its pixels, on numbers known by hand."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.image_reading import COLUMNS, read_image

IMAGE = np.array([[0, 10], [20, 40]], np.float32)


def test_between_pixels_and_beyond_the_border() -> None:
    places = np.array([[[0, 0], [0.5, 0]], [[0.5, 0.5], [-3, 9]]], np.float64)
    assert read_image(IMAGE, places) == pytest.approx(np.array([[0, 5], [17.5, 20]]))


@pytest.mark.parametrize("count", [0, 1, COLUMNS, COLUMNS + 1])
def test_any_number_of_places(count: int) -> None:
    values = read_image(IMAGE, np.tile([1.0, 1.0], (count, 1)))
    assert values.shape == (count,)
    assert (values == 40).all()
