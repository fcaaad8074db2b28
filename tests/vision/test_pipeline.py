"""The contract of `detect` on made-up scenes."""

import cv2
import numpy as np
import pytest

from app.errors import InvalidImage
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.segments import Segments

ALL_LONG_LINES = DetectionParameters(min_length=40)


def ends(segments: Segments) -> np.ndarray:
    """End points, ``(S, 4)``."""
    return np.array([np.concatenate([line[0], line[-1]]) for line in segments], float).reshape(-1, 4)


def share_found(segments: np.ndarray, others: np.ndarray, tolerance: float) -> float:
    """Share of segments that have one among the others with the same ends, in either order."""
    turned = others[:, [2, 3, 0, 1]]
    gap = np.minimum(np.abs(segments[:, None] - others).max(axis=2), np.abs(segments[:, None] - turned).max(axis=2))
    return float((gap.min(axis=1) <= tolerance).mean())


def test_every_edge_is_found_once_where_it_is(windows: np.ndarray) -> None:
    found = ends(detect(windows, ALL_LONG_LINES))
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
    for line in detect(windows, ALL_LONG_LINES):
        chord = (line[-1] - line[0]) / np.hypot(*(line[-1] - line[0]))
        along, across = (line @ each for each in (chord, np.array([-chord[1], chord[0]])))
        assert (np.diff(along) > 0).all()
        rest = across - np.polynomial.Polynomial.fit(along, across, 1)(along)
        # the first and last points may lie on a corner that blur has rounded off
        assert np.abs(rest).max() < 1.6
        assert np.abs(rest[3:-3]).max() < 0.5
        assert np.std(rest) < 0.2


def test_the_length_is_at_least_what_was_asked_for(windows: np.ndarray) -> None:
    long = detect(windows)
    assert len(long) == 1
    assert long.extents().min() >= 100
    for length in (40, 60, 80.02):
        assert detect(windows, DetectionParameters(min_length=length)).extents().min() >= length


def test_scores_fall_from_the_best_on(windows: np.ndarray) -> None:
    scores = detect(windows, ALL_LONG_LINES).scores
    assert scores is not None
    assert (np.diff(scores) <= 0).all()
    assert 0 <= scores.min() <= scores.max() <= 1


def test_sixteen_bit_and_float_give_what_eight_bit_gives(windows: np.ndarray) -> None:
    stretched = windows.astype(np.uint16) * 200
    assert detect(stretched, ALL_LONG_LINES) == detect(stretched.astype(np.float32), ALL_LONG_LINES)
    assert share_found(ends(detect(windows, ALL_LONG_LINES)), ends(detect(stretched, ALL_LONG_LINES)), 5.0) == 1.0


def test_memory_that_is_not_contiguous_makes_no_difference(windows: np.ndarray) -> None:
    wide = np.zeros((241, 642), np.uint8)
    wide[:, ::2] = windows
    assert detect(wide[:, ::2], ALL_LONG_LINES) == detect(windows, ALL_LONG_LINES)
    assert detect(np.asfortranarray(windows), ALL_LONG_LINES) == detect(windows, ALL_LONG_LINES)


def test_the_image_stays_as_it_is(windows: np.ndarray) -> None:
    image = windows.copy()
    image.setflags(write=False)
    detect(image)
    assert np.array_equal(image, windows)


def test_both_sides_of_a_thin_bar_are_two_edges() -> None:
    for thickness in (3, 5):
        image = np.full((120, 200), 60, np.uint8)
        image[60 : 60 + thickness, 20:180] = 180
        rows = sorted(line[:, 1].mean() for line in detect(cv2.GaussianBlur(image, (0, 0), 0.6)))
        assert rows == pytest.approx([59.5, 59.5 + thickness], abs=0.25)


@pytest.mark.parametrize("value", [0, 128, 255])
def test_a_constant_image_has_no_candidates(value: int) -> None:
    found = detect(np.full((120, 200), value, np.uint8), DetectionParameters(min_length=10))
    assert len(found) == 0
    assert found.scores is not None


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((4, 4, 3), np.uint8),
        np.zeros(4, np.uint8),
        np.zeros((0, 4), np.uint8),
        np.zeros((4, 4), np.int64),
        np.zeros((4, 4), bool),
        np.full((4, 4), np.nan),
        np.full((4, 4), np.inf, np.float32),
        np.broadcast_to(np.uint8(0), (6400, 6400)),
        np.broadcast_to(np.uint8(0), (3, 65_536)),
        [[1, 2], [3, 4]],
    ],
)
def test_what_cannot_be_read_is_refused(image: np.ndarray) -> None:
    with pytest.raises(InvalidImage) as caught:
        detect(image)
    assert caught.value.message


def test_one_pixel_that_is_not_finite_is_named(windows: np.ndarray) -> None:
    image = windows.astype(np.float32)
    image[3, 7] = np.nan
    with pytest.raises(InvalidImage, match="x 7, y 3"):
        detect(image)


def test_the_precise_point_keeps_the_best_of_the_balanced_one_and_recall_goes_beyond(street) -> None:
    image = street("P1020816")
    precise, balanced, recall = (
        detect(image, DetectionParameters(min_length=50, operating_point=point))
        for point in ("precise", "balanced", "recall")
    )
    assert len(precise) < len(balanced) < len(recall)
    assert balanced.select(np.arange(len(precise))) == precise
