"""Freezing: a copy of labels that later changes of them don't reach."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np
from sqlalchemy import Row, and_, or_, select
from sqlalchemy.orm import Session

from app.db.models import Camera, Dataset, Image, Review, Segment, SegmentState, Split, SplitImage, SplitVersion
from app.errors import Conflict
from app.evaluation.rejected_lines import RejectedLines
from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz_set
from app.services.batches import in_batches
from app.services.blobs import keep_bytes
from app.services.candidates import current_segments, verdict_of_segment
from app.services.concealing import hidden_contents, open_contents
from app.services.images import images_of
from app.services.truths import MEDIA_TYPE, counted_labels, truth_hash
from app.storage import BlobStore
from app.verdicts import REASONS
from app.vision.segments import Segments

POINT = np.dtype("<f4")
REASONS_SHOWN = 5
REASONS_TOLD = 1_000


class NotFrozen(Conflict):
    """Images or labels that can't be frozen as they are."""

    code = "not-frozen"


@dataclass(frozen=True)
class FrozenImage:
    """An image with the labels that are frozen, and the candidates that were rejected with a reason, if any."""

    image: Image
    camera: Camera
    labelled: LabelledSegments
    rejected: RejectedLines | None


def freeze(
    session: Session,
    blobs: BlobStore,
    split: Split,
    dataset: Dataset,
    image_ids: Sequence[int] | None,
    now: datetime,
    *,
    person: str | None = None,
) -> SplitVersion:
    """Make the next version of a split from the labels as they are now: kept segments, and ambiguous ones beside them.

    Args:
        session: A writing session.
        blobs: Where the truth goes.
        split: Its row, which has an id.
        dataset: Where the images are.
        image_ids: Which ones; all whose review is done when left out.
        now: When.
        person: Who freezes.

    Raises:
        NotFound: Naming the ids that no image of the dataset has.
        NotFrozen: With a reason for each image that can't be frozen; or when there is nothing to freeze.
    """
    images = _chosen_images(session, dataset, image_ids)
    _require_freezable(session, split, images)
    frozen = frozen_images(session, [image.id for image, _, _ in images])
    truth = {each.image.name: each.labelled for each in frozen}
    labels = {each.image.name: counted_labels(each.labelled, split.min_length) for each in frozen}
    if not any(labels.values()):
        raise NotFrozen(
            "there is no label to freeze",
            where=dataset.slug,
            expected="a kept segment of at least the minimum length",
            hint="keep some, or lower the minimum length",
        )
    last = max(split.versions, key=lambda version: version.number, default=None)
    rejected = {each.image.name: each.rejected for each in frozen if each.rejected is not None}
    name = truth_hash(truth, split.min_length, rejected)
    if last is not None and last.truth_hash == name:
        raise NotFrozen(f"no label has changed since version {last.number}", where=split.slug)
    version = SplitVersion(
        split=split,
        number=1 if last is None else last.number + 1,
        truth_sha256=keep_bytes(session, blobs, write_npz_set(truth.items()), MEDIA_TYPE, now),
        truth_hash=name,
        n_images=len(frozen),
        n_labels=sum(labels.values()),
        n_ambiguous=sum(_ambiguous(each.labelled) for each in frozen),
        created_at=now,
        created_by=person,
    )
    session.add(version)
    session.flush()
    session.add_all(_row(version, ordinal, each, labels[each.image.name]) for ordinal, each in enumerate(frozen))
    session.flush()
    return version


def frozen_images(session: Session, image_ids: Sequence[int]) -> list[FrozenImage]:
    """Return images with their current labels, kept and ambiguous, by name."""
    found: list[FrozenImage] = []
    for batch in in_batches(image_ids):
        segments = _segments_by_image(session, batch)
        rows = session.execute(select(Image, Camera).join(Image.camera).where(Image.id.in_(batch)))
        for image, camera in rows:
            own = segments.get(image.id, [])
            labels = [row for row in own if row.verdict != "reject"]
            rejects = [row for row in own if row.verdict == "reject"]
            found.append(FrozenImage(image, camera, _labelled(labels), _rejected(rejects)))
    return sorted(found, key=lambda each: each.image.name)


def _chosen_images(
    session: Session, dataset: Dataset, image_ids: Sequence[int] | None
) -> Sequence[tuple[Image, str, bool]]:
    """Return images with their review's status, and whether an image was asked for by its id."""
    if image_ids is not None:
        images_of(session, dataset, image_ids)  # tells the ids that aren't there
    query = (
        select(Image, Review.status)
        .join(Review, Review.image_id == Image.id)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None))
        .order_by(Image.name)
        .with_for_update()
    )
    wanted = None if image_ids is None else set(image_ids)
    return [
        (image, status, wanted is not None)
        for image, status in session.execute(query)
        if (status == "done" if wanted is None else image.id in wanted)
    ]


def _require_freezable(session: Session, split: Split, images: Sequence[tuple[Image, str, bool]]) -> None:
    if not images:
        raise NotFrozen("no image is done", where=split.name, hint="finish the review of an image, then freeze")
    foreign = open_contents() if split.visibility == "hidden" else hidden_contents()
    elsewhere = set(session.scalars(foreign))
    taken = "its labels are public in an open split" if split.visibility == "hidden" else "a hidden split uses it"
    reasons: list[dict[str, str | int]] = []
    for image, status, _ in images:
        if status != "done":
            reasons.append({"image_id": image.id, "image": image.name, "reason": f"its review is {status}, not done"})
        if image.sha256 in elsewhere:
            reasons.append({"image_id": image.id, "image": image.name, "reason": taken})
    if reasons:
        shown = "; ".join(f"{reason['image']}: {reason['reason']}" for reason in reasons[:REASONS_SHOWN])
        raise NotFrozen(
            f"{shown}{' ...' if len(reasons) > REASONS_SHOWN else ''}",
            where=split.name,
            expected="images whose review is done, in splits of one visibility",
            hint="finish these images, or leave them out",
            details={"reasons": reasons[:REASONS_TOLD], "total": len(reasons)},
        )


def _segments_by_image(session: Session, ids: Sequence[int]) -> dict[int, list[Row]]:
    verdict = verdict_of_segment()
    because = and_(verdict == "reject", SegmentState.reason.is_not(None))
    query = current_segments(Segment.image_id, Segment.points, verdict.label("verdict"), SegmentState.reason).where(
        Segment.image_id.in_(ids), or_(verdict.in_(("keep", "ambiguous")), because)
    )
    by_image: dict[int, list[Row]] = {}
    for row in session.execute(query):
        by_image.setdefault(row.image_id, []).append(row)
    return by_image


def _labelled(rows: Sequence[Row]) -> LabelledSegments:
    return LabelledSegments(_segments(rows), verdicts=tuple(row.verdict for row in rows))


def _rejected(rows: Sequence[Row]) -> RejectedLines | None:
    reasons = np.array([REASONS.index(row.reason) for row in rows], np.int8)
    return RejectedLines(_segments(rows), reasons) if rows else None


def _segments(rows: Sequence[Row]) -> Segments:
    return Segments.from_list([np.frombuffer(row.points, POINT).reshape(-1, 2) for row in rows])


def _ambiguous(labelled: LabelledSegments) -> int:
    return sum(verdict == "ambiguous" for verdict in labelled.verdicts or ())


def _row(version: SplitVersion, ordinal: int, each: FrozenImage, labels: int) -> SplitImage:
    image = each.image
    return SplitImage(
        version_id=version.id,
        ordinal=ordinal,
        image_id=image.id,
        name=image.name,
        image_sha256=image.sha256,
        width=image.width,
        height=image.height,
        source=image.source,
        sequence=image.sequence,
        camera=each.camera.name,
        reference=each.camera.reference,
        n_labels=labels,
        rejected=None if each.rejected is None else each.rejected.as_npz(),
    )
