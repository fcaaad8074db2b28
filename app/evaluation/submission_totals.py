"""What the records of a submission's images add up to: every metric with its interval, strata, error types."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.evaluation import clearlines_v2
from app.evaluation.bootstrap import DRAWS, LEVEL, Estimate, Measure, clusters_of, estimates
from app.evaluation.calibration_score import CalibrationScore, total_calibration
from app.evaluation.error_types import ErrorType
from app.evaluation.image_record import ImageRecord
from app.evaluation.protocols import PROTOCOLS, SCORER_VERSION, protocol_named
from app.evaluation.rejected_lines import REASON, reason_strata
from app.evaluation.split_image import SplitImageInfo
from app.evaluation.strata import STRATA, stratum_metrics
from app.evaluation.tallies import GRID_TAUS, GRID_THRESHOLDS, LAYOUT
from app.evaluation.totals import total

SEED = 0
"""Of the bootstrap: one for all submissions, so that all of a split are measured on the same draws."""

COUNTS = ("tp", "fp", "fn")
UNKNOWN_SOURCE = "unknown"


def score_totals(
    images: Sequence[SplitImageInfo],
    records: Sequence[ImageRecord],
    cameras: Sequence[CalibrationScore] = (),
    *,
    draws: int = DRAWS,
    seed: int = SEED,
) -> dict[str, Any]:
    """Add up the images of a submission.

    Args:
        images: All images of the split, in its order.
        records: Their records.
        cameras: What `score_cameras` found.
        draws: Draws of the bootstrap.
        seed: Of the draws.

    Returns:
        For JSON: ``protocols`` (name to version and ``totals``, each metric as ``{value, low, high}``), ``f1_grid``
        (M2), ``strata`` (kind to a list of strata), ``error_types`` (name to number), ``cameras``, and what the
        intervals stand on: ``images``, ``clusters``, ``draws``, ``level``; ``scorer_version``.

    Raises:
        InvalidInput: When there are no images, or not one record for each.
    """
    if not images or len(images) != len(records):
        raise InvalidInput(f"{len(records)} records don't go with {len(images)} images", where="records")
    clusters = clusters_of([image.sequence for image in images])
    protocols = {}
    for name, protocol in PROTOCOLS.items():
        found = estimates(measure_of(records, name), clusters, draws, seed=seed)
        protocols[name] = {
            "version": protocol.version,
            "totals": {key: _without_chance(key, estimate).as_dict() for key, estimate in found.items()},
        }
    calibration = total_calibration(cameras)
    protocols[clearlines_v2.PROTOCOL]["totals"] |= {
        "calibration_rms": Estimate(calibration.rms, None, None).as_dict(),
        "calibration_grid": Estimate(calibration.grid, None, None).as_dict(),
    }
    return {
        "protocols": protocols,
        "f1_grid": _f1_grid(records),
        "strata": _strata(images, records, clusters, draws, seed),
        "error_types": _error_counts(records),
        "cameras": [score.as_dict() for score in cameras],
        "images": len(images),
        "clusters": int(clusters.max()) + 1,
        "draws": draws,
        "level": LEVEL,
        "scorer_version": SCORER_VERSION,
    }


def measure_of(records: Sequence[ImageRecord], protocol: str = clearlines_v2.PROTOCOL) -> Measure:
    """Return the metrics of images under weightings of them, as intervals, comparisons and ranks need them.

    Args:
        records: I images.
        protocol: Name of the protocol.

    Raises:
        InvalidInput: When there is no such protocol, or no images.
    """
    chosen = protocol_named(protocol)
    tallies = np.array([record.tallies[protocol] for record in records])
    ranked = [record.ranked for record in records] if protocol == clearlines_v2.PROTOCOL else None

    def measure(weights: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        values = total(chosen, tallies, ranked, weights)
        return {name: value for name, value in values.items() if value.ndim == 1}

    return measure


def _without_chance(key: str, estimate: Estimate) -> Estimate:
    """Take the interval from a count: it is what it is, and rises and falls with the number of lines drawn."""
    return Estimate(estimate.value, None, None) if key in COUNTS else estimate


def _f1_grid(records: Sequence[ImageRecord]) -> dict[str, Any]:
    """Return the grid that M2 is the mean of."""
    tallies = np.sum([record.tallies[clearlines_v2.PROTOCOL] for record in records], axis=0)
    grid = PROTOCOLS[clearlines_v2.PROTOCOL].metrics(tallies)["f1_grid"]
    return {"taus": list(GRID_TAUS), "thresholds": list(GRID_THRESHOLDS), "f1": grid.tolist()}


def _strata(
    images: Sequence[SplitImageInfo],
    records: Sequence[ImageRecord],
    clusters: NDArray[np.int64],
    draws: int,
    seed: int,
) -> dict[str, list[dict[str, Any]]]:
    """Return M9: of each kind the strata, each with its counts and metrics; by distance only if all sizes are known.

    The kind ``reason`` is there where candidates are known that people rejected with one, see
    `app.evaluation.rejected_lines.reason_strata`.
    """

    def stratum(name: str, counts: NDArray[np.float64]) -> dict[str, Any]:
        found = estimates(lambda weights: stratum_metrics(weights @ counts), clusters, draws, seed=seed)
        numbers = {key: int(value) for key, value in zip(COUNTS, counts.sum(axis=0), strict=True)}
        return {"name": name, **numbers, **{key: found[key].as_dict() for key in ("f1", "precision", "recall")}}

    sources = np.array([image.source or UNKNOWN_SOURCE for image in images])
    parts = [LAYOUT.unpack(record.tallies[clearlines_v2.PROTOCOL]) for record in records]
    whole = np.array([[part[key] for key in COUNTS] for part in parts])
    by_stratum = np.array([record.strata for record in records])
    strata = {
        "source": [
            {**stratum(source, whole * (sources == source)[:, None]), "images": int((sources == source).sum())}
            for source in sorted(set(sources.tolist()))
        ]
    }
    first = 0
    for kind, names in STRATA.items():
        if kind != "distance" or all(image.size for image in images):
            strata[kind] = [stratum(name, by_stratum[:, first + place]) for place, name in enumerate(names)]
        first += len(names)
    if reasons := reason_strata(np.array([record.reasons for record in records]), clusters, draws, seed):
        strata[REASON] = reasons
    return strata


def _error_counts(records: Sequence[ImageRecord]) -> dict[str, int]:
    """Return M8: how many errors there are of each type."""
    types = np.concatenate([np.append(record.prediction_errors, record.label_errors) for record in records])
    counts = np.bincount(types, minlength=len(ErrorType)).tolist()
    return {kind.name.lower(): counts[kind] for kind in ErrorType if kind is not ErrorType.NONE}
