"""The lens: OpenCV's polynomial model, its inverse, and the lenses that the scenes are seen through."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput

_NEWTON_STEPS = 25
_CONVERGED = 1e-9
_DRAWN_DETERMINANT = 0.25

LensKind = Literal["plain", "mild", "wide"]
LENS_KINDS: tuple[LensKind, ...] = get_args(LensKind)
# k1 from and to, and the focal length in image widths from and to
_RANGES: dict[LensKind, tuple[tuple[float, float], tuple[float, float]]] = {
    "plain": ((-0.08, 0.05), (0.7, 1.15)),
    "mild": ((-0.28, -0.08), (0.6, 0.85)),
    "wide": ((-0.45, -0.28), (0.6, 0.74)),
}


@dataclass(frozen=True, eq=False)
class Lens:
    """A camera's inner geometry in OpenCV's convention.

    Attributes:
        width: Image width in px.
        height: Image height in px.
        matrix: K, float64 ``(3, 3)``: focal lengths and principal point in px, no skew.
        coefficients: D, float64 ``(5,)``: k1, k2, p1, p2, k3 in the distort direction (barrel: k1 < 0).

    Raises:
        InvalidInput: On wrong shapes, or where the model folds over inside the frame and so has no inverse.
    """

    width: int
    height: int
    matrix: NDArray[np.float64]
    coefficients: NDArray[np.float64]

    def __post_init__(self) -> None:
        matrix = np.array(self.matrix, dtype=np.float64)
        coefficients = np.array(self.coefficients, dtype=np.float64).ravel()
        if self.width < 1 or self.height < 1:
            raise InvalidInput(
                f"a lens for {self.width} x {self.height} px", where="lens", expected="a size from 1 x 1"
            )
        if matrix.shape != (3, 3) or not np.isfinite(matrix).all() or min(matrix[0, 0], matrix[1, 1]) <= 0:
            raise InvalidInput("K is no camera matrix", where="lens.matrix", expected="(3, 3) with focal lengths > 0")
        if coefficients.shape != (5,) or not np.isfinite(coefficients).all():
            raise InvalidInput(
                f"D has shape {coefficients.shape}", where="lens.coefficients", expected="k1, k2, p1, p2, k3"
            )
        object.__setattr__(self, "matrix", matrix)
        object.__setattr__(self, "coefficients", coefficients)
        if not is_invertible(self):
            raise InvalidInput(
                "the lens model folds over inside the frame",
                where="lens.coefficients",
                expected="a distortion that can be inverted up to the corners",
                hint="use a longer focal length or weaker coefficients",
            )

    def to_pixels(self, rays: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where the lens images rays: ideal plane ``(..., 2)`` at distance 1 to px ``(..., 2)``."""
        focal, centre = self.matrix[[0, 1], [0, 1]], self.matrix[:2, 2]
        return distort(rays, self.coefficients) * focal + centre

    def to_rays(self, pixels: NDArray[np.float64]) -> NDArray[np.float64]:
        """The rays that pixels see: px ``(..., 2)`` to the ideal plane ``(..., 2)`` at distance 1.

        Raises:
            InvalidInput: If a pixel lies where the model has no inverse.
        """
        focal, centre = self.matrix[[0, 1], [0, 1]], self.matrix[:2, 2]
        rays, error = _invert((np.asarray(pixels, np.float64) - centre) / focal, self.coefficients)
        if error.size and not error.max() < _CONVERGED:
            raise InvalidInput("the lens model has no inverse at a pixel", where="lens", expected="pixels in the frame")
        return rays


def distort(rays: NDArray[np.float64], coefficients: NDArray[np.float64]) -> NDArray[np.float64]:
    """Apply the polynomial model to ideal points ``(..., 2)`` (Brown 1971, in OpenCV's direction and order).

    ``x_d = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 x y + p2 (r2 + 2 x^2)`` with the ideal ``r2 = x^2 + y^2``, and
    likewise ``y_d = y (...) + p1 (r2 + 2 y^2) + 2 p2 x y``.
    """
    k1, k2, p1, p2, k3 = coefficients
    x, y = rays[..., 0], rays[..., 1]
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    cross = 2 * x * y
    return np.stack(
        [x * radial + p1 * cross + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + p2 * cross], axis=-1
    )


def _jacobian(rays: NDArray[np.float64], coefficients: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """Derivatives of `distort`: d x_d/dx, d x_d/dy (= d y_d/dx), d y_d/dy."""
    k1, k2, p1, p2, k3 = coefficients
    x, y = rays[..., 0], rays[..., 1]
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    slope = k1 + r2 * (2 * k2 + 3 * r2 * k3)
    xx = radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x
    xy = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y
    yy = radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x
    return xx, xy, yy


def _invert(
    distorted: NDArray[np.float64], coefficients: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Newton's method on `distort`; returns the ideal points and what is left of the error."""
    rays = distorted.copy()
    with np.errstate(all="ignore"):
        for _ in range(_NEWTON_STEPS):
            residual = distort(rays, coefficients) - distorted
            xx, xy, yy = _jacobian(rays, coefficients)
            # where a step leaves the model's valid region a damped one is taken instead
            determinant = np.maximum(xx * yy - xy * xy, 0.05)
            step_x = (yy * residual[..., 0] - xy * residual[..., 1]) / determinant
            step_y = (xx * residual[..., 1] - xy * residual[..., 0]) / determinant
            rays = rays - np.stack([step_x, step_y], axis=-1)
            if np.abs(residual).max(initial=0.0) < 1e-14:
                break
        error = np.linalg.norm(distort(rays, coefficients) - distorted, axis=-1)
    return rays, np.where(np.isfinite(error), error, np.inf)


def is_invertible(lens: Lens, least_determinant: float = 0.1) -> bool:
    """Whether each pixel of the frame (and a rim of 3 %) has one ray, found without a fold on its way out.

    Args:
        lens: The lens.
        least_determinant: Lower limit for the area a small square of the ideal image keeps through the lens.
    """
    columns = np.linspace(-0.03 * lens.width, 1.03 * lens.width, 33)
    rows = np.linspace(-0.03 * lens.height, 1.03 * lens.height, 25)
    grid = np.stack(np.meshgrid(columns, rows), axis=-1)
    focal, centre = lens.matrix[[0, 1], [0, 1]], lens.matrix[:2, 2]
    rays, error = _invert((grid - centre) / focal, lens.coefficients)
    if not error.max() < _CONVERGED:
        return False
    along = np.linspace(0, 1, 16)[:, None, None, None]
    xx, xy, yy = _jacobian(rays * along, lens.coefficients)
    return bool((xx * yy - xy * xy).min() > least_determinant)


def make_lens(width: int, height: int, focal: float, coefficients: ArrayLike) -> Lens:
    """Return a lens with square pixels and its principal point in the middle of the image.

    Args:
        width: Image width in px.
        height: Image height in px.
        focal: Focal length in px.
        coefficients: k1, k2, p1, p2, k3.
    """
    matrix = np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1]])
    return Lens(width, height, matrix, np.asarray(coefficients, np.float64))


def draw_lens(rng: np.random.Generator, width: int, height: int, kind: LensKind | None = None) -> Lens:
    """Draw a lens: from plain to wide, as found in pocket cameras, on cars and in lens databases.

    Strong barrels get a positive k2 and a small k3, as calibrations of real ones have. A focal length at which the
    drawn polynomial would fold over inside the frame is made longer until it doesn't.

    Args:
        rng: What to draw from.
        width: Image width in px.
        height: Image height in px.
        kind: Of the lens; drawn as well where none is given.
    """
    kind = kind or LENS_KINDS[int(rng.integers(len(LENS_KINDS)))]
    (weak, strong), (short, long) = _RANGES[kind]
    k1 = float(rng.uniform(weak, strong))
    k2 = float(-0.5 * k1 * rng.uniform(0.7, 1.1)) if kind != "plain" else float(rng.uniform(-0.02, 0.02))
    k3 = float(-0.14 * k2 * rng.uniform(0.5, 1.5))
    p1, p2 = rng.normal(0, 0.0006, 2).clip(-0.0015, 0.0015)
    focal = float(width * rng.uniform(short, long))
    offset = rng.normal(0, 0.006, 2).clip(-0.015, 0.015) * width
    centre = np.array([(width - 1) / 2, (height - 1) / 2]) + offset
    while True:
        matrix = np.array([[focal, 0, centre[0]], [0, focal, centre[1]], [0, 0, 1]])
        try:
            lens = Lens(width, height, matrix, np.array([k1, k2, p1, p2, k3]))
        except InvalidInput:
            lens = None
        if lens is not None and is_invertible(lens, _DRAWN_DETERMINANT):
            return lens
        focal *= 1.04
