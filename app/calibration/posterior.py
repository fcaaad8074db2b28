"""All that is left open about a lens once lines were fitted: of released parameters and of the others.

A parameter that wasn't released isn't known to be 0; lines and its prior leave it some room, and what it could be is an
error of the lens that was stated. So the covariance is taken of all parameters of the family and of one more term that
none of the families has, around the most plausible point of all of these, which is not where the lens is.

Two things are asked of the covariance of likelihood and priors C: whether the lines scatter as much as they should
(the sandwich C (sum of g g') C with the lines' own gradients g, each enlarged by its leverage; White 1980, MacKinnon
and White 1985), and whether images and structures of the scene do. Where the error that they say is larger, all of C is
enlarged to it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens import FAMILIES, CameraLens
from app.calibration.lens_solver import SolvedLens
from app.calibration.observations import STRUCTURES, LineObservations, structures_of
from app.calibration.priors import prior_kinds, prior_sd
from app.calibration.straight_fit import field_slopes, residuals
from app.vision.field import observable_part
from app.vision.frame import center_of, frame_grid, half_diagonal

Array = NDArray[np.float64]

FEWEST_GROUPS = 6
"""Fewer groups of lines can't show how much they scatter."""


@dataclass(frozen=True, eq=False)
class LensPosterior:
    """A mixture of K normal laws of the error of a lens's parameters, those of the family and the one beyond.

    Attributes:
        weight: float64 ``(K,)``, adding up to 1.
        mean: float64 ``(K, P)``, most plausible parameters minus those of the lens.
        covariance: float64 ``(K, P, P)``.
        inflation: Factor that the covariances were enlarged by.
        information: float64 ``(S,)``, share of what the lines tell that each line tells; adds up to at most P.
        released: float64 ``(R, R)``, covariance of the released parameters, the others taken as they are.
    """

    weight: Array
    mean: Array
    covariance: Array
    inflation: float
    information: Array
    released: Array

    @property
    def second_moment(self) -> Array:
        """Mean of the error times itself, float64 ``(P, P)``."""
        outer = self.covariance + self.mean[:, :, None] * self.mean[:, None, :]
        return np.asarray(np.einsum("k,kpq->pq", self.weight, outer), np.float64)


def lens_posterior(observed: LineObservations, solved: SolvedLens) -> LensPosterior:
    """Return what is left open about a fitted lens."""
    slopes = extended_slopes(observed, solved.lens)
    parameters = np.append(solved.parameters, 0.0)
    scaled = slopes * np.sqrt(solved.lines.weight[:, None] / solved.variance)[..., None]
    flat = scaled.reshape(-1, len(parameters))
    told = flat.T @ flat
    gradients = np.einsum("sd,sdp->sp", solved.lines.pull, slopes)

    precision = prior_kinds(solved.lens.family) ** -2.0
    covariance = np.asarray(np.linalg.inv(told + precision[:, :, None] * np.eye(len(parameters))), np.float64)
    downhill = gradients.sum(0) + precision * parameters
    mean = -np.einsum("kpq,kq->kp", covariance, downhill)
    score = -0.5 * np.einsum("kp,kp->k", downhill, mean) - 0.5 * (precision * parameters**2).sum(1)
    score += 0.5 * (np.linalg.slogdet(covariance)[1] + np.log(precision).sum(1))
    weight = np.exp(score - score.max())
    weight /= weight.sum()

    top = int(np.argmax(weight))
    inflation = _inflation(
        observed, scaled, gradients + _pull_change(scaled, mean[top]), covariance[top], precision[top], solved
    )
    index = np.asarray(solved.released, np.int64)
    own = scaled[..., index].reshape(-1, len(index))
    own_precision = own.T @ own + np.diag(prior_sd(solved.lens.family)[index] ** -2.0)
    released = np.asarray(np.linalg.inv(own_precision) * inflation, np.float64)
    information = np.einsum("sdp,pq,sdq->s", scaled, covariance[top], scaled)
    return LensPosterior(weight, mean, covariance * inflation, inflation, information, released)


def _pull_change(scaled: Array, change: Array) -> Array:
    """Return by how much the lines' gradients change with the parameters, ``(S, P)``."""
    return np.einsum("sdp,sd->sp", scaled, scaled @ change)


def _inflation(
    observed: LineObservations, scaled: Array, gradients: Array, covariance: Array, precision: Array, solved: SolvedLens
) -> float:
    """Return by which factor lines or images scatter more than they should; at least 1."""
    sensitivity = field_sensitivity(solved.lens)
    information = np.einsum("sdp,pq,sdq->s", scaled, covariance, scaled)
    bands = structures_of(observed)
    groups = (np.arange(len(observed)), observed.image, bands + STRUCTURES * observed.image, bands)
    seen = max(_scatter(gradients, information, each, covariance, sensitivity) for each in groups)
    # what priors hold is no matter of how lines scatter
    held = float(np.trace(covariance @ np.diag(precision) @ covariance @ sensitivity))
    return max(1.0, (seen + held) / max(float(np.trace(covariance @ sensitivity)), 1e-300))


def _scatter(
    gradients: Array, information: Array, groups: NDArray[np.int64], covariance: Array, sensitivity: Array
) -> float:
    """Return the mean squared field error, px squared, that the scatter of groups of lines says; 0 for too few."""
    found, of_line = np.unique(groups, return_inverse=True)
    if len(found) < FEWEST_GROUPS:
        return 0.0
    summed = np.zeros((len(found), gradients.shape[1]))
    np.add.at(summed, of_line, gradients)
    share = np.bincount(of_line, information, len(found)) / max(np.linalg.matrix_rank(covariance), 1)
    summed /= np.sqrt(np.maximum(1 - share, 0.3))[:, None]
    moved = summed @ covariance
    return float(np.einsum("gp,pq,gq->", moved, sensitivity, moved))


def field_sensitivity(lens: CameraLens) -> Array:
    """Return the form that turns errors of all parameters, and the one beyond, into px squared of the field."""
    grid = frame_grid(lens.width, lens.height, 24)
    fields = observable_fields(lens, grid)
    return fields.T @ fields / len(grid)


def observable_fields(lens: CameraLens, grid: Array) -> Array:
    """Return what small changes of all parameters, and of the one beyond, do to points that no homography can.

    Args:
        lens: The lens.
        grid: Points ``(N, 2)`` in px of the measured image, spread over the frame.

    Returns:
        float64 ``(2 N, P + 1)`` px, x parts first.
    """
    scale = half_diagonal(lens.width, lens.height)
    x, y = ((grid - center_of(lens.width, lens.height)) / scale).T
    family = FAMILIES[lens.family]
    mapped = family.map_points(np.asarray(lens.parameters), x, y)
    dx, dy = family.map_derivatives(np.asarray(lens.parameters), x, y)
    beyond = _beyond(lens, x, y)
    fields = np.concatenate([np.concatenate([dx, beyond[0][None]]), np.concatenate([dy, beyond[1][None]])], axis=1).T
    return scale * observable_part(np.stack([mapped.x, mapped.y], -1), fields)


def _beyond(lens: CameraLens, x: Array, y: Array) -> tuple[Array, Array]:
    cx, cy = lens.parameters[-2:]
    fourth = ((x - cx) ** 2 + (y - cy) ** 2) ** 4
    return (x - cx) * fourth, (y - cy) * fourth


def extended_slopes(observed: LineObservations, lens: CameraLens) -> Array:
    """Return derivatives of the lines' amplitudes by all parameters and the one beyond, ``(S, 5, P + 1)``."""
    family, parameters = FAMILIES[lens.family], np.asarray(lens.parameters)
    left = residuals(observed, family.map_points(parameters, observed.x, observed.y))
    fields = family.derivatives_from(parameters, left.foot_x, left.foot_y, left.foot)
    beyond = _beyond(lens, left.foot_x, left.foot_y)
    dx, dy = (np.concatenate([own, more[None]]) for own, more in zip(fields, beyond, strict=True))
    return field_slopes(observed, left, dx, dy)
