"""What is measured of an estimated lens, and how many such measurements are summed up."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.vision import Segments, estimate_distortion
from app.vision.brown import Brown
from app.vision.field import Lens, field_error
from app.vision.lens_fields import brown_from_dict


@dataclass(frozen=True)
class Measured:
    """One estimate against the truth; field errors in px RMS over the frame.

    Attributes:
        identity: Field error of making no correction.
        msac: Field error of the paper's estimate; that of the identity where it made none.
        ours: Field error of the estimate, accepted or not.
        accepted: Whether the estimate said that it may be used.
        pred: The error it predicts of itself.
        pred_of_identity: The error it predicts of making no correction.
        seconds: Of the thread on the processor, for fit, verdict and MSAC without detection; neither other programs nor
            the idling threads of a linear algebra library count.
    """

    identity: float
    msac: float
    ours: float
    accepted: bool
    pred: float
    pred_of_identity: float
    seconds: float


def measure(segments: Sequence[Segments], truth: Lens, width: int, height: int) -> Measured:
    """Estimate the lens of one camera and compare it with the true one."""
    start = time.thread_time()
    estimate = estimate_distortion(segments, (width, height))
    seconds = time.thread_time() - start
    unchanged = Brown.identity(width, height)
    paper = unchanged if estimate.msac is None else brown_from_dict(estimate.msac)
    identity, msac, ours = (field_error(truth, lens, width, height).rms for lens in (unchanged, paper, estimate.brown))
    uncertainty = estimate.uncertainty
    return Measured(identity, msac, ours, estimate.accepted, uncertainty.pred, uncertainty.pred_of_identity, seconds)


def summary(measured: Sequence[Measured]) -> dict[str, float | None]:
    """Sum up a set of estimates; errors of ours over the accepted ones, of the others over all."""
    taken = [each for each in measured if each.accepted]
    errors = np.array([each.ours for each in taken])
    seconds = np.array([each.seconds for each in measured])
    return {
        "cameras": len(measured),
        "identity_median": float(np.median([each.identity for each in measured])),
        "msac_median": float(np.median([each.msac for each in measured])),
        "msac_p90": float(np.quantile([each.msac for each in measured], 0.9)),
        "median": float(np.median(errors)) if len(taken) else None,
        "p90": float(np.quantile(errors, 0.9)) if len(taken) else None,
        "largest": float(errors.max()) if len(taken) else None,
        "accepted_share": len(taken) / len(measured),
        "accepted_worse_than_identity": float(sum(each.ours > each.identity for each in taken)),
        "seconds_median": float(np.median(seconds)),
        "seconds_largest": float(seconds.max()),
    }


def honesty(measured: Sequence[Measured], *, refused_at_identity: bool) -> dict[str, float | None]:
    """Compare errors with what was predicted of them.

    Args:
        measured: The estimates.
        refused_at_identity: Whether refused ones count, as making no correction and with what is predicted of that;
            else they are left out. Those that predict nothing finite are left out either way.
    """
    ratios = [each.ours / each.pred for each in measured if each.accepted]
    if refused_at_identity:
        ratios += [
            each.identity / each.pred_of_identity
            for each in measured
            if not each.accepted and np.isfinite(each.pred_of_identity)
        ]
    if not ratios:
        return {"number": 0, "within_pred": None, "within_two_pred": None, "median_ratio": None}
    ratio = np.array(ratios)
    return {
        "number": len(ratio),
        "within_pred": float(np.mean(ratio <= 1)),
        "within_two_pred": float(np.mean(ratio <= 2)),
        "median_ratio": float(np.median(ratio)),
    }
