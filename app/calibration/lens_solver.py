"""The most plausible lens of a family with some of its parameters released: Levenberg's and Marquardt's method.

Minimised is the loss of all lines plus that of the priors. The step's matrix is Gauss and Newton's, with the weights
that the robust loss gives the lines. Between rounds of steps the noise of the lines is estimated anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens import FAMILIES, CameraLens, Family
from app.calibration.line_loss import LineLoss, line_loss
from app.calibration.line_noise import LineNoise, estimate_noise, variances
from app.calibration.observations import LineObservations
from app.calibration.priors import prior_sd
from app.calibration.straight_fit import amplitudes, amplitudes_and_slopes
from app.vision.frame import center_of, frame_grid

Array = NDArray[np.float64]

ROUNDS = 3
"""Of steps, with the noise estimated after each but the last."""
MOST_STEPS = 15
STILL = 1e-3
"""Fall of the loss, in nats, below which steps stop."""
FIRST_NOISE = LineNoise(3.0, 0.05, 5.0)


@dataclass(frozen=True, eq=False)
class SolvedLens:
    """A fitted lens with everything that is asked of it later.

    Attributes:
        lens: The lens.
        released: Indices of the released parameters.
        noise: The law of the lines' own bends.
        bends: Amplitudes left, float64 ``(S, 5)`` px.
        slopes: Their derivatives by all parameters of the family, float64 ``(S, 5, P)``.
        variance: Of the amplitudes, float64 ``(S, 5)`` px squared.
        lines: Loss, weights and probabilities of the lines.
        penalised: Negative logarithm of likelihood and priors, integrated over the released parameters (Laplace's
            approximation), so that a parameter has to pay for itself.
    """

    lens: CameraLens
    released: tuple[int, ...]
    noise: LineNoise
    bends: Array
    slopes: Array
    variance: Array
    lines: LineLoss
    penalised: float

    @property
    def parameters(self) -> Array:
        """All parameters of the family."""
        return np.asarray(self.lens.parameters)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the released parameters."""
        return tuple(self.lens.names[index] for index in self.released)


def solve(
    observed: LineObservations,
    start: CameraLens,
    released: Sequence[int],
    noise: LineNoise = FIRST_NOISE,
    *,
    rounds: int = ROUNDS,
) -> SolvedLens:
    """Fit the released parameters; the others stay as they are in `start`.

    Args:
        observed: Lines of the camera.
        start: Where to start; must be invertible.
        released: Indices of the parameters to fit.
        noise: Law to start with.
        rounds: Rounds of steps.
    """
    lens, index = start, np.asarray(released, np.int64)
    variance = variances(observed, noise)
    for number in range(rounds):
        lens, bends, slopes, loss = _steps(observed, lens, index, variance, noise.freedom)
        if number < rounds - 1 and len(observed):
            noise = estimate_noise(observed, bends, loss.straight, _leverage(slopes, loss, variance, lens, index))
            variance = variances(observed, noise)
    return _solved(observed, lens, index, noise)


def judged(observed: LineObservations, lens: CameraLens, released: Sequence[str]) -> SolvedLens:
    """Return what a fit that led to this lens would say of lines; nothing moves but the lines' noise.

    Args:
        observed: Lines of the camera.
        lens: The lens.
        released: Names of the parameters that were estimated.
    """
    index = np.array([lens.names.index(name) for name in released], np.int64)
    noise = FIRST_NOISE
    for _ in range(ROUNDS if len(observed) else 0):
        found = _solved(observed, lens, index, noise)
        leverage = _leverage(found.slopes, found.lines, found.variance, lens, index)
        noise = estimate_noise(observed, found.bends, found.lines.straight, leverage)
    return _solved(observed, lens, index, noise)


def _solved(observed: LineObservations, lens: CameraLens, index: NDArray[np.int64], noise: LineNoise) -> SolvedLens:
    bends, slopes = amplitudes_and_slopes(observed, lens.family, np.asarray(lens.parameters))
    variance = variances(observed, noise)
    loss = line_loss(observed, bends, variance, noise.freedom)
    sd = prior_sd(lens.family)
    precision = _precision(slopes, loss.weight, variance, sd, index)
    _, determinant = np.linalg.slogdet(precision)
    penalised = _objective(loss, lens, sd, index) + np.log(sd[index]).sum() + 0.5 * determinant
    return SolvedLens(lens, tuple(int(each) for each in index), noise, bends, slopes, variance, loss, float(penalised))


def _steps(
    observed: LineObservations, lens: CameraLens, index: NDArray[np.int64], variance: Array, freedom: float
) -> tuple[CameraLens, Array, Array, LineLoss]:
    sd = prior_sd(lens.family)
    parameters = np.asarray(lens.parameters)
    bends, slopes = amplitudes_and_slopes(observed, lens.family, parameters)
    loss = line_loss(observed, bends, variance, freedom)
    objective, damping = _objective(loss, lens, sd, index), 1e-3
    for _ in range(MOST_STEPS):
        precision = _precision(slopes, loss.weight, variance, sd, index)
        downhill = np.einsum("sd,sdp->p", loss.pull, slopes[..., index]) + parameters[index] / sd[index] ** 2
        while damping < 1e8:
            step = np.linalg.solve(precision + damping * np.diag(np.diag(precision)), downhill)
            ahead = parameters.copy()
            ahead[index] -= step
            candidate = CameraLens(lens.family, lens.width, lens.height, tuple(ahead.tolist()))
            if candidate.is_invertible():
                ahead_bends = amplitudes(observed, lens.family, ahead)
                if np.isfinite(ahead_bends).all():
                    ahead_loss = line_loss(observed, ahead_bends, variance, freedom)
                    ahead_objective = _objective(ahead_loss, candidate, sd, index)
                    if ahead_objective <= objective:
                        break
            damping *= 10
        else:
            break
        fall = objective - ahead_objective
        lens, parameters, objective, damping = candidate, ahead, ahead_objective, max(damping / 10, 1e-9)
        bends, slopes = amplitudes_and_slopes(observed, lens.family, parameters)
        loss = ahead_loss
        if fall < STILL:
            break
    return lens, bends, slopes, loss


def _objective(loss: LineLoss, lens: CameraLens, sd: Array, index: NDArray[np.int64]) -> float:
    return float(loss.loss.sum() + 0.5 * ((np.asarray(lens.parameters)[index] / sd[index]) ** 2).sum())


def _precision(slopes: Array, weight: Array, variance: Array, sd: Array, index: NDArray[np.int64]) -> Array:
    scaled = slopes[..., index] * np.sqrt(weight[:, None] / variance)[..., None]
    flat = scaled.reshape(-1, len(index))
    return flat.T @ flat + np.diag(sd[index] ** -2.0)


def _leverage(slopes: Array, loss: LineLoss, variance: Array, lens: CameraLens, index: NDArray[np.int64]) -> Array:
    """Return the share of each amplitude's variance that the fit takes away, ``(S, 5)``."""
    sd = prior_sd(lens.family)
    covariance = np.linalg.inv(_precision(slopes, loss.weight, variance, sd, index))
    chosen = slopes[..., index]
    return np.einsum("sdp,pq,sdq->sd", chosen, covariance, chosen) * loss.weight[:, None] / variance


def start_lens(observed: LineObservations, width: int, height: int) -> CameraLens:
    """Return the lens of one coefficient that is most plausible over a scan, to start from.

    It is of the division model, which maps fast and is one-to-one over the whole scan; see `of_family`.
    """
    long = np.argsort(-observed.length, kind="stable")[:SCANNED]
    lines, zeros = observed.select(long), (0.0, 0.0, 0.0, 0.0)
    variance = variances(lines, FIRST_NOISE)
    losses = [
        float(
            line_loss(
                lines, amplitudes(lines, "division", np.array([k1, *zeros])), variance, FIRST_NOISE.freedom
            ).loss.sum()
        )
        if CameraLens("division", width, height, (float(k1), *zeros)).is_invertible()
        else np.inf
        for k1 in SCAN
    ]
    return CameraLens("division", width, height, (float(SCAN[int(np.argmin(losses))]), *zeros))


def of_family(scanned: CameraLens, family: Family) -> CameraLens:
    """Return the lens of one coefficient of another family that is nearest to one of the division model."""
    names = FAMILIES[family].names
    k1 = scanned.parameters[0]
    if family != "division":
        grid = frame_grid(scanned.width, scanned.height, 24)
        center = center_of(scanned.width, scanned.height)
        measured, corrected = ((each - center) / scanned.scale for each in (grid, scanned.undistort(grid)))
        source, target = (measured, corrected) if family == "brown" else (corrected, measured)
        cubic = source * (source**2).sum(1, keepdims=True)
        k1 = float((cubic * (target - source)).sum() / (cubic**2).sum())
    while True:
        lens = CameraLens(family, scanned.width, scanned.height, (k1,) + (0.0,) * (len(names) - 1))
        if lens.is_invertible():
            return lens
        k1 *= 0.8


SCAN = np.concatenate([np.linspace(-0.25, 0.0, 11), np.linspace(0.025, 0.6, 24)])
"""Coefficients k1 of the division model that a fit may start from."""
SCANNED = 300
"""Lines, the longest, that are scanned."""
