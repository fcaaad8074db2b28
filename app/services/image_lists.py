"""Lists of images: filtered, sorted, page by page, and the values that they can be filtered by."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import ColumnElement, Select, func, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from app.db.models import REVIEW_STATES, Camera, Dataset, Image, Review, Run, RunImage
from app.errors import InvalidInput
from app.services.image_candidates import candidate_conditions
from app.services.image_summaries import ImageSummary, latest_work, select_summaries, summaries_of
from app.services.paging import Order, Page, checked_limit, page_of

PRELABEL_STATES = ("none", "queued", "running", "done", "failed")

ORDERS = {
    order.name: order
    for order in (
        Order("name", Image.name, Image.id),
        Order("-name", Image.name, Image.id, descending=True),
        Order("created", Image.created_at, Image.id),
        Order("-created", Image.created_at, Image.id, descending=True),
        Order("candidates", Image.n_candidates, Image.id),
        Order("-candidates", Image.n_candidates, Image.id, descending=True),
    )
}


@dataclass(frozen=True)
class ImageFilter:
    """Which images; ``None`` stands for all, an empty source or sequence for images without one.

    Attributes:
        search: Part of the name, in any case.
        assignee: Whose task they are; empty for those that are nobody's.
        person: Who decided on some of their candidates.
        verdict: That at least one of their candidates has.
        min_score: With a candidate of at least this score.
        max_score: With a candidate of at most this score; with both, one candidate's score is between them.
        deleted: Those that are deleted and can still be restored, instead of the others.
    """

    status: str | None = None
    source: str | None = None
    camera: int | None = None
    sequence: str | None = None
    prelabel: str | None = None
    search: str | None = None
    assignee: str | None = None
    person: str | None = None
    verdict: str | None = None
    min_score: float | None = None
    max_score: float | None = None
    deleted: bool = False


@dataclass(frozen=True)
class Facet:
    """A value that occurs among the images, and how often."""

    value: str | None
    count: int


@dataclass(frozen=True)
class CameraFacet:
    """A camera and the number of its images."""

    id: int
    name: str
    count: int


@dataclass(frozen=True)
class Facets:
    """What a dataset's images can be filtered by."""

    sources: tuple[Facet, ...]
    sequences: tuple[Facet, ...]
    assignees: tuple[Facet, ...]
    cameras: tuple[CameraFacet, ...]
    status: dict[str, int]
    prelabel: dict[str, int]


def list_images(
    session: Session,
    dataset: Dataset,
    chosen: ImageFilter | None = None,
    *,
    sort: str = "name",
    limit: int = 100,
    cursor: str | None = None,
) -> Page[ImageSummary]:
    """Return a page of a dataset's images.

    Raises:
        InvalidInput: On an unknown sort, status or prelabel state, a limit out of range, a cursor of another list.
    """
    chosen = chosen or ImageFilter()
    order = ORDERS.get(sort)
    if order is None:
        raise InvalidInput(f"images can't be sorted by {sort!r:.60}", where="sort", expected=", ".join(ORDERS))
    limit = checked_limit(limit)
    matching = select_images(dataset, chosen)
    total = session.scalar(matching.with_only_columns(func.count(Image.id))) or 0
    query = matching.where(order.after(cursor)) if cursor else matching
    rows = session.execute(query.order_by(*order.clauses()).limit(limit + 1)).all()
    column = order.column.key
    page = page_of(rows, limit, order, lambda row: (getattr(row.Image, column), row.Image.id), total)
    return Page(tuple(summaries_of(session, page.items)), page.next_cursor, page.total)


def select_images(dataset: Dataset, chosen: ImageFilter) -> Select[Image, Review, str]:
    """Select ``Image``, ``Review`` and the camera's name of the images that the filter chooses, in no order.

    Raises:
        InvalidInput: On an unknown status, prelabel state or verdict.
    """
    query = (
        select_summaries()
        .where(Image.dataset_id == dataset.id)
        .where(Image.deleted_at.is_not(None) if chosen.deleted else Image.deleted_at.is_(None))
    )
    if chosen.status is not None:
        query = query.where(Review.status == _known(chosen.status, REVIEW_STATES, "status"))
    if chosen.source is not None:
        query = query.where(_equals(Image.source, chosen.source))
    if chosen.sequence is not None:
        query = query.where(_equals(Image.sequence, chosen.sequence))
    if chosen.camera is not None:
        query = query.where(Image.camera_id == chosen.camera)
    if chosen.search:
        query = query.where(Image.name.icontains(chosen.search, autoescape=True))
    if chosen.assignee is not None:
        query = query.where(_equals(Image.assignee, chosen.assignee))
    query = query.where(*candidate_conditions(chosen.person, chosen.verdict, chosen.min_score, chosen.max_score))
    if chosen.prelabel is not None:
        state = _known(chosen.prelabel, PRELABEL_STATES, "prelabel")
        latest = latest_work(Run.dataset_id == dataset.id)
        query = query.outerjoin(latest, latest.c.image_id == Image.id).outerjoin(RunImage, RunImage.id == latest.c.id)
        query = query.where(func.coalesce(RunImage.status, "none") == state)
    return query


def facets(session: Session, dataset: Dataset) -> Facets:
    """Return the values that occur among a dataset's images, each with its number of images."""
    alive = (Image.dataset_id == dataset.id) & Image.deleted_at.is_(None)
    cameras = session.execute(
        select(Camera.id, Camera.name, func.count())
        .join(Image, Image.camera_id == Camera.id)
        .where(alive)
        .group_by(Camera.id, Camera.name)
        .order_by(Camera.name)
    )
    statuses = select(Review.status, func.count()).join(Image).where(alive).group_by(Review.status)
    latest = latest_work(Run.dataset_id == dataset.id)
    state = func.coalesce(RunImage.status, "none")
    prelabel = (
        select(state, func.count())
        .select_from(Image)
        .outerjoin(latest, latest.c.image_id == Image.id)
        .outerjoin(RunImage, RunImage.id == latest.c.id)
        .where(alive)
        .group_by(state)
    )
    return Facets(
        sources=_facet(session, Image.source, alive),
        sequences=_facet(session, Image.sequence, alive),
        assignees=_facet(session, Image.assignee, alive),
        cameras=tuple(CameraFacet(*row) for row in cameras),
        status=dict.fromkeys(REVIEW_STATES, 0) | dict(session.execute(statuses).all()),
        prelabel=dict.fromkeys(PRELABEL_STATES, 0) | dict(session.execute(prelabel).all()),
    )


def _facet(
    session: Session, column: InstrumentedAttribute[str | None], alive: ColumnElement[bool]
) -> tuple[Facet, ...]:
    rows = session.execute(select(column, func.count()).where(alive).group_by(column)).all()
    return tuple(Facet(value, count) for value, count in sorted(rows, key=lambda row: (row[0] is None, row[0] or "")))


def _equals(column: InstrumentedAttribute[str | None], value: str) -> ColumnElement[bool]:
    return column == value if value else column.is_(None)


def _known(value: str, known: tuple[str, ...], where: str) -> str:
    if value not in known:
        raise InvalidInput(f"{value!r:.60} is not known", where=where, expected=", ".join(known))
    return value
