"""Verdicts that were given without knowing another person's are refused, with both told.

What a client knew is one number: the id of the image's last decision when it last looked. Whoever of the others decided
later, differently, and isn't overruled yet, is in the way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import Decision, Segment, SegmentState
from app.errors import Conflict
from app.services.decision_batch import Wish


class StaleVerdict(Conflict):
    """Somebody else decided on the same segments meanwhile."""

    code = "stale-verdict"


@dataclass(frozen=True)
class OtherVerdict:
    """A segment's verdict that another person gave.

    Attributes:
        segment_id: The segment.
        verdict: What it is by now.
        reason: Why it was rejected, where that was said.
        person: Who gave it.
        created_at: When.
        decision_id: The decision.
    """

    segment_id: int
    verdict: str
    reason: str | None
    person: str | None
    created_at: datetime
    decision_id: int


def last_decision_id(session: Session, image_id: int) -> int:
    """Return the id of an image's last decision; 0 without any."""
    return session.scalar(select(func.max(Decision.id)).where(Decision.image_id == image_id)) or 0


def verdicts_of_others(session: Session, image_id: int, seen: int, person: str | None) -> list[OtherVerdict]:
    """Return the verdicts of an image that other people gave after a decision and that still stand, oldest first.

    Args:
        session: Any session.
        image_id: The image.
        seen: Id of the last decision that is known.
        person: Who isn't one of the others.
    """
    rows = session.execute(
        select(Decision)
        .join(SegmentState, SegmentState.decision_id == Decision.id)
        .where(
            Decision.image_id == image_id,
            Decision.id > seen,
            Decision.person.is_distinct_from(person),
        )
        .order_by(Decision.id)
    ).scalars()
    return [OtherVerdict(row.segment_id, row.verdict, row.reason, row.person, row.created_at, row.id) for row in rows]


def require_fresh(
    session: Session,
    image_id: int,
    wishes: Sequence[Wish],
    successors: Mapping[int, Segment],
    seen: int,
    person: str | None,
    *,
    where: str = "decisions",
) -> None:
    """Refuse verdicts that would silently overrule another person's.

    Args:
        session: Any session.
        image_id: The image.
        wishes: What is to be stored.
        successors: Of segments that a run replaced: the segment that the verdict goes over to.
        seen: Id of the image's last decision that the person knew.
        person: Who decides.
        where: The field of the request that the wishes come from.

    Raises:
        StaleVerdict: With yours and theirs for each wish that is in conflict.
    """
    others = {other.segment_id: other for other in verdicts_of_others(session, image_id, seen, person)}
    conflicts: list[dict[str, Any]] = []
    for wish in wishes:
        successor = successors.get(wish.segment_id)
        theirs = others.get(wish.segment_id if successor is None else successor.id) or others.get(wish.segment_id)
        if theirs is not None and theirs.verdict != wish.verdict:
            conflicts.append(_conflict(wish, theirs))
    if conflicts:
        people = sorted({conflict["theirs"]["person"] or "someone else" for conflict in conflicts})
        segments = len({conflict["segment_id"] for conflict in conflicts})
        raise StaleVerdict(
            f"{', '.join(people[:3])} decided on {'the same segment' if segments == 1 else f'{segments} of these'} "
            "meanwhile",
            where=where,
            hint="look at both verdicts, then send yours again with the decision that you have seen",
            details={"conflicts": conflicts},
        )


def _conflict(wish: Wish, theirs: OtherVerdict) -> dict[str, Any]:
    return {
        "client_id": wish.client_id,
        "segment_id": wish.segment_id,
        "yours": wish.verdict,
        "theirs": {
            "verdict": theirs.verdict,
            "person": theirs.person,
            "created_at": theirs.created_at.isoformat().replace("+00:00", "Z"),
            "decision_id": theirs.decision_id,
        },
    }
