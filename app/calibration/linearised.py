"""What a fit would have been from other lines: steps on the fit's own linear model.

Leaving lines out moves a lens by little, so amplitudes are taken for linear in it and no line is mapped anew; only the
weights of the robust loss change from step to step.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens_solver import SolvedLens
from app.calibration.line_loss import line_loss
from app.calibration.observations import LineObservations
from app.calibration.priors import prior_sd

Array = NDArray[np.float64]

STEPS = 3


def refit(observed: LineObservations, solved: SolvedLens, taken: NDArray[np.bool_]) -> Array:
    """Return the change of the released parameters if only some lines had been there, float64 ``(P,)``.

    Args:
        observed: All lines of the fit.
        solved: The fit.
        taken: bool ``(S,)``, lines to use.
    """
    index = np.asarray(solved.released, np.int64)
    sd, start = prior_sd(solved.lens.family)[index], solved.parameters[index]
    lines, slopes = observed.select(taken), solved.slopes[taken][..., index]
    bends, variance = solved.bends[taken], solved.variance[taken]
    change = np.zeros(len(index))
    for _ in range(STEPS):
        loss = line_loss(lines, bends + slopes @ change, variance, solved.noise.freedom)
        flat = (slopes * np.sqrt(loss.weight[:, None] / variance)[..., None]).reshape(-1, len(index))
        downhill = np.einsum("sd,sdp->p", loss.pull, slopes) + (start + change) / sd**2
        change = change - np.linalg.solve(flat.T @ flat + np.diag(sd**-2), downhill)
    return change


def loss_after(observed: LineObservations, solved: SolvedLens, change: Array, asked: NDArray[np.bool_]) -> float:
    """Return the loss of some lines after a change of the released parameters."""
    slopes = solved.slopes[asked][..., list(solved.released)]
    return float(
        line_loss(
            observed.select(asked), solved.bends[asked] + slopes @ change, solved.variance[asked], solved.noise.freedom
        ).loss.sum()
    )
