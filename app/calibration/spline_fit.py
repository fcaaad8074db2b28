"""The displacement field that makes lines straight, of the smoothness that they ask for.

The prior is the bending energy of a thin plate (Kimeldorf and Wahba 1970: its weight is a prior's precision). Lines
are eliminated and the field enters their bends linearly, so that one generalised eigenproblem gives field, covariance
and evidence for every weight; the weight of most evidence is taken (MacKay 1992). Segments that nothing straightens
count less, as under Student's law.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from app.calibration.bspline import SplineGrid
from app.calibration.line_bends import LineBends

Array = NDArray[np.float64]

WEIGHTS = np.geomspace(1e-3, 1e4, 29)
"""Of the bending energy in px^-2: its inverse is the mean square of second derivatives that is expected."""
RIDGE = 1e-6
"""Energy of what doesn't bend: a tilted plane is as good as free, and no line tells it."""
FREEDOM = 6.0
"""Of Student's law of a segment's bends."""
ROUNDS = 3
FOLDS = 5
TOLD = 0.5
"""Share of its size that the error of a field may have for the field to count as told."""
LEAST_EVIDENCE = 8.0
"""Natural logarithm of the odds for a field against none, from which lines speak for one."""
MOST_SCALE = 2.0
"""Largest `SplineFit.scale` of lines that may speak for a field: what bends by itself, as kerbs and wires do, bends
much alike in all images of a street, and a field that follows it by some tenths of a px is tens of px where no line
is."""
MOST_NEEDED = 100_000


@dataclass(frozen=True, eq=False)
class SplineFit:
    """A field of C coefficients along x and C along y.

    Attributes:
        coefficients: float64 ``(2 C,)`` px.
        covariance: float64 ``(2 C, 2 C)`` px^2.
        evidence: Natural logarithm of the odds of this smoothness against no field.
        held_out: Share of the bends' mean square, against expected noise, that the field takes away from lines it was
            not fitted to; negative where it adds to it.
        scale: Mean square of what the lines still bend under the field, against expected noise; 1 at least.
        weight: Of the bending energy, against `information`.
        information: float64 ``(2 C, 2 C)``, what the lines say of the coefficients.
        energy: float64 ``(2 C, 2 C)``, the form of the prior.
    """

    coefficients: Array
    covariance: Array
    evidence: float
    held_out: float
    scale: float
    weight: float
    information: Array
    energy: Array


def fit_spline(bends: LineBends, grid: SplineGrid) -> SplineFit:
    """Fit the field to what lines bend.

    Args:
        bends: Of the lines, at least one.
        grid: Knots of the field.
    """
    energy = np.asarray(np.kron(np.eye(2), grid.energy() + RIDGE * np.eye(grid.size)), np.float64)
    amplitudes = bends.bend.shape[1]
    slopes, bend = bends.slopes.reshape(-1, 2 * grid.size), bends.bend.ravel()
    solved = _solved(bends, slopes, bends.weight, energy)
    for _ in range(ROUNDS - 1):
        left = (bend + slopes @ solved.coefficients).reshape(-1, amplitudes)
        distance = (left**2 / bends.sigma**2).sum(1) / solved.scale
        solved = _solved(bends, slopes, bends.weight * (FREEDOM + amplitudes) / (FREEDOM + distance), energy)
    return SplineFit(
        coefficients=solved.coefficients,
        covariance=solved.scale * (solved.vectors / (solved.values + solved.weight)) @ solved.vectors.T,
        evidence=solved.evidence,
        held_out=_held_out(bends, slopes, solved.heavy, energy, solved.weight),
        scale=solved.scale,
        weight=solved.weight / solved.scale,
        information=solved.information / solved.scale,
        energy=energy,
    )


class _Solved(NamedTuple):
    """The field for given weights of the segments; noise is `scale` times what was expected of its square."""

    coefficients: Array
    evidence: float
    weight: float
    scale: float
    heavy: Array
    information: Array
    values: Array
    vectors: Array


def _solved(bends: LineBends, slopes: Array, odds: Array, energy: Array) -> _Solved:
    bend, amplitudes = bends.bend.ravel(), bends.bend.shape[1]
    heavy = np.repeat(odds, amplitudes) / bends.sigma.ravel() ** 2
    information, right = slopes.T @ (heavy[:, None] * slopes), -slopes.T @ (heavy * bend)
    values, vectors = eigh(information, energy)
    values, projected = np.maximum(values, 0.0), vectors.T @ right
    plain, counted = float(heavy @ bend**2), float(odds.sum() * amplitudes)
    scores = [_log_evidence(weight, values, projected, plain, counted) for weight in WEIGHTS]
    best = int(np.argmax(scores))
    weight = float(WEIGHTS[best])
    coefficients = vectors @ (projected / (values + weight))
    scale = max(1.0, float(heavy @ (bend + slopes @ coefficients) ** 2) / counted)
    nothing = -0.5 * counted * float(np.log(plain / counted))
    return _Solved(coefficients, scores[best] - nothing, weight, scale, heavy, information, values, vectors)


def lines_needed(fit: SplineFit, reading: Array, lines: int, worth_knowing: float) -> int:
    """Return how many lines such as those given would tell what the lens's model misses.

    n times the lines have n times the information. So many are needed that of a field worth knowing, as smooth as the
    prior thinks that such fields are, the expected error is half; and, where the lines speak for a field, that the
    error of this one, as rough as they say that it is, is no larger than the field. Lines that leave parts of the frame
    out must be many more, or won't ever do.

    Args:
        fit: To the lines given.
        reading: float64 ``(2 N, 2 C)``, the field at N places from its coefficients.
        lines: Number of the lines given.
        worth_knowing: px RMS over the places, of the length of the displacement.
    """
    values, vectors = eigh(fit.information, fit.energy)
    values = np.maximum(values, 0.0)
    power = ((reading @ vectors) ** 2).sum(0) / (len(reading) / 2)
    size = float(np.sqrt(2 * np.mean((reading @ fit.coefficients) ** 2)))
    wanted = max(size, worth_knowing)
    # the prior's weight at which a field is of that size on average; planes, which the reading hasn't, don't count
    needed = _repeats(values, power, float(power.sum()) / wanted**2, TOLD * wanted)
    if fit.evidence >= LEAST_EVIDENCE:
        needed = max(needed, _repeats(values, power, fit.weight, size))
    return min(int(np.ceil(lines * needed)), MOST_NEEDED)


def _repeats(values: Array, power: Array, weight: float, bound: float) -> float:
    """Return how often the information must be there for an error of at most `bound` px RMS."""

    def error(logarithm: float) -> float:
        return float(np.sqrt((power / (np.exp(logarithm) * values + weight)).sum()))

    low, high = -8.0, float(np.log(MOST_NEEDED))
    if error(high) > bound:
        return float(MOST_NEEDED)
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if error(middle) > bound else (low, middle)
    return float(np.exp(high))


def _log_evidence(weight: float, values: Array, projected: Array, plain: float, counted: float) -> float:
    """Return the evidence for a weight up to a constant, the scale of the noise at its likeliest."""
    misfit = plain - float((projected**2 / (values + weight)).sum())
    volume = float(np.log(weight / (values + weight)).sum())
    return 0.5 * volume - 0.5 * counted * float(np.log(max(misfit, 1e-12) / counted))


def _held_out(bends: LineBends, slopes: Array, heavy: Array, energy: Array, weight: float) -> float:
    """Leave out a fifth of the images at a time, or of the segments where there is one image only."""
    groups = bends.image if len(np.unique(bends.image)) > 1 else np.arange(len(bends))
    fold = np.repeat(np.unique(groups, return_inverse=True)[1] % FOLDS, bends.bend.shape[1])
    bend = bends.bend.ravel()
    left = np.zeros(2)
    for out in (fold == number for number in range(FOLDS)):
        kept = ~out
        information = slopes[kept].T @ (heavy[kept, None] * slopes[kept])
        coefficients = np.linalg.solve(information + weight * energy, -slopes[kept].T @ (heavy[kept] * bend[kept]))
        left += heavy[out] @ bend[out] ** 2, heavy[out] @ (bend[out] + slopes[out] @ coefficients) ** 2
    return float(1 - left[1] / left[0])
