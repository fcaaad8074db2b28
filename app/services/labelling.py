"""Candidates of an image as the label page reads them, and the history of what was decided on them."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Decision, Segment
from app.services.candidates import current_segments, verdict_of_segment
from app.services.deciding import DecisionsStored, decide
from app.services.decision_batch import DecisionGiven
from app.services.images import get_image

STRAIGHT = 0.5
"""From this straightness on a candidate passes the filter."""

POINTS_MAGIC = b"CLP1"

__all__ = [
    "DecisionGiven",
    "DecisionsStored",
    "ImageSegments",
    "SegmentEntry",
    "decide",
    "history",
    "points_of_image",
    "segments_of_image",
]


@dataclass(frozen=True)
class SegmentEntry:
    """A current segment without its points.

    Attributes:
        ordinal: Its place among the segments of its origin and run.
        length: Arc length, px.
        residual: RMS deviation from straight under the lens, px; ``None`` before the lens is known.
        score: Evidence for an edge, in [0, 1].
        straightness: Probability of being straight under the lens, in [0, 1].
        straight: Whether it passes the straightness filter; nothing is held against what isn't judged yet.
        box: x0, y0, x1, y1 in px.
    """

    id: int
    ordinal: int
    n_points: int
    length: float
    residual: float | None
    score: float | None
    straightness: float | None
    straight: bool
    verdict: str
    origin: str
    box: tuple[float, float, float, float]


@dataclass(frozen=True)
class ImageSegments:
    """The current segments of an image.

    Attributes:
        revision: Rises whenever the set of segments, or what is known of them, changes other than by a decision.
    """

    image_id: int
    revision: int
    width: int
    height: int
    segments: tuple[SegmentEntry, ...]


def segments_of_image(session: Session, image_id: int) -> ImageSegments:
    """Return an image's current segments in their stable order, without points.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    image = get_image(session, image_id)
    rows = session.execute(
        current_segments(
            Segment.id,
            Segment.ordinal,
            Segment.n_points,
            Segment.length,
            Segment.residual,
            Segment.score,
            Segment.straightness,
            verdict_of_segment().label("verdict"),
            Segment.origin,
            Segment.x0,
            Segment.y0,
            Segment.x1,
            Segment.y1,
        ).where(Segment.image_id == image_id)
    )
    segments = tuple(
        SegmentEntry(
            id=row.id,
            ordinal=row.ordinal,
            n_points=row.n_points,
            length=row.length,
            residual=row.residual,
            score=row.score,
            straightness=row.straightness,
            straight=row.straightness is None or row.straightness >= STRAIGHT,
            verdict=row.verdict,
            origin=row.origin,
            box=(row.x0, row.y0, row.x1, row.y1),
        )
        for row in rows
    )
    return ImageSegments(image.id, image.revision, image.width, image.height, segments)


def points_of_image(session: Session, image_id: int) -> bytes:
    """Return the points of an image's current segments, in the order of ``segments_of_image``.

    Little endian: ``CLP1``, then uint32 revision, S and N, S uint32 segment ids, S + 1 uint32 offsets, N pairs of
    float32 x, y in px.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    image = get_image(session, image_id)
    rows = session.execute(
        current_segments(Segment.id, Segment.n_points, Segment.points).where(Segment.image_id == image_id)
    ).all()
    counts = np.array([row.n_points for row in rows], dtype="<u4")
    offsets = np.concatenate([np.zeros(1, "<u4"), np.cumsum(counts, dtype="<u4")])
    ids = np.array([row.id for row in rows], dtype="<u4")
    header = struct.pack("<4sIII", POINTS_MAGIC, image.revision, len(rows), int(offsets[-1]))
    return b"".join([header, ids.tobytes(), offsets.astype("<u4").tobytes(), *(row.points for row in rows)])


def history(session: Session, image_id: int) -> Sequence[Decision]:
    """Return all decisions on an image's segments, oldest first, those on retired segments too.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    get_image(session, image_id)
    return session.scalars(select(Decision).where(Decision.image_id == image_id).order_by(Decision.id)).all()
