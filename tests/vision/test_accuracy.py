"""Sub-pixel accuracy of the points that `detect` returns, on edges whose place is known exactly."""

import cv2
import numpy as np
import pytest

from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect

SIZE = 101
CAMERA_BLUR = 1.0
RANDOM = np.random.default_rng(7)
# 40 random edges, and those where rounding or the change of passes would show
EDGES = [
    *zip(RANDOM.uniform(0, np.pi, 40), RANDOM.uniform(-0.5, 0.5, 40), strict=True),
    *((angle, offset) for angle in (0.0, np.pi / 4, np.pi / 2) for offset in (0.0, 0.2, 0.45)),
]


def distances(half_plane, angle: float, offset: float, *, blur: float, noise: float, contrast: float) -> np.ndarray:
    """Signed distances in px of the points from the true edge, points near the border left out."""
    image = 128 + contrast * (half_plane(angle, offset, SIZE) - 0.5)
    if blur:
        image = cv2.GaussianBlur(image, (0, 0), blur, borderType=cv2.BORDER_REPLICATE)
    generator = np.random.default_rng(int(1000 * (angle + offset + 1)))
    image = np.rint(image + generator.normal(0, noise, image.shape))
    found = detect(image.clip(0, 255).astype(np.uint8), DetectionParameters(min_length=60))
    assert len(found) == 1
    points = found.points[((found.points > 8) & (found.points < SIZE - 9)).all(axis=1)].astype(float)
    assert len(points) > 55
    return (points - SIZE // 2) @ np.array([-np.sin(angle), np.cos(angle)]) - offset


@pytest.mark.parametrize(
    ("blur", "noise", "contrast"),
    [(CAMERA_BLUR, 0, 150), (CAMERA_BLUR, 1, 150), (CAMERA_BLUR, 0, 40), (0, 0, 150), (0, 1, 150)],
)
def test_a_point_is_off_by_a_fortieth_of_a_pixel_and_to_neither_side(half_plane, blur, noise, contrast) -> None:
    by_edge = [distances(half_plane, *edge, blur=blur, noise=noise, contrast=contrast) for edge in EDGES]
    everything = np.concatenate(by_edge)
    assert np.sqrt((everything**2).mean()) <= 0.025
    assert abs(everything.mean()) < 0.01


def test_no_single_edge_has_a_bias(half_plane) -> None:
    means = [distances(half_plane, *edge, blur=CAMERA_BLUR, noise=0, contrast=150).mean() for edge in EDGES]
    assert np.abs(means).max() < 0.01


def test_dark_to_bright_and_bright_to_dark_lie_in_the_same_place(half_plane) -> None:
    for angle, offset in EDGES[:10]:
        one, other = (
            distances(half_plane, angle, offset, blur=CAMERA_BLUR, noise=0, contrast=contrast).mean()
            for contrast in (150, -150)
        )
        assert one == pytest.approx(other, abs=0.01)
