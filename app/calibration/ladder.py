"""The model ladder: parameters are released only if the marginal likelihood and lines that were left out agree.

k1, then k2, then the centre (and k2 again), then k3, then p1 and p2. Left-out lines alone don't catch a parameter that
is released wrongly, since all images share the error; the likelihood alone trusts that lines are independent.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.calibration.calibration import Rung
from app.calibration.held_out import held_out_loss
from app.calibration.lens import FAMILIES, CameraLens, Family
from app.calibration.lens_solver import SolvedLens, of_family, solve
from app.calibration.observations import LineObservations
from app.calibration.posterior import field_sensitivity, lens_posterior

STEPS = (("k2",), ("cx", "cy"), ("k2",), ("k3",), ("p1", "p2"))
"""k2 is asked once more after the centre: about a wrong one it can't be told."""
LEAST_GAIN = {"k2": 0.0, "cx": 0.0, "k3": 1.0, "p1": 6.0}
"""Nats that the marginal likelihood must gain."""
ONE_IMAGE_GAIN = 3.0
"""Nats on top where all lines are of one image: its structures are no independent witnesses."""


class Climbed(NamedTuple):
    """Where a family's ladder ended.

    Attributes:
        solved: The fit.
        rungs: All that was tried.
        held_out: Mean loss of a line that was left out; ``None`` if none could be.
    """

    solved: SolvedLens
    rungs: tuple[Rung, ...]
    held_out: float | None


def climb(
    observed: LineObservations,
    family: Family,
    start: CameraLens,
    folds: NDArray[np.int64] | None,
    watch: Callable[[], None],
) -> Climbed:
    """Release parameters of a family one step after the other.

    Args:
        observed: Lines of the camera.
        family: The family.
        start: From `start_lens`.
        folds: int64 ``(S,)``, which lines are left out together; ``None`` if none can be.
        watch: Called before each step.
    """
    names = FAMILIES[family].names
    best = solve(observed, of_family(start, family), [names.index("k1")])
    held_out = held_out_loss(observed, best, folds)
    rungs = [_rung(observed, best, held_out, True, "the least that tells a lens")]
    single = len(np.unique(observed.image)) < 2
    asked_of: set[tuple[tuple[str, ...], tuple[str, ...]]] = set()
    for step in STEPS:
        if set(step) <= set(best.names) or (step, best.names) in asked_of:
            continue
        asked_of.add((step, best.names))
        if not set(step) <= set(names) or (step == ("k3",) and "k2" not in best.names):
            continue
        watch()
        released = sorted([*best.released, *(names.index(name) for name in step)])
        tried = solve(observed, best.lens, released, best.noise, rounds=2)
        tried_held_out = held_out_loss(observed, tried, folds)
        gain = best.penalised - tried.penalised
        asked = LEAST_GAIN[step[0]] + (ONE_IMAGE_GAIN if single else 0.0)
        helps = held_out is None or tried_held_out is None or tried_held_out < held_out
        accepted = gain >= asked and helps
        words = " and ".join(step)
        if accepted:
            reason = f"{words} explain{'s' * (len(step) == 1)} lines better, also those left out"
        elif gain < asked:
            reason = f"the lines don't tell {words}: the likelihood gains {gain:.1f} where {asked:.0f} is asked"
        else:
            reason = f"{words} would fit these lines better, but not those left out"
        rungs.append(_rung(observed, tried, tried_held_out, accepted, reason))
        if accepted:
            best, held_out = tried, tried_held_out
    return Climbed(best, tuple(rungs), held_out)


def _rung(observed: LineObservations, solved: SolvedLens, held_out: float | None, accepted: bool, reason: str) -> Rung:
    posterior = lens_posterior(observed, solved)
    form = posterior.second_moment @ field_sensitivity(solved.lens)
    pred = float(np.sqrt(max(np.trace(form), 0.0)))
    return Rung(solved.lens.family, solved.names, solved.penalised, held_out, pred, accepted, reason)
