"""How far datasets are: images, reviews, candidates and verdicts, counted for all of them at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, Row, and_, func, or_, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Review, Run
from app.services.access import Viewer
from app.services.concealing import visible_datasets
from app.services.counts import ReviewCounts, VerdictCounts, verdict_counts
from app.services.datasets import get_dataset
from app.services.run_briefs import RunBrief, run_briefs

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
    """Five queries, however many datasets there are."""
    datasets = session.scalars(
        select(Dataset).where(which).order_by(Dataset.created_at.desc(), Dataset.id.desc())
    ).all()
    chosen = select(Dataset.id).where(which)
    alive = and_(Image.dataset_id.in_(chosen), Image.deleted_at.is_(None))
    counts = _counts_by_dataset(session, alive)
    cover = _covers(session, alive)
    latest = dict(
        session.execute(
            select(Run.dataset_id, func.max(Run.id))
            .where(Run.dataset_id.in_(chosen), Run.deleted_at.is_(None))
            .group_by(Run.dataset_id)
        ).all()
    )
    briefs = run_briefs(session, list(latest.values()))
    return [
        _overview(dataset, counts.get(dataset.id, []), briefs.get(latest.get(dataset.id, 0)), cover, grace)
        for dataset in datasets
    ]


def _counts_by_dataset(session: Session, alive: ColumnElement[bool]) -> dict[int, list[Row[*tuple[Any, ...]]]]:
    """Return sums over images by dataset and review status."""
    prelabelled = or_(Image.current_run_image_id.is_not(None), Image.n_candidates > 0)
    query = (
        select(
            Image.dataset_id,
            Review.status,
            func.count().label("images"),
            func.count().filter(prelabelled).label("prelabelled"),
            *(
                func.coalesce(func.sum(column), 0).label(column.key)
                for column in (Image.n_candidates, Image.n_keep, Image.n_reject, Image.n_ambiguous)
            ),
        )
        .join(Review, Review.image_id == Image.id)
        .where(alive)
        .group_by(Image.dataset_id, Review.status)
    )
    counts: dict[int, list[Row[*tuple[Any, ...]]]] = {}
    for row in session.execute(query):
        counts.setdefault(row.dataset_id, []).append(row)
    return counts


def _covers(session: Session, alive: ColumnElement[bool]) -> dict[int, list[int]]:
    rank = func.row_number().over(partition_by=Image.dataset_id, order_by=Image.name).label("rank")
    ranked = select(Image.dataset_id, Image.id, rank).where(alive).subquery()
    query = select(ranked.c.dataset_id, ranked.c.id).where(ranked.c.rank <= COVER_IMAGES).order_by(ranked.c.rank)
    covers: dict[int, list[int]] = {}
    for dataset_id, image_id in session.execute(query):
        covers.setdefault(dataset_id, []).append(image_id)
    return covers


def _overview(
    dataset: Dataset,
    counts: Sequence[Row[*tuple[Any, ...]]],
    latest_run: RunBrief | None,
    covers: dict[int, list[int]],
    grace: timedelta,
) -> DatasetOverview:
    def total(column: str) -> int:
        return sum(int(getattr(row, column)) for row in counts)

    candidates = total("n_candidates")
    return DatasetOverview(
        id=dataset.id,
        slug=dataset.slug,
        name=dataset.name,
        created_at=dataset.created_at,
        deleted_at=dataset.deleted_at,
        restorable_until=dataset.deleted_at + grace if dataset.deleted_at else None,
        images=total("images"),
        reviewed=ReviewCounts(**{str(row.status): int(row.images) for row in counts}),
        prelabelled=total("prelabelled"),
        candidates=candidates,
        verdicts=verdict_counts(candidates, total("n_keep"), total("n_reject"), total("n_ambiguous")),
        latest_run=latest_run,
        cover=tuple(covers.get(dataset.id, ())),
    )
