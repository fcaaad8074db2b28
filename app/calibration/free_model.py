"""A free displacement field on top of a parametric lens: what the lens's model misses.

The field is a cubic B-spline (`app.calibration.spline_fit`). What a homography of the corrected image can do is taken
out of it and of its uncertainty: no line can tell that. It is used only where there are lines enough to tell a field
worth knowing, where they speak for one, and where it makes lines straighter that it was not fitted to.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.calibration.bspline import SplineGrid, grid_for
from app.calibration.corrected_lines import ImageLines
from app.calibration.lens import CameraLens
from app.calibration.line_bends import line_bends
from app.calibration.spline_fit import LEAST_EVIDENCE, MOST_NEEDED, MOST_SCALE, SplineFit, fit_spline, lines_needed
from app.errors import InvalidInput
from app.vision.field import homography_fields
from app.vision.frame import center_of

Array = NDArray[np.float64]

COLUMNS = 24
"""Of the grid that the field is given on."""
FEWEST_SEGMENTS = 20
WORTH_KNOWING = 0.25
"""px RMS; a field of this size should be told from none."""


@dataclass(frozen=True)
class FreeModel:
    """A displacement field in px, to be added to corrected points, on a grid of the measured image.

    Attributes:
        used: Whether there are lines enough, and they speak for it.
        lines: Segments that it was fitted to.
        needed: Segments such as these that would do; 100,000 where no number would.
        reason: Why it isn't used, in words.
        x: px, columns of the grid.
        y: px, rows of the grid.
        dx: Along x, rows of the grid's values; empty where nothing could be fitted.
        dy: Along y.
        sigmas: px, standard deviation of the displacement's length at the same places.
        rms: px of the field over the frame.
        sigma: px RMS, its expected error over the frame.
    """

    used: bool
    lines: int
    needed: int
    reason: str | None
    x: tuple[float, ...]
    y: tuple[float, ...]
    dx: tuple[tuple[float, ...], ...]
    dy: tuple[tuple[float, ...], ...]
    sigmas: tuple[tuple[float, ...], ...]
    rms: float
    sigma: float | None

    def as_dict(self) -> dict[str, Any]:
        """Return the model as JSON-serialisable fields."""
        return {
            "used": self.used,
            "lines": self.lines,
            "needed": self.needed,
            "reason": self.reason,
            "columns": len(self.x),
            "rows": len(self.y),
            "x": list(self.x),
            "y": list(self.y),
            "dx": [list(row) for row in self.dx],
            "dy": [list(row) for row in self.dy],
            "sigmas": [list(row) for row in self.sigmas],
            "rms": self.rms,
            "sigma": self.sigma,
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> FreeModel:
        """Return the model that `as_dict` gave the fields of.

        Raises:
            InvalidInput: If a field is missing or isn't what it should be.
        """
        try:
            return cls(
                used=bool(fields["used"]),
                lines=int(fields["lines"]),
                needed=int(fields["needed"]),
                reason=None if fields["reason"] is None else str(fields["reason"]),
                x=tuple(map(float, fields["x"])),
                y=tuple(map(float, fields["y"])),
                dx=tuple(tuple(map(float, row)) for row in fields["dx"]),
                dy=tuple(tuple(map(float, row)) for row in fields["dy"]),
                sigmas=tuple(tuple(map(float, row)) for row in fields["sigmas"]),
                rms=float(fields["rms"]),
                sigma=None if fields["sigma"] is None else float(fields["sigma"]),
            )
        except (KeyError, TypeError, ValueError) as error:
            raise InvalidInput(f"no free model: {error!r:.80}", where="free") from error


def fit_free_model(images: Sequence[ImageLines], lens: CameraLens, *, seed: int = 0) -> FreeModel:
    """Fit a displacement field to what the lines of a camera still bend under its lens.

    Args:
        images: Lines of the images of one camera; those of a probability above one half are used.
        lens: The camera's lens.
        seed: Taken for likeness with the other estimates; every step here is deterministic.
    """
    del seed
    grid = grid_for(lens.width, lens.height)
    bends = line_bends(images, lens, grid)
    x, y = _axes(lens)
    if len(bends) < FEWEST_SEGMENTS:
        reason = f"{len(bends)} lines of 40 px and more; a field needs {FEWEST_SEGMENTS} to be looked for"
        return FreeModel(False, len(bends), MOST_NEEDED, reason, x, y, (), (), (), 0.0, None)
    places = np.stack(np.meshgrid(x, y), -1).reshape(-1, 2)
    reading = _reading(grid, lens, places)
    fit = fit_spline(bends, grid)
    field = reading @ fit.coefficients
    covariance = reading @ fit.covariance
    variance = np.einsum("ij,ij->i", covariance, reading)
    rms, sigma = _rms(field**2), _rms(variance)
    needed = lines_needed(fit, reading, len(bends), WORTH_KNOWING)
    reason = _reason(len(bends), needed, fit, rms)
    shape = (len(y), len(x))
    half = len(places)
    return FreeModel(
        used=reason is None,
        lines=len(bends),
        needed=needed,
        reason=reason,
        x=x,
        y=y,
        dx=_rows(field[:half].reshape(shape)),
        dy=_rows(field[half:].reshape(shape)),
        sigmas=_rows(np.sqrt(variance[:half] + variance[half:]).reshape(shape)),
        rms=rms,
        sigma=sigma,
    )


def _reason(lines: int, needed: int, fit: SplineFit, rms: float) -> str | None:
    if needed >= MOST_NEEDED:
        return "the lines leave parts of the frame out, where more of the same would tell nothing"
    if lines < needed:
        return f"{lines} lines; it takes about {needed} such lines to tell a field of {max(rms, WORTH_KNOWING):.2f} px"
    if fit.evidence < LEAST_EVIDENCE:
        return f"the lines speak for no field beyond the lens's model (log odds {fit.evidence:.1f})"
    if fit.scale > MOST_SCALE:
        return (
            f"the lines bend {np.sqrt(fit.scale):.1f} times as much as their noise explains, under any field: too many "
            "aren't straight themselves"
        )
    if fit.held_out <= 0:
        return "the field doesn't make lines straighter that it was not fitted to"
    return None


def _reading(grid: SplineGrid, lens: CameraLens, places: Array) -> Array:
    """Return what turns coefficients into the field at places, homographies taken out, float64 ``(2 N, 2 C)``."""
    values = np.kron(np.eye(2), grid.basis(places))
    corrected = (lens.undistort(places) - center_of(lens.width, lens.height)) / lens.scale
    corrected = np.where(np.isfinite(corrected), corrected, 0.0)
    basis, _ = np.linalg.qr(homography_fields(corrected))
    return np.asarray(values - basis @ (basis.T @ values), np.float64)


def _axes(lens: CameraLens) -> tuple[tuple[float, ...], tuple[float, ...]]:
    rows = max(6, round(COLUMNS * lens.height / lens.width))
    across, down = np.linspace(0, lens.width - 1, COLUMNS), np.linspace(0, lens.height - 1, rows)
    return tuple(across.tolist()), tuple(down.tolist())


def _rms(squares: Array) -> float:
    """Return the root of the mean over places of the sum of both directions' squares."""
    return float(np.sqrt(2 * np.mean(squares)))


def _rows(values: Array) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in values.tolist())
