"""The camera: where it stands, how world points reach the ideal image, and its lens in the forms others read."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.synthesis.lens import Lens


@dataclass(frozen=True, eq=False)
class Pose:
    """Where a camera stands in the street: x right, y down, z forward, in m; the ground is y = 0.

    Attributes:
        position: float64 ``(3,)`` in m.
        yaw: Turn to the right in rad.
        pitch: Turn upwards in rad.
        roll: Turn clockwise about the optical axis in rad.
    """

    position: NDArray[np.float64]
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0

    @cached_property
    def rotation(self) -> NDArray[np.float64]:
        """World directions to camera directions, float64 ``(3, 3)``."""
        (cy, sy), (cp, sp), (cr, sr) = ((np.cos(a), np.sin(a)) for a in (self.yaw, self.pitch, self.roll))
        yaw = np.array([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]])
        pitch = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
        roll = np.array([[cr, sr, 0], [-sr, cr, 0], [0, 0, 1]])
        return roll @ pitch @ yaw

    def to_camera(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """World points ``(..., 3)`` in the camera's own axes."""
        return (points - self.position) @ self.rotation.T


@dataclass(frozen=True, eq=False)
class SyntheticCamera:
    """The known lens of a synthetic image.

    Attributes:
        lens: K and D in OpenCV's convention.
        brown_k: k1, k2, k3 of the same lens in the undistort direction, radii in half diagonals.
        brown_p: p1, p2 likewise.
        brown_error: RMS and maximum over the frame, in px, of what that form can't express of the lens.
    """

    lens: Lens
    brown_k: tuple[float, float, float]
    brown_p: tuple[float, float]
    brown_error: tuple[float, float]

    @property
    def matrix(self) -> NDArray[np.float64]:
        """K, float64 ``(3, 3)``."""
        return self.lens.matrix

    @property
    def coefficients(self) -> NDArray[np.float64]:
        """D: k1, k2, p1, p2, k3 in OpenCV's order, float64 ``(5,)``."""
        return self.lens.coefficients

    def as_reference(self) -> dict[str, Any]:
        """Return width, height, K and D, as `cameras.json` holds them."""
        return {
            "width": self.lens.width,
            "height": self.lens.height,
            "K": self.matrix.tolist(),
            "D": self.coefficients.tolist(),
        }

    def as_brown(self) -> dict[str, Any]:
        """Return the lens in the undistort direction, in the form of a distortion estimate."""
        return {
            "model": "brown",
            "width": self.lens.width,
            "height": self.lens.height,
            "center": self.matrix[:2, 2].tolist(),
            "scale": half_diagonal(self.lens),
            "k": list(self.brown_k),
            "p": list(self.brown_p),
        }


def half_diagonal(lens: Lens) -> float:
    """Half of the image diagonal in px: the unit of radii in the undistort direction."""
    return float(np.hypot(lens.width, lens.height) / 2)


def describe_camera(lens: Lens) -> SyntheticCamera:
    """Refit a lens in the undistort direction.

    The corrected position is linear in k1, k2, k3, p1, p2 when the centre is known (Brown 1971), so that one least
    squares over a grid of the frame gives them; a power-series inversion would diverge for wide lenses.
    """
    columns, rows = np.linspace(0, lens.width - 1, 48), np.linspace(0, lens.height - 1, 32)
    pixels = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    centre, scale = lens.matrix[:2, 2], half_diagonal(lens)
    corrected = (lens.to_rays(pixels) * lens.matrix[[0, 1], [0, 1]]) / scale
    x, y = ((pixels - centre) / scale).T
    r2 = x * x + y * y
    rows_x = np.stack([x * r2, x * r2**2, x * r2**3, 2 * x * y, r2 + 2 * x * x], axis=1)
    rows_y = np.stack([y * r2, y * r2**2, y * r2**3, r2 + 2 * y * y, 2 * x * y], axis=1)
    system = np.concatenate([rows_x, rows_y])
    wanted = np.concatenate([corrected[:, 0] - x, corrected[:, 1] - y])
    solution, *_ = np.linalg.lstsq(system, wanted, rcond=None)
    residual = np.hypot(*np.split((system @ solution - wanted) * scale, 2))
    k1, k2, k3, p1, p2 = (float(value) for value in solution)
    error = (float(np.sqrt(np.mean(residual**2))), float(residual.max()))
    return SyntheticCamera(lens, (k1, k2, k3), (p1, p2), error)
