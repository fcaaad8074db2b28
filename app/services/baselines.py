"""Baseline rows of a board: detectors of our own run over a split's images and queued like any submission."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime

import cv2
from sqlalchemy import select
from sqlalchemy.orm import Session

from app import __version__
from app.db.models import Image, Method, SplitImage, SplitVersion, Submission
from app.db.session import Database
from app.formats.submission_files import SubmissionContent, canonical_form, content_hash
from app.images.decode import decode_gray
from app.services.baseline_detectors import detect_candidates, detect_lsd
from app.services.blobs import add_blob_row
from app.services.slugs import free_slug, slug_of
from app.services.splits import current_version, get_split
from app.services.stored_candidates import stored_candidates
from app.services.submission_log import add_to_log
from app.services.submission_states import add_score
from app.services.truths import MEDIA_TYPE
from app.storage import BlobStore
from app.vision.segments import Segments

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Baseline:
    """A detector of our own.

    Attributes:
        name: As the board shows it.
        label: Version of the program that it is.
        description: What it does.
        code_url: Where it comes from.
        paper_url: Where it is described.
    """

    name: str
    label: str
    description: str
    code_url: str | None = None
    paper_url: str | None = None


PIPELINE = Baseline(
    "Pre-labelling pipeline",
    f"ClearLines {__version__}",
    "All candidates that annotators are shown, before the straightness filter and before any decision.",
)
LSD = Baseline(
    "OpenCV LSD",
    f"OpenCV {cv2.__version__}",
    "OpenCV's line segment detector with its defaults, segments of at least the split's minimum length.",
    "https://docs.opencv.org/4.x/db/d73/classcv_1_1LineSegmentDetector.html",
    "https://doi.org/10.5201/ipol.2012.gjmr-lsd",
)
BASELINES = (PIPELINE, LSD)


def add_baselines(
    database: Database,
    blobs: BlobStore,
    slug: str,
    now: datetime,
    *,
    max_pixels: int,
    progress: Progress | None = None,
) -> list[int]:
    """Run the baselines over the newest version of a split and queue what they find; a dispatcher scores it.

    What is on the board already, with the same segments, isn't handed in again.

    Args:
        database: Where the rows are.
        blobs: Where the images are.
        slug: Of the split.
        now: When.
        max_pixels: Greatest number of pixels that is decoded.
        progress: Called with the images done and their total.

    Returns:
        Ids of the submissions, one per baseline, in the order of ``BASELINES``.

    Raises:
        NotFound: When there is no such split, or an image's file is gone.
        InvalidImage: When an image can't be decoded.
    """
    with database.read() as session:
        split = get_split(session, slug)
        version = current_version(session, split)
        query = select(SplitImage).where(SplitImage.version_id == version.id).order_by(SplitImage.ordinal)
        images = list(session.scalars(query))
    found: dict[str, dict[str, Segments]] = {baseline.name: {} for baseline in BASELINES}
    for place, image in enumerate(images):
        with database.read() as session:
            held = session.get(Image, image.image_id) if image.image_id is not None else None
            unchanged = held is not None and held.sha256 == image.image_sha256
            candidates = stored_candidates(session, held) if held is not None and unchanged else None
        gray = decode_gray(blobs.read(image.image_sha256), max_pixels=max_pixels)
        stored = detect_candidates(gray, split.min_length) if candidates is None else candidates
        found[PIPELINE.name][image.name] = stored
        found[LSD.name][image.name] = detect_lsd(gray, split.min_length)
        if progress is not None:
            progress(place + 1, len(images))
    return [_queue(database, blobs, version, baseline, found[baseline.name], now) for baseline in BASELINES]


def _queue(
    database: Database,
    blobs: BlobStore,
    version: SplitVersion,
    baseline: Baseline,
    segments: Mapping[str, Segments],
    now: datetime,
) -> int:
    has_scores = all(each.scores is not None for each in segments.values() if len(each))
    content = SubmissionContent(segments, has_scores, (), (), ())
    data, submission_hash = canonical_form(content), content_hash(content)
    sha256 = blobs.put(data)
    with database.write() as session:
        method = _method(session, baseline, now)
        known = session.scalars(
            select(Submission)
            .where(
                Submission.method_id == method.id,
                Submission.split_version_id == version.id,
                Submission.submission_hash == submission_hash,
                Submission.status.in_(("queued", "scoring", "scored")),
            )
            .limit(1)
        ).one_or_none()
        if known is not None:
            return known.id
        add_blob_row(session, sha256, len(data), MEDIA_TYPE, now)
        submission = Submission(
            split_version_id=version.id,
            method_id=method.id,
            label=baseline.label,
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
        add_to_log(submission, f"made by {baseline.label}", now)
        session.add(submission)
        session.flush()
        add_score(session, submission, session.get_one(SplitVersion, version.id), now)
        return submission.id


def _method(session: Session, baseline: Baseline, now: datetime) -> Method:
    query = select(Method).where(Method.name == baseline.name, Method.kind == "baseline").order_by(Method.id).limit(1)
    known = session.scalars(query).one_or_none()
    if known is not None:
        return known
    method = Method(
        slug=free_slug(slug_of(baseline.name), set(session.scalars(select(Method.slug)))),
        name=baseline.name,
        description=baseline.description,
        code_url=baseline.code_url,
        paper_url=baseline.paper_url,
        kind="baseline",
        created_at=now,
    )
    session.add(method)
    session.flush()
    return method
