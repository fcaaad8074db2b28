"""Label files that come after their images: found by name among the images that the dataset has already."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from sqlalchemy import select

from app.db.models import Dataset, Image
from app.errors import ClearLinesError, InvalidFile
from app.formats.naming import name_segment_files
from app.formats.segment_files import read_segments
from app.services.events import record_event
from app.services.import_reports import FailedFile, ImportReport
from app.services.imports import Importer
from app.services.labels import ImageLabels, import_labels


def import_late_labels(importer: Importer, paths: Iterable[str], read: Callable[[str], bytes]) -> ImportReport:
    """Import label files of images that are in the dataset.

    Args:
        importer: Which dataset.
        paths: Of the files; a name is the path under ``labels/``, where there is one.
        read: Returns the bytes of a path.

    Raises:
        InvalidInput: When two files are for one image.
    """
    by_tail = {path.rpartition("labels/")[2]: path for path in paths}
    labels, ambiguous = name_segment_files(by_tail)
    failed: list[FailedFile] = []
    stored = 0
    for name in sorted({*labels, *ambiguous}):
        files = [by_tail[side[name]] if name in side else None for side in (labels, ambiguous)]
        try:
            stored += _import_one(importer, name, files, read)
        except ClearLinesError as error:
            failed.append(FailedFile(next(path for path in files if path), error.as_dict()))
    if stored:
        with importer.database.write() as session:
            record_event(
                session,
                "labels.imported",
                importer.now,
                dataset_id=importer.dataset_id,
                person=importer.person,
                details={"labels": stored, "failed": len(failed)},
            )
    return ImportReport(failed=tuple(failed), labels=stored)


def _import_one(importer: Importer, name: str, files: list[str | None], read: Callable[[str], bytes]) -> bool:
    labels, ambiguous = (None if path is None else read_segments(path, read(path)) for path in files)
    with importer.database.write() as session:
        dataset = session.get_one(Dataset, importer.dataset_id)
        query = select(Image).where(Image.dataset_id == dataset.id, Image.name == name, Image.deleted_at.is_(None))
        image = session.scalars(query).one_or_none()
        if image is None:
            raise InvalidFile(
                f"no image of {dataset.name} is named {name}",
                expected="labels NAME_edge_segments_filtered.npy beside, or after, the image NAME",
            )
        return import_labels(session, image, ImageLabels(labels, ambiguous), importer.now, person=importer.person)
