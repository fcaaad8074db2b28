"""Images of a submission with their numbers, sorted by any of them, and one image's place in that order."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import ColumnElement, Row, Select, select
from sqlalchemy.orm import Session

from app.db.models import ImageScore, Score, Split, SplitImage, Submission
from app.errors import Conflict, InvalidInput, NotFound
from app.services.paging import Page, checked_limit, read_cursor, write_cursor
from app.services.split_images import entry

METRICS = ("f1", "precision", "recall", "tp", "fp", "fn")
OF_JSON = (
    *("offset_mean", "angle_error", "mean_f1", "completeness", "correctness", "quality"),
    *("offset_p95", "bias", "translation_error", "mean_liou", "official_f1", "fixed_f1"),
)
SORTS = ("name", *METRICS, *OF_JSON)


@dataclass(frozen=True)
class ImageEntry:
    """The numbers of one image; ``None`` where one isn't defined."""

    image_id: int
    name: str
    thumbnail: str
    f1: float | None
    precision: float | None
    recall: float | None
    tp: int
    fp: int
    fn: int
    offset_mean: float | None
    angle_error: float | None


@dataclass(frozen=True)
class Neighbours:
    """Where an image stands in an order: ids of the split images before and after it, its place from 1, of how many."""

    previous: int | None
    next: int | None
    position: int
    total: int


def newest_score(session: Session, submission: Submission) -> Score:
    """Return the newest score of a submission that is made.

    Raises:
        Conflict: While there is none.
    """
    query = select(Score).where(Score.submission_id == submission.id, Score.status == "done").order_by(Score.id.desc())
    score = session.scalars(query.limit(1)).one_or_none()
    if score is None:
        raise Conflict(f"the submission is {submission.status}, not scored", hint="ask again once it is")
    return score


def list_image_scores(
    session: Session,
    split: Split,
    score: Score,
    *,
    sort: str = "name",
    search: str | None = None,
    limit: int = 100,
    cursor: str | None = None,
) -> Page[ImageEntry]:
    """Return the images of a score, page by page. Images without a value for the metric come last.

    Args:
        session: Any session.
        split: The submission's.
        score: Its score.
        sort: A metric or ``name``; with ``-`` in front the largest first.
        search: Part of the name, in any case.
        limit: Of a page.
        cursor: Of the page before.

    Raises:
        InvalidInput: On a sort, limit or cursor that can't be.
    """
    limit = checked_limit(limit)
    rows = _ordered(session, score, sort, search)
    start = 0
    if cursor is not None:
        _, last = read_cursor(sort, cursor)
        start = next((place + 1 for place, row in enumerate(rows) if row.id == last), len(rows))
    shown = rows[start : start + limit]
    more = start + limit < len(rows)
    following = write_cursor(sort, shown[-1].name, shown[-1].id) if more else None
    return Page(tuple(_entries(session, split, score, [row.id for row in shown])), following, len(rows))


def neighbours(
    session: Session, score: Score, image_id: int, *, sort: str = "name", search: str | None = None
) -> Neighbours:
    """Return an image's place in the order of ``list_image_scores``.

    Raises:
        NotFound: When the image isn't among them.
        InvalidInput: On a sort that can't be.
    """
    ids = [row.id for row in _ordered(session, score, sort, search)]
    if image_id not in ids:
        raise NotFound(f"the submission has no image {image_id}", hint="or none that the search finds")
    place = ids.index(image_id)
    return Neighbours(
        ids[place - 1] if place else None,
        ids[place + 1] if place + 1 < len(ids) else None,
        place + 1,
        len(ids),
    )


def _ordered(session: Session, score: Score, sort: str, search: str | None) -> list[Row[tuple[int, str, float | None]]]:
    """Return id, name and value of all images: a split has few enough to be sorted here, undefined values last."""
    name = sort.removeprefix("-")
    if name not in SORTS:
        raise InvalidInput(f"{sort!r:.60} is no order", where="sort", expected=", ".join(SORTS) + ", with - or without")
    query: Select = select(SplitImage.id, SplitImage.name, _value(name).label("value")).join(
        ImageScore, ImageScore.split_image_id == SplitImage.id
    )
    query = query.where(ImageScore.score_id == score.id)
    if search:
        query = query.where(SplitImage.name.icontains(search, autoescape=True))
    rows = list(session.execute(query).all())
    down = -1 if sort.startswith("-") else 1
    if name == "name":
        return sorted(rows, key=lambda row: row.name, reverse=down < 0)
    return sorted(rows, key=lambda row: (row.value is None, 0 if row.value is None else down * row.value, row.name))


def _value(name: str) -> ColumnElement:
    if name == "name":
        return SplitImage.ordinal.expression
    if name in METRICS:
        return getattr(ImageScore, name).expression
    return ImageScore.metrics[name].as_float()


def _entries(session: Session, split: Split, score: Score, ids: list[int]) -> list[ImageEntry]:
    rows = session.execute(
        select(SplitImage, ImageScore)
        .join(ImageScore, ImageScore.split_image_id == SplitImage.id)
        .where(ImageScore.score_id == score.id, SplitImage.id.in_(ids))
    ).all()
    found = {image.id: (image, numbers) for image, numbers in rows}
    return [_entry(split, *found[image_id]) for image_id in ids]


def _entry(split: Split, image: SplitImage, numbers: ImageScore) -> ImageEntry:
    metrics = numbers.metrics or {}
    return ImageEntry(
        image_id=image.id,
        name=image.name,
        thumbnail=entry(split, image).thumbnail,
        f1=numbers.f1,
        precision=numbers.precision,
        recall=numbers.recall,
        tp=numbers.tp,
        fp=numbers.fp,
        fn=numbers.fn,
        offset_mean=metrics.get("offset_mean"),
        angle_error=metrics.get("angle_error"),
    )
