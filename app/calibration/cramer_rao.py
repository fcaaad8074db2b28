"""The least error that any unbiased estimate of a lens can have from given lines (Cramer and Rao).

Points err across their line, each by its own normal error. A line's two parameters are nobody's business and are
eliminated from Fisher's information: of a point's derivatives by the lens only that part counts that neither a shift
nor a turn of the corrected line could bring about. The inverse is then carried to the field (Kay 1993, "Fundamentals
of Statistical Signal Processing: Estimation Theory", ch. 3).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens import FAMILIES, CameraLens
from app.calibration.posterior import field_sensitivity
from app.vision.frame import center_of
from app.vision.segments import Segments

Array = NDArray[np.float64]


def fisher_information(lens: CameraLens, released: Sequence[str], segments: Sequence[Segments], noise: float) -> Array:
    """Return Fisher's information about the released parameters, float64 ``(P, P)``.

    Args:
        lens: The true lens.
        released: Names of the parameters to be estimated; the others are known.
        segments: Lines of each image, px.
        noise: px, standard deviation of each point across its line, independent of the others.
    """
    index = [lens.names.index(name) for name in released]
    total = np.zeros((len(index), len(index)))
    for image in segments:
        for points in image:
            moved, shift, turn = _derivatives(lens, points.astype(np.float64))
            nuisance, _ = np.linalg.qr(np.stack([shift, turn], -1))
            left = moved[:, index] - nuisance @ (nuisance.T @ moved[:, index])
            total += left.T @ left / noise**2
    return total


def least_field_error(lens: CameraLens, released: Sequence[str], segments: Sequence[Segments], noise: float) -> float:
    """Return the bound on the field error, px RMS; the arguments are those of `fisher_information`."""
    index = [lens.names.index(name) for name in released]
    form = field_sensitivity(lens)[np.ix_(index, index)]
    covariance = np.linalg.inv(fisher_information(lens, released, segments, noise))
    return float(np.sqrt(np.trace(covariance @ form)))


def _derivatives(lens: CameraLens, points: Array) -> tuple[Array, Array, Array]:
    """Return by how many px points leave their line with each parameter ``(N, P)``, with its shift and its turn."""
    x, y = ((points - center_of(lens.width, lens.height)) / lens.scale).T
    family = FAMILIES[lens.family]
    mapped = family.map_points(np.asarray(lens.parameters), x, y)
    dx, dy = family.map_derivatives(np.asarray(lens.parameters), x, y)
    u, v = mapped.x - mapped.x.mean(), mapped.y - mapped.y.mean()
    angle = 0.5 * np.arctan2(2 * (u * v).sum(), (u * u - v * v).sum())
    nx, ny = -np.sin(angle), np.cos(angle)
    stretch = np.hypot(mapped.xx * nx + mapped.xy * ny, mapped.xy * nx + mapped.yy * ny)
    along = u * np.cos(angle) + v * np.sin(angle)
    return (lens.scale * (nx * dx + ny * dy) / stretch).T, 1 / stretch, along / stretch
