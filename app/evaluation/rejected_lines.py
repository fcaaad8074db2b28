"""Lines that people rejected, with the reason: which of a detector's false positives are cars, shadows and so on.

Labels say what is right; a candidate that was rejected says of what kind a wrong line is. It changes no score: a
prediction that isn't a label is a false positive, whether anybody has looked at it before or not.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import ClearLinesError, InvalidFile, InvalidSegments
from app.evaluation.bootstrap import estimates
from app.evaluation.matching import match_segments
from app.verdicts import REASONS
from app.vision.segments import Segments

REASON = "reason"
"""The kind of these strata, beside those of `app.evaluation.strata`."""

NO_REASON = -1
"""Instead of a place in ``REASONS``: no candidate that was rejected with one."""

_UNREADABLE = (ClearLinesError, ValueError, TypeError, KeyError, OSError, EOFError, zipfile.BadZipFile, zlib.error)


@dataclass(frozen=True, eq=False)
class RejectedLines:
    """Candidates of one image that people rejected with a reason.

    Attributes:
        segments: R candidates, px.
        reasons: int8 ``(R,)``, places in ``REASONS``.

    Raises:
        InvalidSegments: When there isn't one reason for each.
    """

    segments: Segments
    reasons: NDArray[np.int8]

    def __post_init__(self) -> None:
        reasons = np.asarray(self.reasons, np.int8)
        if reasons.shape != (len(self.segments),) or ((reasons < 0) | (reasons >= len(REASONS))).any():
            raise InvalidSegments(
                f"the reasons have shape {reasons.shape}",
                where="reasons",
                expected=f"({len(self.segments)},), places among the {len(REASONS)} reasons",
            )
        object.__setattr__(self, "reasons", reasons)

    def of_least(self, length: float) -> RejectedLines:
        """Return those of at least an arc length, px: where shorter lines don't count, nobody can fall for one."""
        kept = np.flatnonzero(self.segments.lengths() >= length)
        return RejectedLines(self.segments.select(kept), self.reasons[kept])

    def as_npz(self) -> bytes:
        """Return them as a compressed npz file without pickled content."""
        file = io.BytesIO()
        np.savez_compressed(file, points=self.segments.points, offsets=self.segments.offsets, reasons=self.reasons)
        return file.getvalue()

    @classmethod
    def from_npz(cls, data: bytes) -> RejectedLines:
        """Read what ``as_npz`` wrote; nothing is unpickled.

        Raises:
            InvalidFile: When it is something else.
        """
        try:
            with np.load(io.BytesIO(data), allow_pickle=False) as file:
                return cls(Segments(file["points"], file["offsets"], None), file["reasons"])
        except _UNREADABLE as error:
            raise InvalidFile("rejected lines can't be read", expected="npz as it was written") from error


def no_reasons() -> NDArray[np.float64]:
    """Return the tallies of an image of which no such candidates are known."""
    return np.zeros((len(REASONS), 2))


def reasons_of(rejected: RejectedLines | None, wrong: Segments) -> NDArray[np.int8]:
    """Say which false positives are candidates that people rejected, and why.

    Args:
        rejected: Those of the image, if any are known.
        wrong: The image's F false positives under clearlines-v2, px.

    Returns:
        int8 ``(F,)``: the place in ``REASONS`` of the candidate that a false positive matches one-to-one with a line
        IoU of at least 0.5, or ``NO_REASON``.
    """
    found = np.full(len(wrong), NO_REASON, np.int8)
    if rejected is not None:
        matches = match_segments(wrong, rejected.segments)
        found[matches.row] = rejected.reasons[matches.column]
    return found


def reason_tallies(rejected: RejectedLines | None, found: NDArray[np.int8]) -> NDArray[np.float64]:
    """Count false positives and candidates by reason.

    Args:
        rejected: The image's candidates, if any are known.
        found: What `reasons_of` returned for its false positives.

    Returns:
        float64 ``(5, 2)``, by place in ``REASONS``: false positives, and candidates; additive over images.
    """
    if rejected is None:
        return no_reasons()
    counts = [np.bincount(each, minlength=len(REASONS)) for each in (found[found != NO_REASON], rejected.reasons)]
    return np.stack(counts, axis=1).astype(np.float64)


def reason_strata(
    tallies: NDArray[np.float64], clusters: NDArray[np.int64], draws: int, seed: int
) -> list[dict[str, Any]]:
    """Return the strata of the kind ``reason``, those of which there are candidates.

    Args:
        tallies: float64 ``(I, 5, 2)``, what `reason_tallies` returned for each image.
        clusters: int64 ``(I,)``, the cluster of each image.
        draws: Of the bootstrap.
        seed: Of the draws.

    Returns:
        For JSON: ``name``, ``tp`` and ``fn`` (always 0: no label is rejected), ``fp``, ``candidates``, how many there
        were to fall for, and ``share``, how many of them the detector fell for, with its interval.
    """
    counts = tallies.sum(axis=0)

    def shares(weights: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        wrong, candidates = np.moveaxis(np.tensordot(weights, tallies, axes=1), -1, 0)
        share = np.divide(wrong, candidates, out=np.full(wrong.shape, np.nan), where=candidates > 0)
        return dict(zip(REASONS, share.T, strict=True))

    if not counts.any():
        return []
    found = estimates(shares, clusters, draws, seed=seed)
    return [
        {
            "name": name,
            "tp": 0,
            "fp": int(wrong),
            "fn": 0,
            "candidates": int(candidates),
            "share": found[name].as_dict(),
        }
        for name, (wrong, candidates) in zip(REASONS, counts.tolist(), strict=True)
        if candidates
    ]


def reason_name(place: int) -> str | None:
    """Return a reason in one word; ``None`` where there is none."""
    return None if place == NO_REASON else REASONS[place]
