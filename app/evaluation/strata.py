"""M9: the score of lines of one length, orientation or place in the image.

A true positive and a false negative stand where their label does, a false positive where the prediction does, as in
COCO's ranges of area (Lin et al., "Microsoft COCO", ECCV 2014). Each is in one stratum of each kind, so that the strata
of a kind add up to the whole. The source of an image, the fourth kind, is known only to who knows the images.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.evaluation.metrics import f1, precision, recall
from app.evaluation.outcome import Outcome, Outcomes
from app.evaluation.resampling import resample
from app.vision.frame import center_of, half_diagonal
from app.vision.segments import Segments

LENGTHS = (100.0, 200.0, 400.0)
"""Arc lengths at which the next stratum begins, px."""
ALONG_AXIS = float(np.radians(22.5))
"""Greatest angle to an image axis, rad; beyond it on both sides a line is diagonal."""
DISTANCES = (1 / 3, 2 / 3)
"""Distances from the centre at which the next stratum begins, in half diagonals."""

STRATA: dict[str, tuple[str, ...]] = {
    "length": ("under 100 px", "100-200 px", "200-400 px", "400 px and more"),
    "orientation": ("horizontal", "diagonal", "vertical"),
    "distance": ("inner third", "middle third", "outer third"),
}
"""Names of the strata of each kind, in order."""

COUNT = sum(map(len, STRATA.values()))
"""S, number of strata of all kinds."""

_STEP = 4.0  # px between the points at which the distance from the centre is taken


def stratum_tallies(
    labels: Segments, predictions: Segments, outcomes: Outcomes, size: tuple[int, int] | None
) -> NDArray[np.float64]:
    """Count the true positives, false positives and false negatives of an image in each stratum.

    Args:
        labels: The L labels, px.
        predictions: The P predictions, px.
        outcomes: What became of each under clearlines-v2.
        size: Width and height of the image, px, if known.

    Returns:
        float64 ``(S, 3)``, S the strata of all kinds in the order of ``STRATA``; additive over images. Nothing is
        counted by distance where the size isn't known.
    """
    found = labels.select(outcomes.labels == Outcome.HIT)
    wrong = predictions.select(outcomes.predictions == Outcome.FALSE_ALARM)
    missed = labels.select(outcomes.labels == Outcome.MISS)
    return np.stack([_counts(segments, size) for segments in (found, wrong, missed)], axis=1)


def stratum_metrics(tallies: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return M1 with its precision and recall of strata.

    Args:
        tallies: float64 ``(..., 3)``: true positives, false positives, false negatives, added up over images.

    Returns:
        ``f1``, ``precision``, ``recall``, ``tp``, ``fp`` and ``fn``, each float64 ``(...)``.
    """
    tp, fp, fn = np.moveaxis(np.asarray(tallies, np.float64), -1, 0)
    return {
        "f1": f1(tp, fp, fn),
        "precision": precision(tp, fp, fn),
        "recall": recall(tp, fp, fn),
        "tp": tp,
        "fp": fp,
        "fn": fn,
    }


def strata_of(segments: Segments, size: tuple[int, int] | None) -> dict[str, NDArray[np.int64]]:
    """Return the stratum of each segment, as place in ``STRATA``, for each kind.

    The length is the arc length. The orientation is that of the chord from the first point to the last, the distance
    the mean distance of its points from the image's centre.

    Args:
        segments: S segments, px.
        size: Width and height of the image, px; without it there is no distance.

    Returns:
        int64 ``(S,)`` by kind.
    """
    across, down = np.abs(segments.points[segments.offsets[1:] - 1] - segments.points[segments.offsets[:-1]]).T
    angle = np.arctan2(down.astype(np.float64), across)
    strata = {
        "length": np.digitize(segments.lengths(), LENGTHS),
        "orientation": np.digitize(angle, [np.nextafter(ALONG_AXIS, 9), np.pi / 2 - ALONG_AXIS]),
    }
    if size is not None:
        samples = resample(segments, step=_STEP)
        radius = np.hypot(*(samples.points - center_of(*size)).T)
        distance = np.bincount(samples.polyline, radius, len(samples)) / np.diff(samples.offsets)
        strata["distance"] = np.digitize(distance / half_diagonal(*size), DISTANCES)
    return strata


def _counts(segments: Segments, size: tuple[int, int] | None) -> NDArray[np.float64]:
    found = strata_of(segments, size)
    unknown = np.zeros(0, np.int64)
    counts = [np.bincount(found.get(kind, unknown), minlength=len(names)) for kind, names in STRATA.items()]
    return np.concatenate(counts).astype(np.float64)
