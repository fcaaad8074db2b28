from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.errors import InvalidImage
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.segments import Segments

YORK = Path(__file__).parents[2].parent / "shared" / "data" / "york" / "images"
ALL_LONG_LINES = DetectionParameters(min_length=50)


@pytest.fixture(scope="module")
def windows() -> np.ndarray:
    """A wall with a slanted roof line and four windows, smooth and slightly noisy, 321 x 241."""
    large = np.full((241 * 4, 321 * 4), 90, np.uint8)
    cv2.fillPoly(large, [np.array([[0, 0], [1284, 0], [1284, 180], [0, 340]])], (190,))
    for x in (160, 760):
        for y in (400, 660):
            cv2.rectangle(large, (x, y), (x + 330, y + 200), (30,), -1)
    image = cv2.resize(large, (321, 241), interpolation=cv2.INTER_AREA).astype(float)
    return np.clip(image + np.random.default_rng(5).normal(0, 1.5, image.shape), 0, 255).astype(np.uint8)


def ends(segments: Segments) -> np.ndarray:
    """End points, ``(S, 4)``."""
    return np.array([np.concatenate([line[0], line[-1]]) for line in segments], float).reshape(-1, 4)


def share_found(segments: np.ndarray, others: np.ndarray, tolerance: float) -> float:
    """Share of segments that have one among the others with the same ends, in either order."""
    turned = others[:, [2, 3, 0, 1]]
    gap = np.minimum(np.abs(segments[:, None] - others).max(axis=2), np.abs(segments[:, None] - turned).max(axis=2))
    return float((gap.min(axis=1) <= tolerance).mean())


def test_every_edge_is_found_once_where_it_is(windows: np.ndarray) -> None:
    found = ends(detect(windows, DetectionParameters(min_length=40)))
    roof = [[0, 84.6, 320, 44.6]]
    frames = []
    for x in (39.5, 189.5):
        for y in (99.5, 164.5):
            right, bottom = x + 82.6, y + 50.1
            frames += [[x, y, right, y], [x, bottom, right, bottom], [x, y, x, bottom], [right, y, right, bottom]]
    expected = np.array(roof + frames)
    assert len(found) == len(expected)
    assert share_found(expected, found, 5.0) == 1.0


def test_points_are_in_order_and_on_the_line(windows: np.ndarray) -> None:
    for line in detect(windows, DetectionParameters(min_length=40)):
        chord = (line[-1] - line[0]) / np.hypot(*(line[-1] - line[0]))
        assert (np.diff(line @ chord) > 0).all()
        across = (line - line[0]) @ np.array([-chord[1], chord[0]])
        assert np.polynomial.Polynomial.fit(line @ chord, across, 1)(line @ chord) == pytest.approx(across, abs=0.8)
        assert np.std(across - np.polynomial.Polynomial.fit(line @ chord, across, 1)(line @ chord)) < 0.15


def test_the_length_is_at_least_what_was_asked_for(windows: np.ndarray) -> None:
    long = detect(windows)
    assert len(long) == 1
    assert long.extents().min() >= 100
    assert detect(windows, ALL_LONG_LINES).extents().min() >= 50


def test_scores_fall_from_the_best_on(windows: np.ndarray) -> None:
    scores = detect(windows, ALL_LONG_LINES).scores
    assert scores is not None
    assert (np.diff(scores) <= 0).all()
    assert 0 <= scores.min() <= scores.max() <= 1


def test_two_calls_give_the_same(windows: np.ndarray) -> None:
    assert detect(windows, ALL_LONG_LINES) == detect(windows, ALL_LONG_LINES)


def test_sixteen_bit_and_float_give_what_eight_bit_gives(windows: np.ndarray) -> None:
    stretched = windows.astype(np.uint16) * 200
    assert detect(stretched, ALL_LONG_LINES) == detect(stretched.astype(np.float32), ALL_LONG_LINES)
    assert share_found(ends(detect(windows, ALL_LONG_LINES)), ends(detect(stretched, ALL_LONG_LINES)), 2.0) == 1.0


@pytest.mark.parametrize("operation", ["mirror-x", "mirror-y", "transpose"])
def test_a_mirrored_or_transposed_image_gives_the_same(windows: np.ndarray, operation: str) -> None:
    height, width = windows.shape
    found = ends(detect(windows, ALL_LONG_LINES))
    if operation == "transpose":
        other = ends(detect(np.ascontiguousarray(windows.T), ALL_LONG_LINES))[:, [1, 0, 3, 2]]
    elif operation == "mirror-x":
        other = ends(detect(np.ascontiguousarray(windows[:, ::-1]), ALL_LONG_LINES)) * [-1, 1, -1, 1]
        other += [width - 1, 0, width - 1, 0]
    else:
        other = ends(detect(np.ascontiguousarray(windows[::-1]), ALL_LONG_LINES)) * [1, -1, 1, -1]
        other += [0, height - 1, 0, height - 1]
    assert len(found) == len(other)
    assert share_found(found, other, 0.01) == 1.0


@pytest.mark.parametrize("flip", [0, 1, "transpose"])
def test_a_mirrored_photo_gives_nearly_the_same(flip: int | str) -> None:
    path = YORK / "P1020171.jpg"
    if not path.exists():
        pytest.skip(f"no {path}")
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    assert image is not None
    found = ends(detect(image, ALL_LONG_LINES))
    if flip == "transpose":
        other = ends(detect(np.ascontiguousarray(image.T), ALL_LONG_LINES))[:, [1, 0, 3, 2]]
    else:
        flipped = ends(detect(np.ascontiguousarray(np.flip(image, int(flip))), ALL_LONG_LINES))
        other = np.abs(flipped - ([639, 0] * 2 if flip == 1 else [0, 479] * 2))
    assert len(found) > 100
    # decisions at a threshold may fall the other way by rounding
    assert share_found(found, other, 0.05) >= 0.9


@pytest.mark.parametrize("shape", [(1, 1), (1, 5000), (5000, 1), (2, 2), (3, 3), (3, 500), (7, 9)])
def test_tiny_and_thin_images_are_no_trouble(shape: tuple[int, int]) -> None:
    noise = np.random.default_rng(1).integers(0, 255, shape).astype(np.uint8)
    assert isinstance(detect(noise), Segments)


@pytest.mark.parametrize("value", [0, 128, 255])
def test_a_constant_image_has_no_candidates(value: int) -> None:
    found = detect(np.full((120, 200), value, np.uint8), DetectionParameters(min_length=10))
    assert len(found) == 0
    assert found.scores is not None


def test_a_checkerboard_gives_segments_of_its_lines_only() -> None:
    board = (np.indices((160, 160)).sum(axis=0) % 2 * 255).astype(np.uint8)
    assert isinstance(detect(board), Segments)
    squares = np.kron(np.indices((5, 5)).sum(axis=0) % 2, np.full((40, 40), 255)).astype(np.uint8)
    for line in ends(detect(squares, DetectionParameters(min_length=100, operating_point="recall"))):
        moved = np.abs(line[:2] - line[2:])
        assert moved.min() < 1.0


@settings(max_examples=25, deadline=None)
@given(hnp.arrays(st.sampled_from([np.uint8, np.uint16]), hnp.array_shapes(min_dims=2, max_dims=2, max_side=40)))
def test_any_image_gives_valid_segments(image: np.ndarray) -> None:
    found = detect(image, DetectionParameters(min_length=10, operating_point="recall"))
    assert (found.counts >= 2).all()
    height, width = image.shape
    if len(found):
        assert found.points.min() >= -1
        assert (found.points.max(axis=0) <= [width, height]).all()


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((4, 4, 3), np.uint8),
        np.zeros(4, np.uint8),
        np.zeros((0, 4), np.uint8),
        np.zeros((4, 4), np.int64),
        np.full((4, 4), np.nan),
        np.full((4, 4), np.inf, np.float32),
        np.broadcast_to(np.uint8(0), (6400, 6400)),
        [[1, 2], [3, 4]],
    ],
)
def test_what_cannot_be_read_is_refused(image: np.ndarray) -> None:
    with pytest.raises(InvalidImage) as caught:
        detect(image)
    assert caught.value.message


def test_fewer_candidates_are_precise_and_more_recall() -> None:
    path = YORK / "P1020816.jpg"
    if not path.exists():
        pytest.skip(f"no {path}")
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    assert image is not None
    counts = [
        len(detect(image, DetectionParameters(min_length=50, operating_point=point)))
        for point in ("precise", "balanced", "recall")
    ]
    assert counts[0] < counts[1] < counts[2]
