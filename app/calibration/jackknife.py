"""What each image says: the lens without it, and the error that the scatter of such lenses means.

The lenses without an image are one-step answers on the fit's linear model (`app.calibration.linearised`); the error is
the jackknife's (Quenouille 1956, Tukey 1958).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens_solver import SolvedLens
from app.calibration.linearised import refit
from app.calibration.observations import LineObservations
from app.calibration.posterior import field_sensitivity

Array = NDArray[np.float64]


def left_out_changes(observed: LineObservations, solved: SolvedLens, images: int) -> Array:
    """Return the change of the released parameters without each image, float64 ``(images, P)``."""
    changes = np.zeros((images, len(solved.released)))
    for image in np.unique(observed.image):
        changes[image] = refit(observed, solved, observed.image != image)
    return changes


def shifts(changes: Array, solved: SolvedLens) -> Array:
    """Return by how much the lens moves without each image, px RMS of the field, float64 ``(images,)``."""
    index = np.asarray(solved.released, np.int64)
    form = field_sensitivity(solved.lens)[np.ix_(index, index)]
    return np.sqrt(np.maximum(np.einsum("ip,pq,iq->i", changes, form, changes), 0.0))


def jackknife_error(changes: Array, solved: SolvedLens, present: NDArray[np.bool_]) -> float:
    """Return the field error in px RMS that the scatter over the images says.

    Args:
        changes: From `left_out_changes`.
        solved: The fit.
        present: bool ``(images,)``, those that have lines.
    """
    number = int(present.sum())
    away = changes[present] - changes[present].mean(0)
    return float(np.sqrt((number - 1) / number * (shifts(away, solved) ** 2).sum()))
