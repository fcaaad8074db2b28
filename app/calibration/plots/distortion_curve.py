"""How far the correction moves a point, against its distance from the distortion centre, with what is not known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.calibration.lens import FAMILIES, CameraLens
from app.calibration.plots.chart import Chart
from app.calibration.plots.svg import BLUE, PALE_BLUE, element, path, plot, text
from app.vision.frame import center_of, frame_grid

Array = NDArray[np.float64]
RADII, DIRECTIONS = 48, 16
TWO_SIDED_95 = 1.96


def radial_shift(lens: CameraLens, covariance: ArrayLike, released: Sequence[str]) -> tuple[Array, Array, Array]:
    """Return distance from the centre, mean outward shift there and half the width of its 95 % band, all px.

    The shift is averaged over all directions, which leaves the radial part. Its
    band follows from the parameters' covariance to first order.

    Args:
        lens: The lens.
        covariance: Of the released parameters, ``(K, K)``, half diagonals.
        released: Their names.
    """
    center = np.array(lens.center)
    farthest = float(np.hypot(*(frame_grid(lens.width, lens.height, 9) - center).T).max())
    radii = np.linspace(0, farthest, RADII)
    angles = np.arange(DIRECTIONS) * 2 * np.pi / DIRECTIONS
    outward = np.stack([np.cos(angles), np.sin(angles)], -1)
    points = center + radii[:, None, None] * outward
    flat = points.reshape(-1, 2)
    with np.errstate(all="ignore"):  # beyond a fold there is no corrected point, and the curve ends
        shift = np.einsum("rac,ac->ra", lens.undistort(flat).reshape(points.shape) - points, outward)
        x, y = ((flat - center_of(lens.width, lens.height)) / lens.scale).T
        dx, dy = FAMILIES[lens.family].map_derivatives(np.asarray(lens.parameters), x, y)
    moved = lens.scale * np.stack([dx, dy], -1).reshape(len(lens.names), *points.shape)
    chosen = [lens.names.index(name) for name in released]
    slopes = np.einsum("prac,ac->pra", moved[chosen], outward).mean(axis=2)
    variance = np.einsum("pr,pq,qr->r", slopes, np.reshape(covariance, (len(chosen), len(chosen))), slopes)
    return radii, shift.mean(axis=1), TWO_SIDED_95 * np.sqrt(np.maximum(variance, 0))


def distortion_curve(
    lens: CameraLens, covariance: ArrayLike, released: Sequence[str], *, width: float = 332.0, height: float = 200.0
) -> str:
    """Draw the radial shift of the correction with its 95 % band."""
    radius, shift, half = radial_shift(lens, covariance, released)
    seen = np.isfinite(shift) & np.isfinite(half)
    radius, shift, half = radius[seen], shift[seen], half[seen]
    low, high = float(min((shift - half).min(initial=0), 0)), float(max((shift + half).max(initial=0), 0))
    chart = Chart.over((0.0, float(radius[-1])), (low, high), width=width, height=height)

    def along(values: Array) -> list[tuple[float, float]]:
        return [(chart.across(r), chart.up(value)) for r, value in zip(radius.tolist(), values.tolist(), strict=True)]

    band = along(shift + half) + along(shift - half)[::-1]
    return plot(
        chart.width,
        chart.height,
        f"The correction moves points by up to {float(np.abs(shift).max(initial=0)):.1f} px",
        [
            element("path", d=path(band, closed=True), fill=PALE_BLUE),
            *chart.axes("distance from the distortion centre, px", "outward shift, px"),
            element("path", d=path(along(shift)), fill="none", stroke=BLUE, stroke_width=1.8),
            text("95 % band", chart.across.start + 8, chart.up.end + 10, fill=BLUE),
        ],
    )
