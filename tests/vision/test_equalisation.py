import numpy as np
import pytest

from app.vision.equalisation import equalise


@pytest.fixture
def scene() -> np.ndarray:
    noise = np.random.default_rng(3).integers(0, 40, (61, 83))
    return (noise + np.linspace(0, 120, 83)).astype(np.uint8)


def test_low_contrast_is_raised(scene: np.ndarray) -> None:
    result = equalise(scene // 4, clip=4.0, tile=32)
    assert result.dtype == np.float32
    assert result.std() > 1.5 * (scene // 4).std()
    assert result.min() >= 0
    assert result.max() <= 255


@pytest.mark.parametrize("axis", [0, 1])
def test_a_mirrored_image_is_equalised_alike(scene: np.ndarray, axis: int) -> None:
    mirrored = equalise(np.ascontiguousarray(np.flip(scene, axis)), 2.0, 24)
    assert np.array_equal(np.flip(mirrored, axis), equalise(scene, 2.0, 24))


def test_a_transposed_image_is_equalised_alike(scene: np.ndarray) -> None:
    transposed = equalise(np.ascontiguousarray(scene.T), 2.0, 24)
    # OpenCV's interpolation may round a half the other way in one of the four
    assert np.abs(transposed.T - equalise(scene, 2.0, 24)).max() <= 1.0


def test_an_image_smaller_than_a_tile_is_one_tile() -> None:
    assert equalise(np.zeros((3, 3), np.uint8), 2.0, 96).shape == (3, 3)
