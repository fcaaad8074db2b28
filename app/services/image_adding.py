"""Add an image to a dataset: its bytes go to the store first, then its rows."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Review
from app.errors import ClearLinesError, InvalidInput, Unavailable
from app.formats.naming import check_image_name, check_names, composed, is_image_path, name_of
from app.images import ImageHeader, check_whole, describe
from app.services.blobs import add_blob_row
from app.services.cameras import camera_for, default_camera_name
from app.services.images import NAME_LENGTH, WORD_LENGTH, is_named, name_conflict
from app.storage import BlobStore


@dataclass(frozen=True)
class ReceivedImage:
    """An image file whose bytes are stored, not yet in any dataset.

    Attributes:
        file_name: Path under the root with extension, ``KITTI/000000.png``.
        name: The same without extension.
        sha256: Hash of the bytes.
        size: Number of bytes.
        header: What the file says of itself.
    """

    file_name: str
    name: str
    sha256: str
    size: int
    header: ImageHeader


@dataclass(frozen=True)
class AddedImage:
    """An image's row, and whether its content was in the dataset already."""

    image: Image
    existing: bool


def receive_image(blobs: BlobStore, file_name: str, data: bytes, *, max_pixels: int) -> ReceivedImage:
    """Check an image, without decoding its pixels, and store its bytes; needs no database.

    Raises:
        InvalidInput: When the path is none.
        InvalidImage: When it is no image of a kind that is read, or not whole.
        TooLarge: When it has too many pixels.
    """
    file_name = checked_file_name(file_name)
    try:
        header = describe(data, max_pixels=max_pixels)
        check_whole(data, header)
    except ClearLinesError as error:
        error.where = file_name
        raise
    return ReceivedImage(file_name, name_of(file_name), blobs.put(data), len(data), header)


def checked_file_name(file_name: str) -> str:
    """Return the path under the root with forward slashes, in Unicode's composed form.

    Raises:
        InvalidInput: When it is no path under a root, or too long.
    """
    path = composed(file_name.replace("\\", "/").removeprefix("./"))
    check_names([path], where="file name")
    if is_image_path(path):
        check_image_name(name_of(path), where="file name")
    if len(path) > NAME_LENGTH:
        raise InvalidInput("the path is too long", where=path[:60], expected=f"at most {NAME_LENGTH} characters")
    return path


def add_image(
    session: Session,
    blobs: BlobStore,
    dataset: Dataset,
    received: ReceivedImage,
    now: datetime,
    *,
    camera: str | None = None,
    source: str | None = None,
    sequence: str | None = None,
) -> AddedImage:
    """Add an image to a dataset; the same content again gives the image that is there.

    Args:
        session: A writing session.
        blobs: Where its bytes were stored.
        dataset: The dataset.
        received: The image.
        now: When.
        camera: Name of its camera; images of one folder and size share one when left out.
        source: Where it comes from; its folder when left out. The end of it, if it is too long.
        sequence: The drive it belongs to.

    Raises:
        Conflict: When another image of the dataset has its name.
        InvalidInput: When its camera takes images of another size.
    """
    session.refresh(
        dataset, with_for_update={"key_share": True}
    )  # of two that add the same at once, the second finds the first one's
    present = select(Image).where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None))
    same = session.scalars(present.where(Image.sha256 == received.sha256)).one_or_none()
    if same is not None:
        return AddedImage(same, existing=True)
    if other := session.scalars(present.where(is_named(received.name))).first():
        raise name_conflict(other.file_name, received.file_name)
    add_blob_row(session, received.sha256, received.size, received.header.media_type, now)
    if not blobs.exists(received.sha256):
        # a purge took the bytes between receiving them and now; from here on the blob's row protects them
        raise Unavailable("the file was purged while it was added", where=received.file_name, hint="add it again")
    header = received.header
    camera_name = camera or default_camera_name(received.name, header.width, header.height)
    image = Image(
        dataset_id=dataset.id,
        name=received.name,
        file_name=received.file_name,
        sha256=received.sha256,
        width=header.width,
        height=header.height,
        bits=header.bits,
        camera=camera_for(session, dataset, camera_name, header.width, header.height, now),
        source=(source or received.name.rpartition("/")[0])[-WORD_LENGTH:] or None,
        sequence=sequence or None,
        created_at=now,
        review=Review(status="open", updated_at=now),
    )
    session.add(image)
    session.flush()
    return AddedImage(image, existing=False)
