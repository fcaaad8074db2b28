"""Lists of images: filtered, sorted, page by page, and the values that they can be filtered by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, TypeVar

from sqlalchemy import ColumnElement, Select, select
from sqlalchemy.orm import InstrumentedAttribute, Session, aliased

from app.db.models import REVIEW_STATES, Camera, Dataset, Image, ImageTally
from app.errors import InvalidInput
from app.services.image_candidates import candidate_conditions
from app.services.image_summaries import ImageSummary, image_summaries, select_summaries, summaries_of
from app.services.paging import COUNTED, Counted, Order, Page, checked_limit, counted, counted_up_to, page_of
from app.services.tallies import counts_by, image_count, of_dataset

Chosen = TypeVar("Chosen", bound=Select[*tuple[Any, ...]])

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
SHOWN = {"name": "name", "created": "created_at", "candidates": "candidates"}
"""What summaries call that which they are in order of."""


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
    matching = _choose(select(Image), dataset, chosen)
    if cursor is None and limit < COUNTED and not _counted_by_tallies(chosen):
        rows, total = _listed_and_counted(session, matching, order, limit)
    else:
        rows = _listed(session, matching.where(order.after(cursor)) if cursor else matching, order, limit)
        whole = cursor is None and len(rows) <= limit
        total = Counted(len(rows)) if whole else _total(session, dataset, chosen, matching)
    key = attrgetter(SHOWN[sort.removeprefix("-")], "id")
    return page_of(rows, limit, order, key, total)


def facets(session: Session, dataset: Dataset) -> Facets:
    """Return the values that occur among a dataset's images, each with its number of images."""
    alive = of_dataset(dataset)
    of_camera = counts_by(session, ImageTally.camera_id, alive)
    cameras = session.execute(select(Camera.id, Camera.name).where(Camera.id.in_(of_camera)).order_by(Camera.name))
    return Facets(
        sources=_facet(counts_by(session, ImageTally.source, alive)),
        sequences=_facet(counts_by(session, ImageTally.sequence, alive)),
        assignees=_facet(counts_by(session, ImageTally.assignee, alive)),
        cameras=tuple(CameraFacet(camera_id, name, of_camera[camera_id]) for camera_id, name in cameras),
        status=dict.fromkeys(REVIEW_STATES, 0) | dict(counts_by(session, ImageTally.review_status, alive)),
        prelabel=dict.fromkeys(PRELABEL_STATES, 0) | dict(counts_by(session, ImageTally.prelabel, alive)),
    )


def _choose(query: Chosen, dataset: Dataset, chosen: ImageFilter) -> Chosen:
    query = query.where(Image.dataset_id == dataset.id)
    query = query.where(Image.deleted_at.is_not(None) if chosen.deleted else Image.deleted_at.is_(None))
    query = query.where(*_exact_conditions(Image, chosen))
    if chosen.search:
        query = query.where(Image.name.icontains(chosen.search, autoescape=True))
    return query.where(*candidate_conditions(chosen.person, chosen.verdict, chosen.min_score, chosen.max_score))


def _exact_conditions(table: type[Image | ImageTally], chosen: ImageFilter) -> list[ColumnElement[bool]]:
    """Return the conditions that images can be counted by, on the images or on their tallies."""
    conditions: list[ColumnElement[bool]] = []
    if chosen.status is not None:
        conditions.append(table.review_status == _known(chosen.status, REVIEW_STATES, "status"))
    if chosen.prelabel is not None:
        conditions.append(table.prelabel == _known(chosen.prelabel, PRELABEL_STATES, "prelabel"))
    if chosen.camera is not None:
        conditions.append(table.camera_id == chosen.camera)
    words = ((table.source, chosen.source), (table.sequence, chosen.sequence), (table.assignee, chosen.assignee))
    conditions += [_equals(column, value) for column, value in words if value is not None]
    return conditions


def _listed(session: Session, matching: Select[Any], order: Order, limit: int) -> list[ImageSummary]:
    # found first, by an index, and only then joined with what is shown of them
    found = aliased(Image, matching.order_by(*order.clauses()).limit(limit + 1).subquery())
    return summaries_of(session, select_summaries(found).order_by(*order.on(found).clauses()))


def _listed_and_counted(
    session: Session, matching: Select[Any], order: Order, limit: int
) -> tuple[list[ImageSummary], Counted]:
    """Return a first page and the total of what no tally counts: looking for both at once takes half the time."""
    found = session.scalars(matching.with_only_columns(Image.id).order_by(*order.clauses()).limit(COUNTED + 1)).all()
    return image_summaries(session, found[: limit + 1]), counted(len(found))


def _counted_by_tallies(chosen: ImageFilter) -> bool:
    """Return whether an image's tally tells if it is chosen."""
    return not chosen.search and (chosen.person, chosen.verdict, chosen.min_score, chosen.max_score) == (None,) * 4


def _total(session: Session, dataset: Dataset, chosen: ImageFilter, matching: Select[Any]) -> Counted:
    if not _counted_by_tallies(chosen):
        return counted_up_to(session, matching)
    here = (ImageTally.dataset_id == dataset.id, ImageTally.deleted.is_(chosen.deleted))
    return Counted(image_count(session, *here, *_exact_conditions(ImageTally, chosen)))


def _facet(counts: Mapping[str | None, int]) -> tuple[Facet, ...]:
    return tuple(Facet(*row) for row in sorted(counts.items(), key=lambda row: (row[0] is None, row[0] or "")))


def _equals(column: InstrumentedAttribute[str | None], value: str) -> ColumnElement[bool]:
    return column == value if value else column.is_(None)


def _known(value: str, known: tuple[str, ...], where: str) -> str:
    if value not in known:
        raise InvalidInput(f"{value!r:.60} is not known", where=where, expected=", ".join(known))
    return value
