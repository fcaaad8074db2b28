"""The ceiling of a board: how well one person does against another, on images that were labelled twice."""

from __future__ import annotations

from datetime import datetime

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Image, SecondReview, Segment, SplitImage
from app.db.session import Database
from app.errors import Conflict
from app.services.carrying import stored_polyline
from app.services.events import record_event
from app.services.images import NAMES_SHOWN
from app.services.own_submissions import OwnMethod, queue_own_submission
from app.services.second_verdicts import latest_verdicts
from app.services.splits import current_version, get_split
from app.storage import BlobStore
from app.vision.segments import Segments

NAME = "Person against person"
DESCRIPTION = (
    "What second reviewers kept, who judged all candidates without knowing the first review. "
    "A detector that does better than this follows one person's taste."
)


def add_ceiling(database: Database, blobs: BlobStore, slug: str, now: datetime, *, person: str | None = None) -> int:
    """Queue what second reviewers kept in the images of a split's newest version as a row that isn't ranked.

    Args:
        database: Where the rows are.
        blobs: Where the segments go.
        slug: Of the split.
        now: When.
        person: Who asks for it.

    Returns:
        The submission's id; that of an earlier one with the same segments.

    Raises:
        NotFound: When there is no such split.
        Conflict: Naming the images that nobody has reviewed a second time.
    """
    with database.read() as session:
        split = get_split(session, slug)
        version = current_version(session, split)
        segments, people = _kept_twice(session, version.id, split.name)
    names = f"{people} {'person' if people == 1 else 'people'}"
    method = OwnMethod(NAME, names, DESCRIPTION, kind="ceiling")
    submission_id = queue_own_submission(database, blobs, version.id, method, segments, now)
    with database.write() as session:
        details = {"split": slug, "submission": submission_id}
        record_event(session, "split.ceiling", now, dataset_id=split.dataset_id, person=person, details=details)
    return submission_id


def _kept_twice(session: Session, version_id: int, split: str) -> tuple[dict[str, Segments], int]:
    """Return what second reviewers kept by the images' names in the split, and their number."""
    rows = session.execute(
        select(SplitImage.name, SplitImage.image_sha256, Image.sha256, SecondReview)
        .outerjoin(Image, Image.id == SplitImage.image_id)
        .outerjoin(SecondReview, (SecondReview.image_id == Image.id) & (SecondReview.status == "done"))
        .where(SplitImage.version_id == version_id)
        .order_by(SplitImage.ordinal)
    ).all()
    once = [name for name, frozen, present, review in rows if review is None or frozen != present]
    if once:
        shown = ", ".join(once[:NAMES_SHOWN])
        raise Conflict(
            f"nobody has reviewed {shown}{' ...' if len(once) > NAMES_SHOWN else ''} a second time",
            where=split,
            expected="a second review that is done of each image of the split",
            details={"images": once[:1000]},
        )
    people = {review.person for *_, review in rows}
    return {name: _kept(session, review) for name, _, _, review in rows}, len(people)


def _kept(session: Session, review: SecondReview) -> Segments:
    kept = [segment for segment, verdict in latest_verdicts(session, review.id).items() if verdict == "keep"]
    rows = session.scalars(
        select(Segment.points).where(Segment.image_id == review.image_id, Segment.id.in_(kept)).order_by(Segment.id)
    )
    polylines = [stored_polyline(points).astype(np.float32) for points in rows]
    return Segments.from_list(polylines) if polylines else Segments.empty()
