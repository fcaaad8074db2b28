"""A finished detection goes into the database whole: candidates, carried verdicts and the image's new state."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy.orm import Session

from app.db.models import Image, Review, Segment
from app.services.candidates import refresh_counts
from app.services.carrying import POINT, Matching, carry_verdicts, match_to_current
from app.services.run_queue import Claim, claimed_row
from app.vision.segments import Segments


@dataclass(frozen=True, eq=False)
class FoundCandidates:
    """What the pipeline found in one image.

    Attributes:
        segments: S candidates with scores, px.
        lens_segments: npz bytes of the segments that the joint estimate will read; ``None`` without one.
        milliseconds: Time that the detection took.
        straightness: float32 ``(S,)`` in [0, 1], where the lens is known already.
        residuals: float32 ``(S,)``, RMS deviation from straight under that lens, px.
        distortion: That lens, estimated from this image alone.
    """

    segments: Segments
    lens_segments: bytes | None
    milliseconds: float
    straightness: NDArray[np.float32] | None = None
    residuals: NDArray[np.float32] | None = None
    distortion: dict[str, Any] | None = None


def store_detection(
    session: Session, claim: Claim, found: FoundCandidates, now: datetime, *, matching: Matching | None = None
) -> bool:
    """Store what a run found in an image, in the caller's one transaction.

    Args:
        session: A writing session.
        claim: The work it is the result of.
        found: The result.
        now: Time of the change.
        matching: Made beforehand with ``match_to_current``; made here if left out or the image changed since.

    Returns:
        False, with nothing changed, when the claim doesn't hold any more.
    """
    image = session.get(Image, claim.image_id, with_for_update=True)
    row = claimed_row(session, claim)
    if image is None or row is None:
        return False
    if matching is None or matching.revision != image.revision:
        matching = match_to_current(session, image, found.segments)
    covered = {int(index) for index in matching.already_there}
    new = {index: segment for index, segment in enumerate(_rows(claim, found)) if index not in covered}
    session.add_all(new.values())
    session.flush()
    carried = carry_verdicts(session, image, row.id, new, matching, now)

    undecided = len(new) - carried.carried
    review = session.get(Review, image.id) or Review(image_id=image.id, status="open", updated_at=now)
    session.add(review)
    reopened = review.status == "done" and undecided > 0
    if reopened:
        review.status = "open"
        review.updated_at = now
    image.revision += 1
    image.current_run_image_id = row.id
    row.status = "done"
    row.error = None
    row.heartbeat_at = now
    row.milliseconds = found.milliseconds
    row.lens_segments = found.lens_segments
    row.distortion = found.distortion
    row.camera_estimate_id = None
    row.changes = {
        "candidates": len(new),
        "carried": carried.carried,
        "kept_unmatched": carried.kept_unmatched,
        "already_there": len(covered),
        "retired": carried.retired,
        "reopened": reopened,
    }
    refresh_counts(session, [image.id])
    return True


def _rows(claim: Claim, found: FoundCandidates) -> list[Segment]:
    segments = found.segments
    columns = zip(
        segments,
        segments.boxes().tolist(),
        segments.lengths().tolist(),
        _values(segments.scores, len(segments)),
        _values(found.straightness, len(segments)),
        _values(found.residuals, len(segments)),
        strict=True,
    )
    return [
        Segment(
            image_id=claim.image_id,
            run_image_id=claim.run_image_id,
            ordinal=ordinal,
            n_points=len(polyline),
            points=polyline.astype(POINT).tobytes(),
            x0=box[0],
            y0=box[1],
            x1=box[2],
            y1=box[3],
            length=length,
            score=score,
            straightness=straightness,
            residual=residual,
            origin="pipeline",
        )
        for ordinal, (polyline, box, length, score, straightness, residual) in enumerate(columns)
    ]


def _values(values: NDArray[np.float32] | None, number: int) -> list[float | None]:
    return [None] * number if values is None else values.tolist()
