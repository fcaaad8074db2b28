"""Adjudication: where two people differ a third look decides, by a normal decision that can be undone."""

from __future__ import annotations

from datetime import datetime
from uuid import NAMESPACE_URL, UUID, uuid5

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Adjudication, Dataset, Decision, Image, SecondReview, SegmentState
from app.errors import Conflict, InvalidInput, NotFound
from app.services.deciding import decide
from app.services.decision_batch import Wish
from app.services.differences import Difference, difference_on
from app.services.events import record_event
from app.services.images import dataset_of, get_image
from app.services.verdict_pairs import JUDGED


def adjudicate(
    session: Session,
    second_review_id: int,
    segment_id: int,
    verdict: str,
    client_id: UUID | str,
    person: str | None,
    now: datetime,
) -> Difference:
    """Decide between two verdicts; a second time decides anew, sending it again changes nothing.

    Args:
        session: A writing session.
        second_review_id: The second review, which is done.
        segment_id: A candidate on which it differs from the first.
        verdict: ``keep``, ``reject`` or ``ambiguous``; also one that neither of them gave.
        client_id: Made by the client; that of the decision, too.
        person: Who decides.
        now: When.

    Raises:
        NotFound: When there is no such second review, or its image is deleted.
        InvalidInput: On a verdict that can't be, or a candidate of another image.
        Conflict: When the two don't differ there, or the client id is known with another content.
    """
    if verdict not in JUDGED:
        raise InvalidInput(f"{verdict!r:.60} decides nothing", where="verdict", expected=", ".join(JUDGED))
    image, dataset = _place(session, second_review_id)
    before = _difference(session, dataset, second_review_id, segment_id)
    wish = Wish(str(client_id), str(client_id), segment_id, verdict)
    earlier = session.get(Adjudication, (second_review_id, segment_id))
    if earlier is not None and session.scalar(select(Decision.id).where(Decision.client_id == wish.client_id)) is None:
        _undo(session, image, earlier, person, now)  # so that what is taken back later is all that was adjudicated
    if decide(session, image.id, [wish], person, now).stored:
        decision_id = session.scalars(select(Decision.id).where(Decision.client_id == wish.client_id)).one()
        row = earlier or Adjudication(
            second_review_id=second_review_id,
            segment_id=segment_id,
            first=before.first.verdict,
            second=before.second.verdict,
        )
        row.verdict, row.decision_id, row.person, row.created_at = verdict, decision_id, person, now
        session.add(row)
        details = {"image": image.id, "segment": segment_id, "verdict": verdict}
        record_event(session, "segment.adjudicated", now, dataset_id=dataset.id, person=person, details=details)
        session.flush()
    return _difference(session, dataset, second_review_id, segment_id)


def take_back(
    session: Session, second_review_id: int, segment_id: int, person: str | None, now: datetime
) -> Difference:
    """Undo an adjudication: the candidate has the verdict again that it had before.

    A verdict that somebody gave after the adjudication stays.

    Raises:
        NotFound: When there is no such second review, its image is deleted, or nobody adjudicated there.
    """
    image, dataset = _place(session, second_review_id)
    row = session.get(Adjudication, (second_review_id, segment_id))
    if row is None:
        raise NotFound(f"nobody has decided on segment {segment_id}", where=image.name)
    _undo(session, image, row, person, now)
    session.delete(row)
    details = {"image": image.id, "segment": segment_id, "verdict": row.verdict}
    record_event(session, "segment.adjudication-undone", now, dataset_id=dataset.id, person=person, details=details)
    session.flush()
    return _difference(session, dataset, second_review_id, segment_id)


def _undo(session: Session, image: Image, row: Adjudication, person: str | None, now: datetime) -> None:
    """Bring back verdict and reason from before an adjudication, unless somebody has decided since."""
    decision = session.get_one(Decision, row.decision_id)
    state = session.get(SegmentState, row.segment_id)
    if state is None or state.decision_id != decision.id:
        return
    earlier = select(Decision.reason).where(Decision.segment_id == row.segment_id, Decision.id < decision.id)
    reason = session.scalar(earlier.order_by(Decision.id.desc()).limit(1))
    back = str(uuid5(NAMESPACE_URL, f"adjudication/undo/{decision.client_id}"))
    wish = Wish(back, back, row.segment_id, decision.previous, "undo", decision.group_id, reason=reason)
    decide(session, image.id, [wish], person, now)


def _place(session: Session, second_review_id: int) -> tuple[Image, Dataset]:
    review = session.get(SecondReview, second_review_id)
    if review is None:
        raise NotFound(f"there is no second review {second_review_id}")
    get_image(session, review.image_id)
    image = session.get_one(Image, review.image_id, with_for_update=True)
    return image, dataset_of(session, image)


def _difference(session: Session, dataset: Dataset, second_review_id: int, segment_id: int) -> Difference:
    found = difference_on(session, dataset, second_review_id, segment_id)
    if found is None:
        raise Conflict(
            f"there is nothing to decide on segment {segment_id}",
            expected="a candidate on which a second review that is done differs from the first",
        )
    return found
