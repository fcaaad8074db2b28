"""Verdicts go over to a new run's candidates, so that no decision is ever orphaned.

An image's current segments are matched one-to-one to the new candidates (line IoU). A verdict is carried to its match.
Kept and ambiguous segments that the new run didn't find again stay current; undecided and rejected ones are retired.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from uuid import NAMESPACE_URL, uuid5

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import or_, select, update
from sqlalchemy.orm import Session

from app.db.models import Decision, Edit, Image, Segment, SegmentState
from app.evaluation.matching import match_segments
from app.services.candidates import is_current, verdict_of_segment
from app.vision.segments import Segments

STAYING_VERDICTS = ("keep", "ambiguous")
POINT = np.dtype("<f4")


@dataclass(frozen=True)
class Matching:
    """How an image's current segments and a new detection's candidates correspond.

    Attributes:
        revision: The image's revision that the segments were read at.
        already_there: int64 ``(A,)``, candidates that an imported or hand-drawn segment covers, or that a hand edited.
        successors: For ids of current pipeline segments, the candidate that each goes over to.
    """

    revision: int
    already_there: NDArray[np.int64]
    successors: dict[int, int]


@dataclass(frozen=True)
class Carried:
    """What carrying did to an image's older segments and decisions."""

    carried: int
    kept_unmatched: int
    retired: int


def stored_polyline(points: bytes) -> NDArray[np.float32]:
    """Return a stored segment's points, float32 ``(n, 2)`` in px."""
    return np.frombuffer(points, POINT).reshape(-1, 2)


def match_to_current(session: Session, image: Image, candidates: Segments) -> Matching:
    """Match an image's current segments to new candidates.

    It takes time and needs no lock: done in a reading session, before the result is stored.

    Args:
        session: Any session.
        image: The image as this session sees it.
        candidates: S new candidates, px.
    """
    # what a hand has shaped isn't proposed anew as it was; should the edit be undone, it is back by itself
    edits = session.scalars(select(Edit.replaced).where(Edit.image_id == image.id, Edit.undone_at.is_(None)))
    edited = {key for replaced in edits for key in replaced}
    rows = session.execute(
        select(Segment.id, Segment.origin, Segment.points)
        .where(Segment.image_id == image.id, or_(is_current(), Segment.id.in_(edited)))
        .order_by(Segment.id)
    ).all()
    older = [row for row in rows if row.origin == "pipeline" and row.id not in edited]
    fixed = [row for row in rows if row.origin != "pipeline" or row.id in edited]
    already_there = match_segments(_polylines([row.points for row in fixed]), candidates).column
    left = np.setdiff1d(np.arange(len(candidates), dtype=np.int64), already_there)
    matches = match_segments(_polylines([row.points for row in older]), candidates.select(left))
    successors = {older[row].id: int(left[column]) for row, column in zip(matches.row, matches.column, strict=True)}
    return Matching(image.revision, already_there, successors)


def carry_verdicts(
    session: Session, image: Image, run_image_id: int, new: dict[int, Segment], matching: Matching, now: datetime
) -> Carried:
    """Carry verdicts to new candidates and retire what they replace.

    Args:
        session: A writing session that holds the image's row.
        image: The image.
        run_image_id: The work that found the new candidates.
        new: Their stored rows, by their index in the detection.
        matching: Of the image's present revision.
        now: Time of the change.
    """
    rows = session.execute(
        select(Segment.id, verdict_of_segment(), SegmentState.reason, Decision.person, is_current())
        .outerjoin(SegmentState, SegmentState.segment_id == Segment.id)
        .outerjoin(Decision, Decision.id == SegmentState.decision_id)
        .where(
            Segment.image_id == image.id,
            Segment.origin == "pipeline",
            Segment.retired_at.is_(None),
            Segment.run_image_id.is_distinct_from(run_image_id),
        )
        .order_by(Segment.id)
    ).all()
    carried: list[Decision] = []
    retired: list[dict[str, object]] = []
    kept_unmatched = replaced = 0
    for segment_id, verdict, reason, person, current in rows:
        successor = new.get(matching.successors.get(segment_id, -1))
        if successor is None and verdict in STAYING_VERDICTS:
            kept_unmatched += 1
            continue
        successor_id = None if successor is None else successor.id
        retired.append({"id": segment_id, "retired_at": now, "replaced_by_id": successor_id})
        replaced += bool(current)
        if successor is not None and verdict != "undecided":
            carried.append(
                carry_decision(
                    image_id=image.id,
                    old_id=segment_id,
                    new_id=successor.id,
                    verdict=verdict,
                    reason=reason,
                    previous="undecided",
                    person=person,
                    cause=f"run-image/{run_image_id}",
                    now=now,
                )
            )
    if retired:
        session.execute(update(Segment), retired)
    session.add_all(carried)
    session.flush()
    session.add_all(
        SegmentState(
            segment_id=decision.segment_id,
            verdict=decision.verdict,
            reason=decision.reason,
            decision_id=decision.id,
        )
        for decision in carried
    )
    return Carried(len(carried), kept_unmatched, replaced)


def carry_decision(
    *,
    image_id: int,
    old_id: int,
    new_id: int,
    verdict: str,
    reason: str | None,
    previous: str,
    person: str | None,
    cause: str,
    now: datetime,
) -> Decision:
    """Return the decision that repeats a verdict on the segment that replaced its own.

    Its ids follow from what is carried and why, so the same carrying can't be stored twice.
    """
    return Decision(
        image_id=image_id,
        segment_id=new_id,
        person=person,
        verdict=verdict,
        reason=reason,
        previous=previous,
        kind="carry",
        client_id=str(uuid5(NAMESPACE_URL, f"carry/{cause}/{old_id}/{new_id}")),
        group_id=str(uuid5(NAMESPACE_URL, f"carry/{cause}/{image_id}")),
        created_at=now,
    )


def _polylines(stored: Sequence[bytes]) -> Segments:
    return Segments.from_list([stored_polyline(points) for points in stored])
