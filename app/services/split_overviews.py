"""Splits as a viewer may see them: what is frozen, until when submissions are taken, what the viewer can do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session, selectinload

from app.db.models import Dataset, Decision, Image, Split, SplitImage, SplitVersion, Submission
from app.evaluation.protocols import PROTOCOLS
from app.evaluation.rejected_lines import RejectedLines
from app.formats.labelled import LabelledSegments
from app.services.access import Viewer, can_maintain, can_see_details, can_submit
from app.services.concealing import require_visible, visible_datasets
from app.services.datasets import get_dataset
from app.services.freezing import frozen_images
from app.services.splits import current_version, is_closed
from app.services.truths import read_rejected, read_truth, truth_hash
from app.storage import BlobStore

RANK_PROTOCOL = "clearlines-v2"
LATEST_DECISION = timedelta(minutes=10)


@dataclass(frozen=True)
class DatasetName:
    """Which dataset a split was made from."""

    slug: str
    name: str


@dataclass(frozen=True)
class VersionEntry:
    """One frozen truth.

    Attributes:
        labels: Labels to be found; ``None`` on a hidden split below maintainer, as is ``ambiguous``.
    """

    number: int
    truth_hash: str
    images: int
    labels: int | None
    ambiguous: int | None
    created_at: datetime


@dataclass(frozen=True)
class SplitAbilities:
    """What the viewer can do on a split."""

    submit: bool
    maintain: bool
    see_details: bool


@dataclass(frozen=True)
class LabelsSince:
    """What became of a split's labels since they were frozen.

    Attributes:
        changed: Names of images whose labels differ now.
        gone: Names of images that the dataset has no longer.
    """

    changed: tuple[str, ...]
    gone: tuple[str, ...]


@dataclass(frozen=True)
class SplitOverview:
    """A split.

    Attributes:
        dataset: ``None`` when it is gone or concealed from the viewer.
        version: The newest one; ``versions`` has all, newest first.
        submissions: Public ones with a score.
        labels_since: Where a maintainer asked for this one split.
    """

    slug: str
    name: str
    description: str | None
    dataset: DatasetName | None
    visibility: str
    min_length: float
    protocol: str
    protocol_version: str
    closes_at: datetime | None
    closed: bool
    daily_limit: int
    created_at: datetime
    deleted_at: datetime | None
    version: VersionEntry
    versions: tuple[VersionEntry, ...]
    submissions: int
    can: SplitAbilities
    labels_since: LabelsSince | None = None


def list_splits(
    session: Session, viewer: Viewer, now: datetime, *, dataset: str | None = None, deleted: bool = False
) -> list[SplitOverview]:
    """Return the splits, newest first: all, or those of one dataset; deleted ones to maintainers alone.

    Raises:
        NotFound: When there is no dataset of that slug, or it is concealed.
    """
    query = select(Split).order_by(Split.created_at.desc(), Split.id.desc())
    query = query.where(Split.deleted_at.is_not(None) if deleted else Split.deleted_at.is_(None))
    if deleted and not can_maintain(viewer):
        return []
    if dataset is not None:
        require_visible(session, viewer, {"dataset": dataset})
        query = query.where(Split.dataset_id == get_dataset(session, dataset).id)
    return overviews(session, session.scalars(query.options(selectinload(Split.versions))).all(), viewer, now)


def split_overview(session: Session, blobs: BlobStore, split: Split, viewer: Viewer, now: datetime) -> SplitOverview:
    """Return one split as the viewer may see it; maintainers see too whether its labels changed since."""
    overview = overviews(session, [split], viewer, now)[0]
    return replace(overview, labels_since=labels_since(session, blobs, split)) if can_maintain(viewer) else overview


def overviews(session: Session, splits: Sequence[Split], viewer: Viewer, now: datetime) -> list[SplitOverview]:
    """Return splits as the viewer may see them, in their order, with two queries for all of them."""
    ids = [split.id for split in splits]
    datasets = _datasets(session, [split.dataset_id for split in splits if split.dataset_id is not None], viewer)
    submissions = dict(
        session.execute(
            select(SplitVersion.split_id, func.count())
            .join(Submission, Submission.split_version_id == SplitVersion.id)
            .where(SplitVersion.split_id.in_(ids), Submission.status == "scored", Submission.visibility == "public")
            .group_by(SplitVersion.split_id)
        ).all()
    )
    return [
        _overview(split, datasets.get(split.dataset_id or 0), submissions.get(split.id, 0), viewer, now)
        for split in splits
    ]


def labels_since(session: Session, blobs: BlobStore, split: Split) -> LabelsSince:
    """Compare the newest version with the labels as they are now, image by image."""
    version = current_version(session, split)
    # labels change by decisions alone; one that was on its way while the split was frozen has an earlier time
    since = version.created_at - LATEST_DECISION
    # looked up image by image, so that it takes no longer where there are more of others
    is_there = (
        select(Image.deleted_at.is_(None))
        .where(Image.id == SplitImage.image_id)
        .correlate(SplitImage)
        .scalar_subquery()
    )
    # the decisions of an image are stored one after the other, so the last one tells; an index has it
    latest = (
        select(Decision.created_at)
        .where(Decision.image_id == SplitImage.image_id)
        .order_by(Decision.id.desc())
        .limit(1)
        .correlate(SplitImage)
        .scalar_subquery()
    )
    suspects = (
        select(SplitImage.name, SplitImage.image_id, is_there.label("is_there"), latest.label("latest"))
        .where(SplitImage.version_id == version.id)
        .subquery()
    )
    rows = session.execute(
        select(suspects.c.name, suspects.c.image_id, suspects.c.is_there)
        .where(or_(suspects.c.is_there.is_not(True), suspects.c.latest >= since))
        .order_by(suspects.c.name)
    ).all()
    gone = tuple(row.name for row in rows if not row.is_there)
    frozen_names = {row.image_id: row.name for row in rows if row.is_there}
    if not frozen_names:
        return LabelsSince((), gone)
    frozen, rejected = read_truth(blobs, version), read_rejected(session, version)
    changed = [
        name
        for each in frozen_images(session, list(frozen_names))
        if _hash(each.labelled, each.rejected) != _hash(frozen[name := frozen_names[each.image.id]], rejected.get(name))
    ]
    return LabelsSince(tuple(sorted(changed)), gone)


def _hash(labelled: LabelledSegments, rejected: RejectedLines | None) -> str:
    return truth_hash({"": labelled}, 0.0, None if rejected is None else {"": rejected})


def _datasets(session: Session, ids: Sequence[int], viewer: Viewer) -> dict[int, DatasetName]:
    query = select(Dataset.id, Dataset.slug, Dataset.name).where(Dataset.id.in_(ids), Dataset.deleted_at.is_(None))
    visible = visible_datasets(viewer)
    rows = session.execute(query if visible is None else query.where(visible))
    return {row.id: DatasetName(row.slug, row.name) for row in rows}


def _overview(
    split: Split, dataset: DatasetName | None, submissions: int, viewer: Viewer, now: datetime
) -> SplitOverview:
    details = can_see_details(viewer, split.visibility)
    versions = tuple(_version(version, details=details) for version in reversed(split.versions))
    closed = is_closed(split, now)
    return SplitOverview(
        slug=split.slug,
        name=split.name,
        description=split.description,
        dataset=dataset,
        visibility=split.visibility,
        min_length=split.min_length,
        protocol=RANK_PROTOCOL,
        protocol_version=PROTOCOLS[RANK_PROTOCOL].version,
        closes_at=split.closes_at,
        closed=closed,
        daily_limit=split.daily_limit,
        created_at=split.created_at,
        deleted_at=split.deleted_at,
        version=versions[0],
        versions=versions,
        submissions=submissions,
        can=SplitAbilities(can_submit(viewer) and not closed, can_maintain(viewer), details),
    )


def _version(version: SplitVersion, *, details: bool) -> VersionEntry:
    return VersionEntry(
        number=version.number,
        truth_hash=version.truth_hash,
        images=version.n_images,
        labels=version.n_labels if details else None,
        ambiguous=version.n_ambiguous if details else None,
        created_at=version.created_at,
    )
