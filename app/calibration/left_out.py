"""Lines that can't be of the camera's image, or are there already.

A lens is only fitted where the frame is: beyond it a model may fold, so that a point there has no corrected place at
all. And a copy of a line tells nothing new; counted as a line of its own it would make a lens look surer than it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from app.vision.frame import half_diagonal
from app.vision.segments import Segments

BEYOND = 0.01
"""Half diagonals that a point may lie outside the frame, as ends of lines do that were extended."""


class HasSegments(Protocol):
    """An image's lines."""

    @property
    def segments(self) -> Segments:
        """In px."""
        ...


class LeftOut(NamedTuple):
    """Which lines are left out, those of all images in a row.

    Attributes:
        outside: bool ``(S,)``, lines with a point outside the frame.
        copy: bool ``(S,)``, lines of the same points as an earlier one.
    """

    outside: NDArray[np.bool_]
    copy: NDArray[np.bool_]


def left_out(images: Sequence[HasSegments], width: int, height: int) -> LeftOut:
    """Find what is left out of a calibration.

    Args:
        images: Of the camera.
        width: Image width in px.
        height: Image height in px.
    """
    return LeftOut(outside_frame(images, width, height), copies(images))


def outside_frame(images: Sequence[HasSegments], width: int, height: int) -> NDArray[np.bool_]:
    """Tell which lines have a point outside the frame, ``(S,)``; arguments as of `left_out`."""
    beyond = BEYOND * half_diagonal(width, height)
    low, high = np.array([-beyond, -beyond]), np.array([width - 1 + beyond, height - 1 + beyond])
    found = [np.zeros(0, np.bool_)]
    for image in images:
        segments = image.segments
        beside = ((segments.points < low) | (segments.points > high)).any(axis=1)
        found.append(np.bincount(segments.segment_of_point, beside, len(segments)) > 0)
    return np.concatenate(found)


def copies(images: Sequence[HasSegments]) -> NDArray[np.bool_]:
    """Tell which lines have the same points as an earlier one, of whichever image, ``(S,)``."""
    found: list[bool] = []
    seen: set[bytes] = set()
    for image in images:
        for line in image.segments:
            content = line.tobytes()
            found.append(content in seen)
            seen.add(content)
    return np.array(found, np.bool_)
