"""Send false positives of an open split to the people who label: perhaps the label is what is missing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Image, Segment
from app.errors import Conflict, InvalidInput, NotFound
from app.evaluation.outcome import Outcome
from app.formats.labelled import LabelledSegments
from app.services.access import Viewer
from app.services.candidates import current_segments, refresh_counts
from app.services.events import record_event
from app.services.images import dataset_of, get_image
from app.services.labels import POINT, segment_rows
from app.services.scored_images import ScoredSegments, review_target
from app.services.submission_access import get_detailed


@dataclass(frozen=True)
class Sent:
    """How many were put into the image's candidates, and how many were there already."""

    image_id: int
    sent: int
    already_there: int


def send_to_review(
    session: Session,
    viewer: Viewer,
    submission_id: int,
    scored: ScoredSegments,
    indices: Sequence[int],
    now: datetime,
) -> Sent:
    """Put false positives into an image's candidates, undecided, with origin ``import``; the image is open again.

    Sending the same ones again changes nothing.

    Args:
        session: A writing session.
        viewer: Who sends them.
        submission_id: The submission.
        scored: The image of it.
        indices: Of its predictions.
        now: When.

    Raises:
        NotFound: When the image isn't in a dataset any more.
        Conflict: When the split is hidden: its labels must not change by what is handed in.
        InvalidInput: Naming the indices that are no false positives.
    """
    submission = get_detailed(session, viewer, submission_id)
    if submission.split_version.split.visibility == "hidden":
        raise Conflict("predictions on a hidden split aren't sent to its labellers")
    target = review_target(session, scored.image)
    if target is None:
        raise NotFound("the image isn't in a dataset any more", where=scored.image.name)
    wanted = sorted(set(indices))
    _require_false_positives(scored, wanted)
    image = get_image(session, target)
    session.refresh(image, with_for_update=True)
    known = {
        bytes(row.points)
        for row in session.execute(current_segments(Segment.points).where(Segment.image_id == image.id))
    }
    new = [index for index in wanted if scored.predictions[index].astype(POINT).tobytes() not in known]
    if new:
        _add(session, image, scored, new, now)
        details = {"submission": submission.id, "image": image.name, "segments": len(new)}
        record_event(
            session,
            "image.false_positives",
            now,
            dataset_id=dataset_of(session, image).id,
            person=viewer.name,
            details=details,
        )
    return Sent(image.id, len(new), len(wanted) - len(new))


def _add(session: Session, image: Image, scored: ScoredSegments, indices: Sequence[int], now: datetime) -> None:
    last = session.scalars(
        select(Segment.ordinal)
        .where(Segment.image_id == image.id, Segment.origin == "import")
        .order_by(Segment.ordinal.desc())
        .limit(1)
    ).one_or_none()
    chosen = LabelledSegments(scored.predictions.select(np.array(indices, dtype=np.int64)))
    session.add_all(segment_rows(image.id, chosen, first_ordinal=0 if last is None else last + 1))
    image.revision += 1
    if image.review.status == "done":
        image.review.status, image.review.updated_at = "open", now
    session.flush()
    refresh_counts(session, [image.id])


def _require_false_positives(scored: ScoredSegments, indices: Sequence[int]) -> None:
    outcomes = scored.record.prediction_outcomes
    wrong = [index for index in indices if not 0 <= index < len(outcomes) or outcomes[index] != Outcome.FALSE_ALARM]
    if wrong:
        shown = ", ".join(map(str, wrong[:20]))
        raise InvalidInput(
            f"no false positives: {shown}", where="predictions", expected="indices of false positives of this image"
        )
