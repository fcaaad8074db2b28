"""Verdicts are stored as decisions: append-only, all of a request or none, each exactly once.

A decision may come for a segment that a run has replaced while the page was open. It isn't lost: it goes over to the
segment's successor; where there is none, a kept or ambiguous segment is current again. What a hand has edited away
stays away until that edit is undone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Decision, Image, Review, Segment, SegmentState
from app.services.batches import in_batches
from app.services.candidates import refresh_counts
from app.services.carrying import STAYING_VERDICTS, carry_decision
from app.services.counts import VerdictCounts, verdict_counts
from app.services.decision_batch import (
    DecisionGiven,
    Wish,
    image_ledger,
    new_wishes,
    require_known_groups,
    segments_named,
)
from app.services.edit_replays import edited_away, replay_edits
from app.services.images import get_image
from app.services.stale_verdicts import OtherVerdict, last_decision_id, require_fresh, verdicts_of_others
from app.services.successors import successors_of


@dataclass(frozen=True)
class DecisionsStored:
    """What became of a request.

    Attributes:
        stored: Decisions that are new.
        repeated: Decisions that were known by their client id.
        verdicts: The image's current segments by verdict.
        status: The image's review.
        last_decision_id: Of the image; whoever knows ``others`` has seen everything up to it.
        others: Verdicts that other people gave since what the client had seen, and that stand.
    """

    stored: int
    repeated: int
    verdicts: VerdictCounts
    status: str
    last_decision_id: int = 0
    others: tuple[OtherVerdict, ...] = ()


def decide(
    session: Session,
    image_id: int,
    decisions: Sequence[DecisionGiven],
    person: str | None,
    now: datetime,
    *,
    seen: int | None = None,
) -> DecisionsStored:
    """Store decisions on segments of one image; all of them or none.

    Sending a decision again changes nothing. A verdict taken back on an image that is done opens it again.

    Args:
        session: A writing session.
        image_id: The image.
        decisions: 1 to 5,000, oldest first.
        person: Who decides.
        now: Time of the request.
        seen: Id of the image's last decision that the person knew; later ones of others aren't overruled silently.

    Raises:
        NotFound: When there is no such image, or it is deleted.
        InvalidInput: On a segment of another image, an unknown verdict or kind, an undo of what wasn't done.
        Conflict: When a client id is known with another content.
        StaleVerdict: When someone else decided differently after ``seen``.
        StaleEdit: When an edit can't be undone or redone any more, as another one builds on it.
        TooLarge: On more than 5,000 decisions.
    """
    get_image(session, image_id)
    image = session.get_one(Image, image_id, with_for_update=True, populate_existing=True)
    ledger = image_ledger(image.id)
    wishes = new_wishes(session, ledger, decisions)
    segments = segments_named(session, image.id, wishes)
    require_known_groups(session, ledger, wishes)
    successors = successors_of(session, segments)
    if seen is not None:
        require_fresh(session, image.id, wishes, successors, seen, person)
    rows = _with_carried(session, image, segments, successors, wishes, person, now)
    session.add_all(rows)
    session.flush()
    _write_states(session, rows)
    replay_edits(session, image, wishes, now)
    refresh_counts(session, [image.id])
    review = session.get(Review, image.id) or Review(image_id=image.id, status="open", updated_at=now)
    session.add(review)
    verdicts = verdict_counts(image.n_candidates, image.n_keep, image.n_reject, image.n_ambiguous)
    if review.status == "done" and verdicts.undecided and any(row.verdict == "undecided" for row in rows):
        review.status = "open"
        review.updated_at = now
    return DecisionsStored(
        len(wishes),
        len(decisions) - len(wishes),
        verdicts,
        review.status,
        last_decision_id(session, image.id),
        () if seen is None else tuple(verdicts_of_others(session, image.id, seen, person)),
    )


def _with_carried(
    session: Session,
    image: Image,
    segments: Mapping[int, Segment],
    successors: Mapping[int, Segment],
    wishes: Sequence[Wish],
    person: str | None,
    now: datetime,
) -> list[Decision]:
    """Return the decisions to store, in order, those for replaced segments followed by their carrying."""
    verdicts = _verdicts(session, {*segments, *(segment.id for segment in successors.values())})
    away = edited_away(session, image.id) if any(segment.retired_at for segment in segments.values()) else set()
    rows: list[Decision] = []
    for wish in wishes:
        rows.append(_decision(image.id, wish, verdicts.get(wish.segment_id, "undecided"), person, now))
        verdicts[wish.segment_id] = wish.verdict
        segment = segments[wish.segment_id]
        successor = successors.get(segment.id)
        if successor is not None:
            rows.append(
                carry_decision(
                    image_id=image.id,
                    old_id=segment.id,
                    new_id=successor.id,
                    verdict=wish.verdict,
                    reason=wish.reason,
                    previous=verdicts.get(successor.id, "undecided"),
                    person=person,
                    cause=f"late/{wish.client_id}",
                    now=now,
                )
            )
            verdicts[successor.id] = wish.verdict
            segment = successor
        if segment.retired_at is not None and segment.id not in away and wish.verdict in STAYING_VERDICTS:
            segment.retired_at = None
            image.revision += 1
    return rows


def _verdicts(session: Session, segment_ids: set[int]) -> dict[int, str]:
    verdicts: dict[int, str] = {}
    for batch in in_batches(sorted(segment_ids)):
        query = select(SegmentState.segment_id, SegmentState.verdict).where(SegmentState.segment_id.in_(batch))
        verdicts.update(session.execute(query).all())
    return verdicts


def _write_states(session: Session, rows: Sequence[Decision]) -> None:
    latest = {row.segment_id: row for row in rows}
    known: dict[int, SegmentState] = {}
    for batch in in_batches(sorted(latest)):
        states = session.scalars(select(SegmentState).where(SegmentState.segment_id.in_(batch)))
        known.update({state.segment_id: state for state in states})
    for segment_id, row in latest.items():
        state = known.get(segment_id)
        if state is None:
            session.add(SegmentState(segment_id=segment_id, verdict=row.verdict, reason=row.reason, decision_id=row.id))
        else:
            state.verdict = row.verdict
            state.reason = row.reason
            state.decision_id = row.id


def _decision(image_id: int, wish: Wish, previous: str, person: str | None, now: datetime) -> Decision:
    return Decision(
        image_id=image_id,
        segment_id=wish.segment_id,
        person=person,
        verdict=wish.verdict,
        previous=previous,
        kind=wish.kind,
        client_id=wish.client_id,
        group_id=wish.group_id,
        target_group_id=wish.target_group_id,
        elapsed_ms=wish.elapsed_ms,
        reason=wish.reason,
        suggestion=wish.suggestion,
        created_at=now,
    )
