"""Submissions that the server itself makes: detectors of our own, and people who labelled a split's images twice."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Method, SplitVersion, Submission
from app.db.session import Database
from app.formats.submission_files import SubmissionContent, canonical_form, content_hash
from app.services.blobs import add_blob_row
from app.services.slugs import free_slug, slug_of
from app.services.submission_log import add_to_log
from app.services.submission_states import add_score
from app.services.truths import MEDIA_TYPE
from app.storage import BlobStore
from app.vision.segments import Segments


@dataclass(frozen=True)
class OwnMethod:
    """A method that nobody hands in.

    Attributes:
        name: As the board shows it.
        label: Version of the program that it is.
        description: What it does.
        code_url: Where it comes from.
        paper_url: Where it is described.
        kind: A ``ceiling`` stands on the board without a rank.
    """

    name: str
    label: str
    description: str
    code_url: str | None = None
    paper_url: str | None = None
    kind: Literal["baseline", "ceiling"] = "baseline"


def queue_own_submission(
    database: Database,
    blobs: BlobStore,
    version_id: int,
    method: OwnMethod,
    segments: Mapping[str, Segments],
    now: datetime,
) -> int:
    """Queue a submission to be scored; what is there already, with the same segments, isn't handed in again.

    Args:
        database: Where the rows are.
        blobs: Where the segments go.
        version_id: Of the split.
        method: Whose segments they are.
        segments: By image name.
        now: When.

    Returns:
        The submission's id.
    """
    has_scores = all(each.scores is not None for each in segments.values() if len(each))
    content = SubmissionContent(segments, has_scores, (), (), ())
    data, submission_hash = canonical_form(content), content_hash(content)
    sha256 = blobs.put(data)
    with database.write() as session:
        row = _method(session, method, now)
        known = session.scalars(
            select(Submission)
            .where(
                Submission.method_id == row.id,
                Submission.split_version_id == version_id,
                Submission.submission_hash == submission_hash,
                Submission.status.in_(("queued", "scoring", "scored")),
            )
            .limit(1)
        ).one_or_none()
        if known is not None:
            return known.id
        add_blob_row(session, sha256, len(data), MEDIA_TYPE, now)
        submission = Submission(
            split_version_id=version_id,
            method_id=row.id,
            label=method.label,
            status="queued",
            segments_sha256=sha256,
            submission_hash=submission_hash,
            n_images=len(segments),
            n_segments=content.n_segments,
            n_points=content.n_points,
            has_scores=has_scores,
            missing=[],
            created_at=now,
            queued_at=now,
        )
        add_to_log(submission, f"made by {method.label}", now)
        session.add(submission)
        session.flush()
        add_score(session, submission, session.get_one(SplitVersion, version_id), now)
        return submission.id


def _method(session: Session, own: OwnMethod, now: datetime) -> Method:
    query = select(Method).where(Method.name == own.name, Method.kind == own.kind).order_by(Method.id).limit(1)
    known = session.scalars(query).one_or_none()
    if known is not None:
        return known
    row = Method(
        slug=free_slug(slug_of(own.name), set(session.scalars(select(Method.slug)))),
        name=own.name,
        description=own.description,
        code_url=own.code_url,
        paper_url=own.paper_url,
        kind=own.kind,
        created_at=now,
    )
    session.add(row)
    session.flush()
    return row
