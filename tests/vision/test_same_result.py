"""What must not change the result: another call, threads, a mirror, a transposition."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.segments import Segments

PARAMETERS = DetectionParameters(min_length=50)


def end_points(segments: Segments) -> np.ndarray:
    """End points ``(S, 2, 2)``."""
    return np.stack([segments.points[segments.offsets[:-1]], segments.points[segments.offsets[1:] - 1]], axis=1)


def share_with_counterpart(segments: np.ndarray, others: np.ndarray, tolerance: float = 0.05) -> float:
    """Share of the segments for which there is one with both ends no farther away than the tolerance."""
    distances = [
        np.abs(segments[:, None] - candidates[None]).max(axis=(2, 3)) for candidates in (others, others[:, ::-1])
    ]
    return float((np.minimum(*distances).min(axis=1) <= tolerance).mean())


def mirrored_x(image: np.ndarray) -> tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]:
    return image[:, ::-1], lambda points: np.array([image.shape[1] - 1, 0]) + points * [-1, 1]


def mirrored_y(image: np.ndarray) -> tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]:
    return image[::-1], lambda points: np.array([0, image.shape[0] - 1]) + points * [1, -1]


def transposed(image: np.ndarray) -> tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]:
    return image.T, lambda points: points[..., ::-1]


OPERATIONS = [mirrored_x, mirrored_y, transposed]


@pytest.mark.parametrize("operation", OPERATIONS)
def test_a_mirrored_or_transposed_scene_gives_the_same(windows: np.ndarray, operation) -> None:
    parameters = DetectionParameters(min_length=40)
    other, back = operation(windows)
    one, two = end_points(detect(windows, parameters)), back(end_points(detect(other, parameters)))
    assert len(one) == len(two) == 17
    assert share_with_counterpart(one, two, 0.01) == 1.0


@pytest.mark.parametrize("name", ["P1020171", "P1080084"])
@pytest.mark.parametrize("operation", OPERATIONS)
def test_of_a_mirrored_or_transposed_photo_97_percent_are_the_same(street, name: str, operation) -> None:
    image = street(name)
    other, back = operation(image)
    one, two = end_points(detect(image, PARAMETERS)), back(end_points(detect(other, PARAMETERS)))
    assert len(one) > 100
    # a decision at a threshold, or between equals, may fall the other way by rounding
    assert share_with_counterpart(one, two) >= 0.97
    assert share_with_counterpart(two, one) >= 0.97


def test_every_call_gives_the_same_bits_from_one_thread_and_from_four(street) -> None:
    images = [street(name) for name in ("P1020171", "P1020816")]
    alone = [detect(image, PARAMETERS) for image in images]
    assert alone == [detect(image, PARAMETERS) for image in images]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda number: detect(images[number % 2], PARAMETERS), range(8)))
    assert [found == alone[number % 2] for number, found in enumerate(together)] == [True] * 8


def test_scenes_of_different_size_may_be_detected_at_once(windows: np.ndarray) -> None:
    images = [np.ascontiguousarray(windows[: 241 - 20 * cut, : 321 - 10 * cut]) for cut in range(6)]
    alone = [detect(image, PARAMETERS) for image in images]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(lambda image: detect(image, PARAMETERS), images * 3)) == alone * 3
