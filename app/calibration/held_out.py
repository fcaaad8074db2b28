"""How well a fit foretells lines that it hasn't seen: images are left out, or structures of the only image."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens_solver import SolvedLens
from app.calibration.linearised import loss_after, refit
from app.calibration.observations import LineObservations, structures_of

MOST_FOLDS = 8
FEWEST_LINES = 6
"""Fewer lines aren't divided."""


def folds_of(observed: LineObservations) -> NDArray[np.int64] | None:
    """Return which lines are left out together, int64 ``(S,)``; ``None`` if there are too few to leave any out.

    Images are left out, eight groups of them at most. Of a single image it is structures: lines of about one direction
    in one of four bands of the frame.
    """
    if len(observed) < FEWEST_LINES:
        return None
    if len(np.unique(observed.image)) > 1:
        rank = np.unique(observed.image, return_inverse=True)[1]
        return rank % MOST_FOLDS
    rank = np.unique(structures_of(observed), return_inverse=True)[1]
    if rank.max() == 0:
        rank = np.arange(len(observed)) % 2
    return rank


def held_out_loss(observed: LineObservations, solved: SolvedLens, folds: NDArray[np.int64] | None) -> float | None:
    """Return the mean loss of a line under the lens that the lines of other folds tell; ``None`` without folds."""
    if folds is None:
        return None
    total = 0.0
    for fold in np.unique(folds):
        out = folds == fold
        total += loss_after(observed, solved, refit(observed, solved, ~out), out)
    return total / len(observed)
