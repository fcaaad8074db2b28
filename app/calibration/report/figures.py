"""The report's plots, as SVG."""

from __future__ import annotations

from typing import Any

import numpy as np

from app.calibration.calibration import Calibration
from app.calibration.comparison import Difference
from app.calibration.plots.bars import histogram, image_bars
from app.calibration.plots.correlation import correlation_matrix
from app.calibration.plots.distortion_curve import distortion_curve
from app.calibration.plots.maps import map_plot
from app.calibration.plots.straight_grid import straight_grid

MOST_IMAGES = 12
STRAIGHT = 0.5


def lens_figures(calibration: Calibration) -> dict[str, str | None]:
    """Return the plots that every report has, by name; ``None`` where there is nothing to draw."""
    lens, size = calibration.lens, (calibration.lens.width, calibration.lens.height)
    x, y = calibration.map.x.tolist(), calibration.map.y.tolist()
    drawable = lens.is_invertible()
    return {
        "grid": straight_grid(lens) if drawable else None,
        "curve": distortion_curve(lens, calibration.covariance, calibration.released) if drawable else None,
        "shift": map_plot(x, y, calibration.map.shift.tolist(), size, title="Length of the correction over the frame"),
        "coverage": map_plot(
            x, y, calibration.map.lines.tolist(), size, title="Length of lines over the frame", empty="no line"
        ),
        "uncertainty": map_plot(
            x, y, calibration.map.sigma.tolist(), size, title="95 % bound of the correction's error over the frame"
        ),
        "correlation": (
            correlation_matrix(calibration.released, calibration.correlation.tolist())
            if len(calibration.released) > 1
            else None
        ),
        "residuals": _residuals(calibration),
        "images": _images(calibration),
    }


def difference_figure(difference: Difference, size: tuple[int, int]) -> str:
    """Return the map of the difference to a reference, with arrows."""
    fields = difference.as_dict()
    distance = [[value if np.isfinite(value) else None for value in row] for row in difference.distance.tolist()]
    return map_plot(
        fields["x"], fields["y"], distance, size, title="Difference to the reference over the frame",
        arrows=(fields["dx"], fields["dy"]),
    )  # fmt: skip


def free_figure(free: Any, size: tuple[int, int]) -> str | None:
    """Return the map of what the free model adds, with arrows; ``None`` where nothing could be fitted."""
    dx, dy = np.array(free.get("dx") or [], np.float64), np.array(free.get("dy") or [], np.float64)
    if dx.ndim != 2 or not dx.size:
        return None
    return map_plot(
        free["x"], free["y"], np.hypot(dx, dy).tolist(), size, title="What the parametric model misses, over the frame",
        arrows=(dx.tolist(), dy.tolist()),
    )  # fmt: skip


def _residuals(calibration: Calibration) -> str | None:
    straight = [lines.rms[lines.probability >= STRAIGHT] for lines in calibration.lines]
    residuals = np.concatenate(straight) if straight else np.zeros(0)
    if not len(residuals):
        return None
    return histogram(
        residuals,
        title="RMS distance of a line's points from straight",
        what="lines",
        mark=calibration.noise,
        mark_label=f"noise of a point {calibration.noise:.2f} px",
    )


def _images(calibration: Calibration) -> str | None:
    """Return the bars of the images, worst first, as many as a page takes."""
    ordered = sorted(calibration.images, key=lambda image: -(image.rms if image.rms is not None else -1.0))
    rows = [(image.name, image.rms, image.inliers, image.segments) for image in ordered[:MOST_IMAGES]]
    return image_bars(rows) if rows else None
