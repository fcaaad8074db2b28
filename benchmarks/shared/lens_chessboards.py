"""Rows and columns of chessboard photos as lines, and the calibration that the boards themselves give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from app.images import decode_gray
from app.vision.conversion import OpenCVLens
from app.vision.segments import Segments

Array = NDArray[np.float64]

COLUMNS, ROWS = 9, 6
"""Inner corners of the board."""
WINDOW = 5
"""px; half the side of the patch that a corner is refined in."""


@dataclass(frozen=True, eq=False)
class Board:
    """The inner corners of one photo, float64 ``(6, 9, 2)`` in px, row by row."""

    name: str
    corners: Array
    size: tuple[int, int]

    @property
    def lines(self) -> Segments:
        """The 6 rows and 9 columns as segments of 9 and 6 points."""
        return Segments.from_list([*self.corners, *np.swapaxes(self.corners, 0, 1)])


def read_boards(folder: Path) -> list[Board]:
    """Find the board in every photo of a folder; photos that don't show it whole are left out."""
    found: list[Board] = []
    for path in sorted(folder.glob("*.jpg")):
        gray = decode_gray(path.read_bytes())
        seen, corners = cv2.findChessboardCorners(gray, (COLUMNS, ROWS))
        if seen:
            stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 60, 1e-4)
            fine = cv2.cornerSubPix(gray, corners, (WINDOW, WINDOW), (-1, -1), stop)
            size = int(gray.shape[1]), int(gray.shape[0])
            found.append(Board(path.stem, np.asarray(fine, np.float64).reshape(ROWS, COLUMNS, 2), size))
    return found


def calibrate_boards(boards: Sequence[Board], size: tuple[int, int]) -> OpenCVLens:
    """Return OpenCV's calibration with k1, k2, p1, p2 and k3."""
    x, y = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    plane = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], -1).astype(np.float32)
    corners = [board.corners.reshape(-1, 1, 2).astype(np.float32) for board in boards]
    _, matrix, distortion, _, _ = cv2.calibrateCamera([plane] * len(boards), corners, size, None, None)
    return OpenCVLens(matrix, distortion.ravel()[:5])


def bootstrap_calibrations(boards: Sequence[Board], size: tuple[int, int], number: int, seed: int) -> list[OpenCVLens]:
    """Return calibrations from boards drawn with replacement."""
    rng = np.random.default_rng(seed)
    return [
        calibrate_boards([boards[index] for index in rng.integers(len(boards), size=len(boards))], size)
        for _ in range(number)
    ]
