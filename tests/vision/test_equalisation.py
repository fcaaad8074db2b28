"""Equalising tables and the tiles between which they are interpolated."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.vision.equalisation import equalisation


@pytest.fixture
def scene() -> np.ndarray:
    noise = np.random.default_rng(3).integers(0, 40, (61, 83))
    return (noise + np.linspace(0, 120, 83)).astype(np.uint8)


def test_a_table_is_the_cumulative_histogram_of_its_tile(scene: np.ndarray) -> None:
    tables = equalisation(scene, clip=40.0, tile=1000).tables
    counts = np.bincount(scene.ravel(), minlength=256)
    assert counts.max() < 40 * scene.size / 256
    assert tables[0, 0] == pytest.approx(255 * np.cumsum(counts) / scene.size, abs=1e-3)


def test_what_is_above_the_clip_limit_is_spread_over_all_levels(scene: np.ndarray) -> None:
    tables = equalisation(scene, clip=1.5, tile=1000).tables
    counts, limit = np.bincount(scene.ravel(), minlength=256), 1.5 * scene.size / 256
    clipped = np.minimum(counts, limit)
    expected = np.cumsum(clipped + (counts - clipped).sum() / 256) * 255 / scene.size
    assert tables[0, 0] == pytest.approx(expected, abs=1e-3)


def test_a_weak_image_gets_contrast_but_no_more_than_the_clip_allows(scene: np.ndarray) -> None:
    table = equalisation(scene // 4, clip=4.0, tile=1000).tables[0, 0]
    steps = np.diff(table)
    assert table[(scene // 4).max()] - table[(scene // 4).min()] > 1.5 * (scene // 4).max()
    assert steps.max() <= 4.0 + 1.0 + 1e-3


@given(st.integers(3, 300), st.integers(3, 300), st.floats(16, 200), st.floats(1, 40))
def test_tables_rise_from_zero_to_full(width: int, height: int, tile: float, clip: float) -> None:
    gray = np.random.default_rng(width * height).integers(0, 256, (height, width)).astype(np.uint8)
    result = equalisation(gray, clip, tile)
    assert result.tables.shape == (max(1, round(height / tile)), max(1, round(width / tile)), 256)
    assert (np.diff(result.tables, axis=2) >= 0).all()
    assert result.tables[..., 255] == pytest.approx(255, abs=1e-2)
    assert result.tables.min() >= 0


@given(st.integers(3, 500), st.floats(16, 200))
def test_a_pixel_lies_between_the_centres_of_its_tiles(width: int, tile: float) -> None:
    result = equalisation(np.zeros((3, width), np.uint8), 2.0, tile)
    count = result.tables.shape[1]
    place = result.left + result.rightward
    centre = (np.arange(width) + 0.5) / width * count - 0.5
    assert place == pytest.approx(np.clip(centre, 0, count - 1), abs=1e-4)
    assert result.left.min() >= 0
    assert result.left.max() <= max(count - 2, 0)
    assert place == pytest.approx(count - 1 - place[::-1], abs=1e-4)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_mirrored_image_has_mirrored_tables(scene: np.ndarray, axis: int) -> None:
    mirrored = equalisation(np.ascontiguousarray(np.flip(scene, axis)), 2.0, 24)
    assert np.array_equal(np.flip(mirrored.tables, axis), equalisation(scene, 2.0, 24).tables)


def test_a_transposed_image_has_transposed_tables(scene: np.ndarray) -> None:
    transposed = equalisation(np.ascontiguousarray(scene.T), 2.0, 24)
    assert np.array_equal(transposed.tables.swapaxes(0, 1), equalisation(scene, 2.0, 24).tables)
