import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.errors import InvalidImage
from app.vision.intensity import to_eight_bit


def test_eight_bit_is_left_alone() -> None:
    image = np.arange(12, dtype=np.uint8).reshape(3, 4)
    assert to_eight_bit(image) is image


def test_sixteen_bit_is_stretched_between_its_percentiles() -> None:
    image = np.arange(10_001, dtype=np.uint16).reshape(1, -1) + 500
    result = to_eight_bit(image)[0]
    # the 0.5 and 99.5 percentiles of 500 ... 10500 are 550 and 10450
    assert result[:51].max() == 0
    assert result[9950:].min() == 255
    assert result[5000] == round((5500 - 550) / (10450 - 550) * 255)
    assert (np.diff(result.astype(int)) >= 0).all()


@given(hnp.arrays(np.uint16, st.tuples(st.integers(1, 8), st.integers(1, 8))))
def test_the_histogram_gives_numpys_percentiles(image: np.ndarray) -> None:
    low, high = np.percentile(image, [0.5, 99.5])
    if high <= low:
        low, high = image.min(), image.max()
    expected = np.clip((image.astype(float) - low) * (255 / (high - low)), 0, 255) if high > low else image * 0.0
    assert np.abs(to_eight_bit(image) - expected).max() <= 0.5 + 1e-6


@pytest.mark.parametrize("dtype", [np.uint16, np.float32, np.float64])
def test_a_constant_image_becomes_black(dtype: type) -> None:
    assert not to_eight_bit(np.full((4, 5), 7, dtype)).any()


def test_a_rare_value_is_not_lost_when_the_percentiles_are_equal() -> None:
    image = np.zeros((100, 100), np.float32)
    image[50, 50] = 2.0
    assert to_eight_bit(image)[50, 50] == 255


def test_channels_are_stretched_together() -> None:
    image = np.zeros((10, 10, 3), np.uint16)
    image[:5] = (1000, 2000, 4000)
    assert to_eight_bit(image)[0, 0].tolist() == [64, 128, 255]


def test_the_largest_doubles_do_not_overflow() -> None:
    image = np.array([[-8e307, 0.0, 8e307]])
    assert to_eight_bit(image).tolist() == [[0, 128, 255]]


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((2, 2), bool),
        np.zeros((2, 2), np.int32),
        np.zeros((2, 2), np.complex64),
        np.zeros((0, 2), np.uint8),
        np.zeros(4, np.uint8),
        np.zeros((1, 2, 2, 2), np.uint8),
        np.array([[np.nan, 1.0]]),
        np.array([[np.inf, 1.0]], np.float32),
    ],
)
def test_what_is_no_image_is_refused(image: np.ndarray) -> None:
    with pytest.raises(InvalidImage):
        to_eight_bit(image)


def test_a_pixel_that_is_not_finite_is_named() -> None:
    image = np.zeros((3, 4))
    image[2, 1] = np.nan
    with pytest.raises(InvalidImage, match="x 1, y 2"):
        to_eight_bit(image)
