"""The difference of two lenses: what a homography can't do, and no more."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.calibration.comparison import Difference, ReferenceLens, compare
from app.calibration.lens import CameraLens
from app.errors import InvalidInput
from app.vision.conversion import OpenCVLens
from app.vision.field import apply_homography, field_error

SIZE = (1242, 375)
LENS = CameraLens("division", *SIZE, (0.2, 0.02, 0.0, 0.01, -0.02))
K = np.array([[720.0, 0.0, 600.0], [0.0, 720.0, 180.0], [0.0, 0.0, 1.0]])


class Seen:
    """A lens whose corrected image is seen through a homography."""

    def __init__(self, lens, homography):
        self.lens, self.homography = lens, homography

    def undistort(self, points):
        return apply_homography(self.homography, self.lens.undistort(points))


@given(st.floats(0.5, 2), st.floats(-300, 300), st.floats(-1e-4, 1e-4))
@settings(max_examples=25, deadline=None)
def test_a_homography_is_no_difference(scale: float, shift: float, tilt: float) -> None:
    homography = np.array([[scale, 0.1, shift], [-0.1, scale, -shift], [tilt, -tilt, 1.0]])
    assert compare(Seen(LENS, homography), LENS, *SIZE).maximum < 1e-3


def test_it_agrees_with_the_error_over_the_field() -> None:
    reference = OpenCVLens(K, [-0.36, 0.18, 0.001, -0.0005, -0.05])
    difference = compare(LENS, reference, *SIZE)
    expected = field_error(reference, LENS, *SIZE)
    assert difference.rms == pytest.approx(expected.rms)
    assert difference.maximum == pytest.approx(expected.maximum)
    assert difference.distance.shape == (12, 40)
    assert difference.x[[0, -1]].tolist() == [0, 1241]
    assert difference.y[[0, -1]].tolist() == [0, 374]


def test_the_inner_frame_is_its_middle() -> None:
    x, y = np.linspace(0, 100, 11), np.linspace(0, 50, 11)
    dx = np.ones((11, 11))
    dx[1:-1, 1:-1] = 0.5
    assert Difference(x, y, dx, np.zeros((11, 11))).inner_rms == 0.5


def test_a_fold_leaves_holes_that_json_can_say() -> None:
    folded = CameraLens("opencv", 640, 480, (-0.36, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    difference = compare(folded, CameraLens.identity("brown", 640, 480), 640, 480)
    fields = json.loads(json.dumps(difference.as_dict(), allow_nan=False))
    assert fields["dx"][0][0] is None
    assert fields["dx"][15][20] is not None
    assert (fields["columns"], fields["rows"]) == (len(fields["x"]), len(fields["y"])) == (40, 30)
    again = Difference.from_dict(fields)
    assert again.rms == difference.rms
    np.testing.assert_array_equal(again.dy, difference.dy)


def test_a_reference_that_sees_little_of_the_frame_is_refused() -> None:
    folded = CameraLens("opencv", 640, 480, (-3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    with pytest.raises(InvalidInput, match="reference: it can't be undone on most of the frame"):
        compare(CameraLens.identity("brown", 640, 480), folded, 640, 480)


@pytest.mark.parametrize("count", [4, 5, 8, 12, 14])
def test_a_reference_may_have_as_many_coefficients_as_opencv_knows(count: int) -> None:
    D = np.array([-0.3, 0.1, 0.001, -0.0005, -0.01, 0.02, 0.01, 0.0, 1e-3, 0.0, 1e-3, 0.0, 0.01, 0.01])[:count]
    lens = ReferenceLens(K, D)
    points = np.array([[600.0, 180.0], [100.0, 50.0], [1200.0, 370.0]])
    rays = (lens.undistort(points) - K[:2, 2]) / 720
    back, _ = cv2.projectPoints(np.column_stack([rays, np.ones(3)]), np.zeros(3), np.zeros(3), K, D)
    np.testing.assert_allclose(back[:, 0], points, atol=1e-6)


def test_a_reference_is_nan_where_no_ray_leads_to() -> None:
    lens = ReferenceLens([[400, 0, 319.5], [0, 400, 239.5], [0, 0, 1]], [-9.0, 0, 0, 0])
    seen = np.isfinite(lens.undistort([[319.5, 239.5], [330.0, 240.0], [600.0, 400.0]])).all(axis=1)
    assert seen.tolist() == [True, True, False]
    with pytest.raises(InvalidInput, match="reference: it can't be undone"):
        compare(CameraLens.identity("brown", 640, 480), lens, 640, 480)
    for D in ([0.1], [np.nan] * 5, []):
        with pytest.raises(InvalidInput):
            ReferenceLens(K, D)


@pytest.mark.parametrize("k1", [1e6, 1e11])
def test_a_reference_that_shrinks_the_frame_to_nothing_agrees_with_no_lens(k1: float) -> None:
    lens = ReferenceLens([[900, 0, 640], [0, 900, 360], [0, 0, 1]], [k1, 0, 0, 0, 0])
    with pytest.raises(InvalidInput, match="times as large as the measured one"):
        compare(CameraLens.identity("brown", 1280, 720), lens, 1280, 720)
