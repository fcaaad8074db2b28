"""Import images with their labels, table and reference cameras: a folder on the server, or what somebody uploads.

Each image is a transaction of its own: a broken one fails alone, with its reason. What is there already is left as
it is, so that the same import again changes nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

from sqlalchemy import or_, select
from sqlalchemy.orm import Session

from app.db.models import Dataset
from app.db.session import Database
from app.errors import ClearLinesError, Unavailable
from app.formats.dataset import DatasetImage, read_dataset, reference_of
from app.formats.files import read_file
from app.formats.reference_camera import ReferenceCamera
from app.formats.segment_files import read_segments
from app.services.camera_references import stored_reference
from app.services.cameras import default_camera_name
from app.services.datasets import checked_dataset_name, create_dataset
from app.services.events import record_event
from app.services.image_adding import ReceivedImage, add_image, receive_image
from app.services.image_summaries import image_summaries
from app.services.import_reports import ExistingImage, FailedFile, FolderImport, ImportLimits, ImportReport
from app.services.labels import ImageLabels, import_labels
from app.storage import BlobStore

Progress = Callable[[int, int, str], None]


@dataclass(frozen=True)
class ImageSource:
    """Images to import, wherever they lie.

    Attributes:
        images: What is known of each.
        read: Returns the bytes of a path.
        cameras: Reference distortions by name of camera or image; ``*`` is for all.
    """

    images: Sequence[DatasetImage]
    read: Callable[[str], bytes]
    cameras: Mapping[str, ReferenceCamera] = field(default_factory=dict)


@dataclass(frozen=True)
class Importer:
    """What every image of one import needs.

    Attributes:
        dataset_id: Where the images go.
        now: When.
        person: Who imports.
        progress: Called after each image with how many are through, of how many, and its name.
    """

    database: Database
    blobs: BlobStore
    dataset_id: int
    now: datetime
    limits: ImportLimits = field(default_factory=ImportLimits)
    person: str | None = None
    progress: Progress | None = None


@dataclass
class _Outcome:
    """What became of the files so far."""

    added: list[int] = field(default_factory=list)
    existing: list[ExistingImage] = field(default_factory=list)
    failed: list[FailedFile] = field(default_factory=list)
    labels: int = 0

    def fail(self, name: str, error: ClearLinesError) -> None:
        self.failed.append(FailedFile(name, error.as_dict()))


def import_folder(
    database: Database,
    blobs: BlobStore,
    folder: Path,
    dataset_name: str,
    now: datetime,
    *,
    limits: ImportLimits | None = None,
    person: str | None = None,
    progress: Progress | None = None,
) -> FolderImport:
    """Import a dataset folder, or any folder of images, into the dataset of that name (or slug); it is made if new.

    Raises:
        NotFound: When there is no such folder, or no image in it.
        InvalidInput: When two images have one name, or an image has two label files.
        InvalidFile: On a broken ``images.csv`` or ``cameras.json``.
    """
    listed = read_dataset(folder)
    limits = limits or ImportLimits()
    with database.write() as session:
        dataset = _dataset_of_name(session, dataset_name, now, person)
    importer = Importer(database, blobs, dataset.id, now, limits, person, progress)

    def read(path: str) -> bytes:
        return read_file(folder / path, limit=limits.file_bytes, where=path)

    source = ImageSource(listed.images, read, listed.cameras)
    return FolderImport(dataset.slug, import_images(importer, source, folder.name))


def import_images(importer: Importer, source: ImageSource, origin: str) -> ImportReport:
    """Import images one by one.

    Args:
        importer: Where they go.
        source: Where they come from.
        origin: Name of the folder or file, for the audit.

    Raises:
        Unavailable: When nothing can be stored now; what was imported stays, and the same again goes on from there.
    """
    outcome = _Outcome()
    for number, entry in enumerate(source.images, start=1):
        try:
            _import_image(importer, source, entry, outcome)
        except Unavailable:  # nor would the next one be stored
            _report(importer, outcome, origin)
            raise
        except ClearLinesError as error:
            outcome.fail(entry.path, error)
        if importer.progress:
            importer.progress(number, len(source.images), entry.name)
    return _report(importer, outcome, origin)


def _import_image(importer: Importer, source: ImageSource, entry: DatasetImage, outcome: _Outcome) -> None:
    file_name = f"{entry.name}{Path(entry.path).suffix}"
    received = receive_image(importer.blobs, file_name, source.read(entry.path), max_pixels=importer.limits.max_pixels)
    labels = _read_labels(source, entry, outcome)
    with importer.database.write() as session:
        dataset = session.get_one(Dataset, importer.dataset_id)
        camera, reference = _camera_of(entry, received, source.cameras)
        added = add_image(
            session,
            importer.blobs,
            dataset,
            received,
            importer.now,
            camera=camera,
            source=entry.source,
            sequence=entry.sequence,
        )
        image = added.image
        if reference and image.camera.reference is None:
            image.camera.reference = stored_reference(reference, image.width, image.height)
        labelled = labels is not None and import_labels(
            session, image, labels, importer.now, person=importer.person, newly_added=not added.existing
        )
    outcome.labels += labelled
    if added.existing:
        outcome.existing.append(ExistingImage(received.name, image.id))
    else:
        outcome.added.append(image.id)


def _camera_of(
    entry: DatasetImage, received: ReceivedImage, cameras: Mapping[str, ReferenceCamera]
) -> tuple[str, ReferenceCamera | None]:
    """Return the name of an image's camera and its reference: one of its own makes a camera of its own."""
    if not entry.camera and entry.name in cameras:
        return entry.name, cameras[entry.name]
    name = entry.camera or default_camera_name(entry.name, received.header.width, received.header.height)
    return name, reference_of(name, name, cameras)


def _read_labels(source: ImageSource, entry: DatasetImage, outcome: _Outcome) -> ImageLabels | None:
    """Return an image's labels; a broken label file fails alone, and the image comes without labels."""
    if entry.labels is None and entry.ambiguous is None:
        return None
    try:
        labels, ambiguous = (
            None if path is None else read_segments(path, source.read(path)) for path in (entry.labels, entry.ambiguous)
        )
    except ClearLinesError as error:
        outcome.fail(error.where or entry.name, error)
        return None
    return ImageLabels(labels, ambiguous)


def _report(importer: Importer, outcome: _Outcome, origin: str) -> ImportReport:
    if outcome.added or outcome.labels:
        counts = {"added": len(outcome.added), "labels": outcome.labels, "failed": len(outcome.failed)}
        with importer.database.write() as session:
            record_event(
                session,
                "images.imported",
                importer.now,
                dataset_id=importer.dataset_id,
                person=importer.person,
                details={"from": origin, **counts},
            )
    with importer.database.read() as session:
        added = tuple(image_summaries(session, outcome.added))
    return ImportReport(added, tuple(outcome.existing), tuple(outcome.failed), outcome.labels)


def _dataset_of_name(session: Session, name: str, now: datetime, person: str | None) -> Dataset:
    name = checked_dataset_name(name)
    query = select(Dataset).where(Dataset.deleted_at.is_(None), or_(Dataset.name == name, Dataset.slug == name))
    found = session.scalars(query.order_by(Dataset.name != name).limit(1)).one_or_none()
    return found or create_dataset(session, name, now, person=person)
