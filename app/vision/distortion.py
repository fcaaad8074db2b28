"""Lens distortion of a camera from the segments of its images.

The estimate is the robust division-model fit of `app.vision.lens_fit`, given as Brown-Conrady parameters by refit, with
its uncertainty and a verdict; the paper's MSAC estimate is reported beside it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput
from app.vision.bins import BinnedSegments, bin_segments
from app.vision.brown import Brown
from app.vision.conversion import refit_brown
from app.vision.division import Division
from app.vision.field import FieldError, field_error
from app.vision.lens_fields import brown_as_dict, brown_from_dict, finite_or_none, mapping_from, numbers_from
from app.vision.lens_fit import LensFit, fit_lens
from app.vision.lens_segments import lens_mask, most_informative
from app.vision.lens_uncertainty import LensUncertainty, lens_uncertainty, reasons_to_refuse
from app.vision.msac import MsacResult, msac_brown
from app.vision.persistence import static_segments
from app.vision.segments import Segments

FEWEST_SEGMENTS = 3
"""Fewer usable segments than this are refused without a fit."""
TRUSTED = 0.5
"""Probability of being straight from which a segment counts as trusted."""


class TrustedSegments(NamedTuple):
    """What the estimate took from one image.

    Attributes:
        segment: int64 ``(U,)``, index of each segment that was used.
        probability: float64 ``(U,)`` in [0, 1], of being straight under the lens; trusted from 0.5 on.
        residual: float64 ``(U,)`` px, RMS of bend and roughness left under the lens, in the measured image.
    """

    segment: NDArray[np.int64]
    probability: NDArray[np.float64]
    residual: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DistortionEstimate:
    """The lens of one camera, as estimated.

    Attributes:
        brown: Brown-Conrady lens in the undistort direction, refitted to `division`.
        division: The lens as fitted.
        refit_error: What the refit lost, in px over the frame.
        uncertainty: In px over the frame; infinite `pred` where nothing could be fitted.
        accepted: Whether the lens should be used.
        reasons: Why not, in words; empty if accepted.
        counts: Segments ``given``, ``static`` (of the vehicle, left out), ``used`` and ``trusted``, and ``images``.
        trusted: For each image, the segments used; empty on an estimate read back from a dictionary.
        msac: Facts of the paper's own estimate, JSON-serialisable; ``None`` where nothing could be fitted.
    """

    brown: Brown
    division: Division
    refit_error: FieldError
    uncertainty: LensUncertainty
    accepted: bool
    reasons: tuple[str, ...]
    counts: Mapping[str, int]
    trusted: tuple[TrustedSegments, ...] = field(default=())
    msac: Mapping[str, Any] | None = None

    @property
    def width(self) -> int:
        """Image width in px."""
        return self.brown.width

    @property
    def height(self) -> int:
        """Image height in px."""
        return self.brown.height

    def undistort(self, points: ArrayLike) -> NDArray[np.float64]:
        """Map measured points ``(N, 2)`` in px to corrected ones by the Brown-Conrady lens, float64 ``(N, 2)``."""
        return self.brown.undistort(points)

    def as_dict(self) -> dict[str, Any]:
        """Return the estimate as JSON-serialisable fields, all numbers finite or null."""
        return {
            **brown_as_dict(self.brown),
            "accepted": self.accepted,
            "reasons": list(self.reasons),
            "uncertainty": {name: finite_or_none(value) for name, value in self.uncertainty._asdict().items()},
            "division": {"k": list(self.division.k), "center_offset": list(self.division.offset)},
            "refit_error": self.refit_error._asdict(),
            "counts": dict(self.counts),
            "msac": None if self.msac is None else dict(self.msac),
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> DistortionEstimate:
        """Return the estimate that `as_dict` gave the fields of, without the trusted segments.

        Raises:
            InvalidInput: If a field is missing or isn't what it should be.
        """
        if not isinstance(fields, Mapping):
            raise InvalidInput("no object of fields", where="distortion")
        brown = brown_from_dict(fields)
        division, uncertainty, refit = (
            mapping_from(fields, name) for name in ("division", "uncertainty", "refit_error")
        )
        k1, k2, k3 = numbers_from(division, "k", 3)
        cx, cy = numbers_from(division, "center_offset", 2)
        reasons, counts, msac = (fields.get(name) for name in ("reasons", "counts", "msac"))
        if not isinstance(fields.get("accepted"), bool):
            raise InvalidInput("missing", where="distortion.accepted", expected="true or false")
        return cls(
            brown=brown,
            division=Division(brown.width, brown.height, (k1, k2, k3), (cx, cy)),
            refit_error=FieldError(*(numbers_from(refit, name, 1)[0] for name in FieldError._fields)),
            uncertainty=LensUncertainty(
                *(numbers_from(uncertainty, name, 1, none=math.inf)[0] for name in LensUncertainty._fields)
            ),
            accepted=fields["accepted"],
            reasons=tuple(map(str, reasons)) if isinstance(reasons, list) else (),
            counts=dict(counts) if isinstance(counts, Mapping) else {},
            msac=dict(msac) if isinstance(msac, Mapping) else None,
        )


def estimate_distortion(
    segments_per_image: Sequence[Segments], size: tuple[int, int], *, seed: int = 0
) -> DistortionEstimate:
    """Estimate the lens that all given images share.

    Candidates may be raw: most of them may be no straight lines of the scene. Images without segments do no harm.
    A camera that can't be told gives a refused estimate, never an error.

    Args:
        segments_per_image: Segments in px, one entry for each image; those from 60 px of length on are used.
        size: Width and height of the images in px.
        seed: Of the random samples of MSAC; the estimate itself is deterministic.

    Raises:
        InvalidInput: If the size isn't positive.
    """
    width, height = (int(side) for side in size)
    if min(width, height) < 1:
        raise InvalidInput(f"image size {width} x {height}", where="size", expected="positive width and height")
    masks = [lens_mask(segments, width, height) for segments in segments_per_image]
    chosen = [np.flatnonzero(mask) for mask in masks]
    long = [segments.select(index) for segments, index in zip(segments_per_image, chosen, strict=True)]
    static = static_segments(long, width, height)
    chosen = [index[~mask] for index, mask in zip(chosen, static, strict=True)]
    moving = [segments.select(index) for segments, index in zip(segments_per_image, chosen, strict=True)]
    binned = most_informative(bin_segments(moving, width, height), len(moving))
    counts = {
        "images": len(segments_per_image),
        "given": sum(len(segments) for segments in segments_per_image),
        "static": int(sum(mask.sum() for mask in static)),
        "used": len(binned),
        "trusted": 0,
    }
    if len(binned) < FEWEST_SEGMENTS:
        return _without_fit(width, height, counts)
    fit = fit_lens(binned, width, height)
    uncertainty = lens_uncertainty(fit, width, height)
    division = Division.from_parameters(width, height, fit.parameters)
    refit = refit_brown(division, width, height, division.center)
    counts["trusted"] = int((fit.responsibility >= TRUSTED).sum())
    reasons = reasons_to_refuse(uncertainty, counts["trusted"])
    if not refit.brown.is_invertible():
        reasons.append("the Brown-Conrady refit folds within the frame")
    return DistortionEstimate(
        brown=refit.brown,
        division=division,
        refit_error=refit.error,
        uncertainty=uncertainty,
        accepted=not reasons,
        reasons=tuple(reasons),
        counts=counts,
        trusted=_trusted(binned, fit, chosen),
        msac=_msac_facts(msac_brown(binned, width, height, seed=seed), refit.brown),
    )


def _without_fit(width: int, height: int, counts: Mapping[str, int]) -> DistortionEstimate:
    number = counts["used"]
    return DistortionEstimate(
        brown=Brown.identity(width, height),
        division=Division(width, height),
        refit_error=FieldError(0.0, 0.0),
        uncertainty=LensUncertainty(math.inf, math.inf, 0.0),
        accepted=False,
        reasons=(f"not enough information: {number} usable segments, at least {FEWEST_SEGMENTS} are needed",),
        counts=counts,
        trusted=tuple(
            TrustedSegments(np.zeros(0, np.int64), np.zeros(0), np.zeros(0)) for _ in range(counts["images"])
        ),
    )


def _trusted(binned: BinnedSegments, fit: LensFit, chosen: Sequence[NDArray[np.int64]]) -> tuple[TrustedSegments, ...]:
    residual = np.sqrt(fit.bend.quadratic**2 + fit.bend.cubic**2 + binned.roughness**2)
    rows = [np.flatnonzero(binned.image == image) for image in range(len(chosen))]
    return tuple(
        TrustedSegments(index[binned.index[row]], fit.responsibility[row], residual[row])
        for index, row in zip(chosen, rows, strict=True)
    )


def _msac_facts(result: MsacResult, estimate: Brown) -> dict[str, Any]:
    difference = field_error(estimate, result.brown, estimate.width, estimate.height)
    return {
        **brown_as_dict(result.brown),
        "cost": result.cost,
        "inliers": int(result.inliers.sum()),
        "hypotheses": result.hypotheses,
        "difference": difference._asdict(),
    }
