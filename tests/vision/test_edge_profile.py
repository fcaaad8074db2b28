"""Brightness across a segment, on edges whose steps are known."""

from __future__ import annotations

import numpy as np
import pytest

from app.errors import InvalidInput
from app.vision.edge_profile import edge_profile

WAY = np.stack([np.arange(10, 60, dtype=np.float32), np.full(50, 19.5, np.float32)], -1)


def step(upper: int, lower: int) -> np.ndarray:
    image = np.full((40, 80), upper, np.uint8)
    image[20:] = lower
    return image


def test_an_even_edge() -> None:
    profile = edge_profile(step(30, 130), WAY)
    assert profile.along == pytest.approx(np.arange(50.0))
    # right of a way to the right is below, where y is greater
    assert profile.step == pytest.approx(np.full(50, 100.0))
    assert (profile.contrast, profile.evenness, profile.polarity) == pytest.approx((100, 1, 1))


def test_the_other_way_round_the_step_is_the_other_way_round() -> None:
    profile = edge_profile(step(30, 130), WAY[::-1])
    assert profile.step == pytest.approx(np.full(50, -100.0))
    assert profile.polarity == 1


def test_an_edge_that_changes_its_bright_side() -> None:
    image = step(30, 130)
    image[:, 40:] = 160 - image[:, 40:]
    profile = edge_profile(image, WAY)
    assert profile.step[:30] == pytest.approx(np.full(30, 100.0))
    assert profile.step[31:] == pytest.approx(np.full(19, -100.0))
    assert profile.polarity == pytest.approx(0.6, abs=0.03)


def test_an_edge_with_gaps_is_uneven() -> None:
    image = step(30, 130)
    image[:, 24:44] = 80
    profile = edge_profile(image, WAY)
    assert profile.contrast == pytest.approx(100)
    assert profile.evenness == 0


def test_beyond_the_frame_the_border_counts() -> None:
    profile = edge_profile(np.array([[10, 50]], np.uint8), np.array([[0, 0], [1, 0]], np.float32))
    assert profile.step == pytest.approx([0, 0])


def test_one_point_is_no_edge() -> None:
    with pytest.raises(InvalidInput, match="1 points"):
        edge_profile(step(0, 255), WAY[:1])
