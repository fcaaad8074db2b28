"""How far datasets are: images, reviews, candidates and verdicts, counted for all of them at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, Row, ScalarSelect, and_, func, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, ImageTally, Run
from app.services.access import Viewer
from app.services.concealing import visible_datasets
from app.services.counts import ReviewCounts, VerdictCounts, verdict_counts
from app.services.datasets import get_dataset
from app.services.run_briefs import RunBrief, run_briefs
from app.services.tallies import summed

COVER_IMAGES = 4


@dataclass(frozen=True)
class DatasetOverview:
    """A dataset and how far it is.

    Attributes:
        images: Number of images; deleted ones count nowhere here.
        prelabelled: Images that a run has finished, or that came with labels.
        candidates: Current segments of all images.
        cover: Ids of up to four images to show for it, first by name.
        restorable_until: Of a deleted one, when it goes for good.
    """

    id: int
    slug: str
    name: str
    created_at: datetime
    deleted_at: datetime | None
    restorable_until: datetime | None
    images: int
    reviewed: ReviewCounts
    prelabelled: int
    candidates: int
    verdicts: VerdictCounts
    latest_run: RunBrief | None
    cover: tuple[int, ...]


def list_datasets(
    session: Session, *, grace: timedelta, deleted: bool = False, viewer: Viewer | None = None
) -> list[DatasetOverview]:
    """Return all datasets, newest first; or those that are deleted and can still be restored.

    Args:
        session: Any session.
        grace: How long what was deleted can be restored.
        deleted: Deleted ones, instead of the others.
        viewer: Who asks; what is concealed from them is left out.
    """
    which = Dataset.deleted_at.is_not(None) if deleted else Dataset.deleted_at.is_(None)
    visible = visible_datasets(viewer)
    return _overviews(session, which if visible is None else and_(which, visible), grace)


def dataset_overview(session: Session, slug: str, *, grace: timedelta) -> DatasetOverview:
    """Return one dataset and how far it is.

    Raises:
        NotFound: When there is none of that slug.
    """
    return _overviews(session, Dataset.id == get_dataset(session, slug).id, grace)[0]


def _overviews(session: Session, which: ColumnElement[bool], grace: timedelta) -> list[DatasetOverview]:
    """Five queries, however many datasets there are, none of which reads all their images."""
    ids_of_covers = [_cover_image(place).label(f"cover_{place}") for place in range(COVER_IMAGES)]
    found = session.execute(
        select(Dataset, *ids_of_covers).where(which).order_by(Dataset.created_at.desc(), Dataset.id.desc())
    ).all()
    ids = [row.Dataset.id for row in found]
    counts = _counts_by_dataset(session, ids)
    latest = dict(
        session.execute(
            select(Run.dataset_id, func.max(Run.id))
            .where(Run.dataset_id.in_(ids), Run.deleted_at.is_(None))
            .group_by(Run.dataset_id)
        ).all()
    )
    briefs = run_briefs(session, list(latest.values()))
    return [
        _overview(
            row.Dataset,
            counts.get(row.Dataset.id, []),
            briefs.get(latest.get(row.Dataset.id, 0)),
            tuple(image_id for image_id in row[1:] if image_id is not None),
            grace,
        )
        for row in found
    ]


def _counts_by_dataset(session: Session, ids: Sequence[int]) -> dict[int, list[Row[*tuple[Any, ...]]]]:
    """Return sums over images by dataset and review status."""
    sums = (
        getattr(ImageTally, name) for name in ("images", "prelabelled", "candidates", "keep", "reject", "ambiguous")
    )
    query = (
        select(ImageTally.dataset_id, ImageTally.review_status, *(summed(column).label(column.key) for column in sums))
        .where(ImageTally.dataset_id.in_(ids), ImageTally.deleted.is_(False))
        .group_by(ImageTally.dataset_id, ImageTally.review_status)
    )
    counts: dict[int, list[Row[*tuple[Any, ...]]]] = {}
    for row in session.execute(query):
        counts.setdefault(row.dataset_id, []).append(row)
    return counts


def _cover_image(place: int) -> ScalarSelect[int]:
    """Return the id of the image at a place among the dataset's, by name; each is found through an index."""
    return (
        select(Image.id)
        .where(Image.dataset_id == Dataset.id, Image.deleted_at.is_(None))
        .order_by(Image.name)
        .offset(place)
        .limit(1)
        .correlate(Dataset)
        .scalar_subquery()
    )


def _overview(
    dataset: Dataset,
    counts: Sequence[Row[*tuple[Any, ...]]],
    latest_run: RunBrief | None,
    cover: tuple[int, ...],
    grace: timedelta,
) -> DatasetOverview:
    def total(column: str) -> int:
        return sum(int(getattr(row, column)) for row in counts)

    candidates = total("candidates")
    return DatasetOverview(
        id=dataset.id,
        slug=dataset.slug,
        name=dataset.name,
        created_at=dataset.created_at,
        deleted_at=dataset.deleted_at,
        restorable_until=dataset.deleted_at + grace if dataset.deleted_at else None,
        images=total("images"),
        reviewed=ReviewCounts(**{str(row.review_status): int(row.images) for row in counts}),
        prelabelled=total("prelabelled"),
        candidates=candidates,
        verdicts=verdict_counts(candidates, total("keep"), total("reject"), total("ambiguous")),
        latest_run=latest_run,
        cover=cover,
    )
