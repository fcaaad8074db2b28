"""The images of a frozen version: listed, and found for their pixels; they outlive their dataset."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import Split, SplitImage, SplitVersion
from app.errors import NotFound
from app.formats.submission_files import ExpectedImage
from app.services.paging import Order, Page, checked_limit, page_of

BY_ORDINAL = Order("ordinal", SplitImage.ordinal, SplitImage.id)


@dataclass(frozen=True)
class SplitImageEntry:
    """What a detector needs to know of an image; nothing of its labels.

    Attributes:
        id: Of the split's image, not of the dataset's.
        original: Address of the file as it was uploaded; ``display`` and ``thumbnail`` are for browsers.
    """

    id: int
    name: str
    width: int
    height: int
    source: str | None
    sequence: str | None
    original: str
    display: str
    thumbnail: str


def list_split_images(
    session: Session, split: Split, version: SplitVersion, *, limit: int = 100, cursor: str | None = None
) -> Page[SplitImageEntry]:
    """Return a page of a version's images, by name.

    Raises:
        InvalidInput: On a limit or cursor that can't be.
    """
    limit = checked_limit(limit)
    query = select(SplitImage).where(SplitImage.version_id == version.id)
    total = session.scalar(select(func.count()).select_from(query.subquery())) or 0
    if cursor:
        query = query.where(BY_ORDINAL.after(cursor))
    rows = session.scalars(query.order_by(*BY_ORDINAL.clauses()).limit(limit + 1)).all()
    page = page_of(rows, limit, BY_ORDINAL, lambda image: (image.ordinal, image.id), total)
    return page.map(lambda image: entry(split, image))


def get_split_image(session: Session, split: Split, split_image_id: int) -> SplitImage:
    """Return an image of a split, of any of its versions.

    Raises:
        NotFound: When the split has none of that id.
    """
    query = (
        select(SplitImage)
        .join(SplitVersion, SplitVersion.id == SplitImage.version_id)
        .where(SplitImage.id == split_image_id, SplitVersion.split_id == split.id)
    )
    image = session.scalars(query).one_or_none()
    if image is None:
        raise NotFound(f"the split {split.name} has no image {split_image_id}")
    return image


def expected_images(session: Session, version_id: int) -> list[ExpectedImage]:
    """Return names and sizes of the images of a split version, in its order."""
    rows = session.execute(
        select(SplitImage.name, SplitImage.width, SplitImage.height)
        .where(SplitImage.version_id == version_id)
        .order_by(SplitImage.ordinal)
    )
    return [ExpectedImage(row.name, row.width, row.height) for row in rows]


def entry(split: Split, image: SplitImage) -> SplitImageEntry:
    """Return an image as lists show it."""
    address = image_address(split.slug, image.id)
    return SplitImageEntry(
        id=image.id,
        name=image.name,
        width=image.width,
        height=image.height,
        source=image.source,
        sequence=image.sequence,
        original=f"{address}/original",
        display=f"{address}/display",
        thumbnail=f"{address}/thumbnail",
    )


def image_address(split_slug: str, split_image_id: int) -> str:
    """Return where the pixels of a split's image are: this with ``/original``, ``/display`` or ``/thumbnail``."""
    return f"/api/splits/{split_slug}/images/{split_image_id}"
