"""Whatever the pixels, `detect` gives valid segments."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.segments import Segments

EVERYTHING = DetectionParameters(min_length=10, low_threshold=1, high_threshold=1, operating_point="recall")


def check(found: Segments, image: np.ndarray, shortest: float) -> None:
    """Raise unless these are segments that this image may have."""
    height, width = image.shape
    assert (found.counts >= 2).all()
    assert found.extents().min(initial=shortest) >= shortest
    assert found.points.min(initial=0) >= 0
    assert (found.points <= [width - 1, height - 1]).all()
    assert found.scores is not None
    assert ((found.scores >= 0) & (found.scores <= 1)).all()
    # in order: from column to column, or from row to row
    for line in found:
        steps = np.diff(line, axis=0)
        assert ((steps > 0).all(axis=0) | (steps < 0).all(axis=0)).any()


@settings(max_examples=60, deadline=None)
@given(
    hnp.arrays(
        st.sampled_from([np.uint8, np.uint16, np.float32]),
        hnp.array_shapes(min_dims=2, max_dims=2, max_side=40),
        elements={"min_value": 0, "max_value": 200},
    )
)
def test_small_images(image: np.ndarray) -> None:
    check(detect(image, EVERYTHING), image, 10)


@settings(max_examples=40, deadline=None)
@given(
    st.integers(1, 200),
    st.integers(1, 200),
    st.integers(0, 2**32 - 1),
    st.sampled_from(["noise", "blocks", "stripes", "ramp", "dots"]),
    st.sampled_from([np.uint8, np.uint16, np.float32, np.float64]),
)
def test_images_of_a_kind(height: int, width: int, seed: int, kind: str, dtype: type) -> None:
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:height, :width]
    image = {
        "noise": lambda: rng.integers(0, 256, (height, width)),
        "blocks": lambda: rng.integers(0, 256, (14, 14))[y // 16 % 14, x // 16 % 14],
        "stripes": lambda: 127 + 127 * np.sin(x * rng.uniform(-2, 2) + y * rng.uniform(-2, 2)),
        "ramp": lambda: x * rng.uniform(0, 0.6) + y * rng.uniform(0, 0.6),
        "dots": lambda: 255 * (rng.uniform(0, 1, (height, width)) < 0.02),
    }[kind]().astype(dtype)
    check(detect(image, EVERYTHING), image, 10)


@settings(max_examples=30, deadline=None)
@given(
    st.floats(10, 200),
    st.floats(1, 200),
    st.floats(0, 300),
    st.floats(1, 40),
    st.floats(16, 4096),
    st.floats(0.3, 5),
    st.sampled_from(["recall", "balanced", "precise"]),
)
def test_any_parameters(windows, length, low, more, clip, tile, sigma, point) -> None:
    image = windows[60:160, 20:220]
    parameters = DetectionParameters(length, low, low + more, clip, tile, sigma, point)
    check(detect(image, parameters), image, length)


@pytest.mark.parametrize("period", [1, 2, 3, 4, 7, 16, 40])
def test_checkerboards_have_upright_and_level_edges_only(period: int) -> None:
    y, x = np.mgrid[:200, :240] // period
    board = ((x + y) % 2 * 255).astype(np.uint8)
    found = detect(board, DetectionParameters(min_length=60, operating_point="recall"))
    check(found, board, 60)
    if period >= 16:
        assert len(found) > 5
        for line in found:
            assert np.abs(line[0] - line[-1]).min() < 1.0


@pytest.mark.parametrize(
    "shape",
    [(1, 1), (1, 5000), (5000, 1), (2, 2), (2, 5000), (3, 3), (3, 4), (4, 3), (5, 5), (7, 9), (3, 20000), (20000, 3)],
)
def test_tiny_and_thin_images(shape: tuple[int, int]) -> None:
    noise = np.random.default_rng(1).integers(0, 255, shape).astype(np.uint8)
    check(detect(noise, EVERYTHING), noise, 10)


def test_a_thin_strip_has_its_edge() -> None:
    strip = np.full((9, 4000), 50, np.uint8)
    strip[5:] = 180
    for image in (strip, np.ascontiguousarray(strip.T)):
        found = detect(image)
        assert len(found) == 1
        assert found.extents()[0] > 3990


@pytest.mark.parametrize("value", [-1e30, 0.0, 1e-30, 1e30])
def test_floats_of_any_size(value: float) -> None:
    image = np.full((40, 60), value)
    assert len(detect(image, EVERYTHING)) == 0
    image[20:] = value + max(abs(value), 1e-30)
    assert len(detect(image, DetectionParameters(min_length=50))) == 1
