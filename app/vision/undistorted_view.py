"""An image as it would look without its lens's distortion, in a frame of the same size.

Straight lines fix a lens only up to a homography; of these only a shift and a scale are chosen here, so that the whole
corrected frame is seen. What is measured on the view can be carried back, since both directions are given.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput
from app.vision.frame import frame_grid

Array = NDArray[np.float64]

CELL = 16
"""px between the points whose way back is computed; those between are interpolated, which is good to 0.01 px."""
LONGEST_SIDE = 32_766
"""px; what OpenCV's remap takes."""
SMALLEST, LARGEST = 0.4, 2.5
"""Scales of the view; a strong lens sends the corners so far that the middle could no longer be seen."""


class InvertibleLens(Protocol):
    """A lens for images of one size, in both directions: ``Brown``, or a calibration's ``CameraLens``."""

    @property
    def width(self) -> int:
        """Image width in px."""
        ...

    @property
    def height(self) -> int:
        """Image height in px."""
        ...

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones."""
        ...

    def distort(self, points: ArrayLike) -> Array:
        """Map corrected points ``(N, 2)`` in px to measured ones; NaN where there is none."""
        ...

    def is_invertible(self) -> bool:
        """Whether the correction is one-to-one on the whole frame."""
        ...


@dataclass(frozen=True)
class UndistortedView:
    """The corrected image, scaled and shifted into the frame.

    Attributes:
        lens: The lens that is taken out.
        scale: px of the view per px of the corrected image.
        offset: Place of the corrected image's origin in the view, px.
    """

    lens: InvertibleLens
    scale: float
    offset: tuple[float, float]

    def project(self, points: ArrayLike) -> NDArray[np.float32]:
        """Map measured points ``(N, 2)`` in px to the view, float32 ``(N, 2)`` in px."""
        return (self.scale * self.lens.undistort(points) + self.offset).astype(np.float32)

    def measured(self, points: ArrayLike) -> Array:
        """Map points ``(N, 2)`` of the view to the measured image, px; NaN where the lens shows nothing."""
        return self.lens.distort((np.asarray(points, np.float64).reshape(-1, 2) - self.offset) / self.scale)

    def render(self, pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return the image as seen in the view.

        Args:
            pixels: uint8 ``(H, W)`` or ``(H, W, 3)`` of the lens's size.

        Returns:
            uint8 of the same shape; black where the image doesn't reach.

        Raises:
            InvalidInput: If the image isn't of the lens's size, or a side is too long for OpenCV.
        """
        height, width = pixels.shape[:2]
        if (width, height) != (self.lens.width, self.lens.height):
            raise InvalidInput(
                f"an image of {width} x {height} px", where="image", expected=f"{self.lens.width} x {self.lens.height}"
            )
        if max(width, height) > LONGEST_SIDE:
            raise InvalidInput(
                f"an image of {width} x {height} px", where="image", expected=f"sides of at most {LONGEST_SIDE} px"
            )
        across, down = self._source(width, height)
        seen: NDArray[Any] = cv2.remap(pixels, across, down, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
        return seen.astype(np.uint8, copy=False)

    def _source(self, width: int, height: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Return where in the measured image each pixel of the view comes from, float32 ``(H, W)`` each, px."""
        columns, rows = (-(-size // CELL) + 1 for size in (width, height))
        x, y = np.meshgrid(CELL * np.arange(columns), CELL * np.arange(rows))
        source = self.measured(np.stack([x, y], -1).reshape(-1, 2)).astype(np.float32)
        # beyond the fold nothing is seen; a number far outside is black, where NaN would spread over its neighbours
        source = np.where(np.isfinite(source), source, -1e4).reshape(rows, columns, 2)
        grid = np.meshgrid(
            np.arange(width, dtype=np.float32) / CELL, np.arange(height, dtype=np.float32) / CELL, copy=False
        )
        full = cv2.remap(source, grid[0], grid[1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.ascontiguousarray(full[:, :, 0], np.float32), np.ascontiguousarray(full[:, :, 1], np.float32)


def undistorted_view(lens: InvertibleLens) -> UndistortedView:
    """Return the view that shows the whole corrected frame, as large as it fits.

    Args:
        lens: A lens that can be inverted on its frame.

    Raises:
        InvalidInput: If the lens folds within the frame.
    """
    if not lens.is_invertible():
        raise InvalidInput("the lens folds within the frame", where="lens", hint="it can't be taken out of an image")
    corrected = lens.undistort(frame_grid(lens.width, lens.height))
    low, high = corrected.min(axis=0), corrected.max(axis=0)
    size = np.array([lens.width - 1, lens.height - 1], np.float64)
    scale = float(np.clip((size / np.maximum(high - low, 1e-9)).min(), SMALLEST, LARGEST))
    x, y = (size - scale * (low + high)) / 2
    return UndistortedView(lens, scale, (float(x), float(y)))
