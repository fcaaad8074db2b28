"""Candidates of an image as the label page reads them, and the history of what was decided on them."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import ORIGINS, Decision, Segment, SegmentState
from app.services.candidates import current_segments, verdict_of_segment
from app.services.deciding import DecisionsStored, decide
from app.services.decision_batch import DecisionGiven
from app.services.images import get_image
from app.services.stale_verdicts import last_decision_id

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


class SegmentEntry(NamedTuple):
    """A current segment without its points; a tuple, for there are thousands and somebody waits.

    Attributes:
        ordinal: Its place among the segments of its origin and run.
        length: Arc length, px.
        residual: RMS deviation from straight under the lens, px; ``None`` before the lens is known.
        score: Evidence for an edge, in [0, 1].
        straightness: Probability of being straight under the lens, in [0, 1].
        straight: Whether it passes the straightness filter; nothing is held against what isn't judged yet.
        reason: Why it was rejected, where that was said.
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
    reason: str | None
    origin: str
    box: tuple[float, float, float, float]


@dataclass(frozen=True)
class ImageSegments:
    """The current segments of an image.

    Attributes:
        revision: Rises whenever the set of segments, or what is known of them, changes other than by a decision.
        last_decision_id: The image's last decision that these verdicts follow; 0 without any.
    """

    image_id: int
    revision: int
    last_decision_id: int
    width: int
    height: int
    segments: tuple[SegmentEntry, ...]


def segments_of_image(session: Session, image_id: int) -> ImageSegments:
    """Return an image's current segments in their stable order, without points.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    image = get_image(session, image_id)
    last = last_decision_id(session, image_id)
    rows = (
        session.connection()
        .execute(
            current_segments(
                Segment.id,
                Segment.ordinal,
                Segment.n_points,
                Segment.length,
                Segment.residual,
                Segment.score,
                Segment.straightness,
                verdict_of_segment(),
                SegmentState.reason,
                Segment.origin,
                Segment.x0,
                Segment.y0,
                Segment.x1,
                Segment.y1,
            ).where(Segment.image_id == image_id)
        )
        .all()
    )
    segments = tuple(
        SegmentEntry._make((*row[:7], row[6] is None or row[6] >= STRAIGHT, *row[7:10], row[10:]))
        for row in map(tuple, rows)
    )
    return ImageSegments(image.id, image.revision, last, image.width, image.height, segments)


def points_of_image(session: Session, image_id: int) -> bytes:
    """Return the points of an image's current segments, in the order of ``segments_of_image``.

    Little endian: ``CLP1``, then uint32 revision, S and N, S uint32 segment ids, S + 1 uint32 offsets, N pairs of
    float32 x, y in px.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    image = get_image(session, image_id)
    # sorted here: a database would carry all points through its own sorting
    rows = sorted(
        session.connection()
        .execute(
            current_segments(Segment.origin, Segment.ordinal, Segment.id, Segment.n_points, Segment.points)
            .where(Segment.image_id == image_id)
            .order_by(None)
        )
        .all(),
        key=lambda row: (ORIGINS.index(row[0]), row[1], row[2]),
    )
    counts = np.array([row[3] for row in rows], dtype="<u4")
    offsets = np.concatenate([np.zeros(1, "<u4"), np.cumsum(counts, dtype="<u4")])
    ids = np.array([row[2] for row in rows], dtype="<u4")
    header = struct.pack("<4sIII", POINTS_MAGIC, image.revision, len(rows), int(offsets[-1]))
    return b"".join([header, ids.tobytes(), offsets.astype("<u4").tobytes(), *(row[4] for row in rows)])


def history(session: Session, image_id: int) -> Sequence[Decision]:
    """Return all decisions on an image's segments, oldest first, those on retired segments too.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    get_image(session, image_id)
    return session.scalars(select(Decision).where(Decision.image_id == image_id).order_by(Decision.id)).all()
