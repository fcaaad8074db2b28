"""Import what somebody uploads: images one by one, with their labels beside them, or zips of all that."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import BinaryIO

from app.errors import ClearLinesError, Conflict, InvalidFile, InvalidInput, TooLarge, Unavailable
from app.formats.archives import open_archive
from app.formats.dataset import list_images
from app.formats.layout import find_layout
from app.formats.naming import is_hidden, is_image_path, is_segment_path, name_of
from app.formats.reference_camera import read_cameras
from app.services.image_adding import checked_file_name
from app.services.import_reports import FailedFile, ImportReport
from app.services.imports import ImageSource, Importer, import_images
from app.services.late_labels import import_late_labels

TABLES = frozenset({"images.csv", "cameras.json", "camera.json"})


@dataclass(frozen=True)
class UploadedFile:
    """A file as it was uploaded.

    Attributes:
        name: Its name, perhaps a path: ``KITTI/000000.png``.
        stream: Its bytes, seekable.
    """

    name: str
    stream: BinaryIO


def import_upload(importer: Importer, files: Sequence[UploadedFile]) -> ImportReport:
    """Import uploaded files. Loose files are taken together as one dataset, each zip as one of its own.

    A file that can't be used fails alone, with its reason.

    Raises:
        InvalidInput: When nothing could be used; ``details["failed"]`` has each file with its reason.
        Unavailable: When nothing can be stored now, as `app.services.imports.import_images`.
    """
    reports: list[ImportReport] = []
    loose: dict[str, UploadedFile] = {}
    for file in files:
        try:
            if is_hidden(file.name.replace("\\", "/").removeprefix("./")):
                continue
            path = checked_file_name(file.name)
            if path.lower().endswith(".zip"):
                reports.append(_import_zip(importer, file))
            elif path in loose:
                raise Conflict("the file was given twice", where=path)
            else:
                loose[path] = file
        except Unavailable:
            raise
        except ClearLinesError as error:
            reports.append(_failure(file.name, error))
    if loose:
        reports += _import_loose(importer, loose)
    report = _joined(reports)
    if not (report.added or report.existing or report.labels):
        raise _nothing_used(report.failed)
    return report


def _import_zip(importer: Importer, file: UploadedFile) -> ImportReport:
    file.stream.seek(0)
    with open_archive(file.stream, where=file.name, limits=importer.limits.archive) as archive:
        members = {member.path: member for member in archive.members}
        layout = find_layout(members)
        if not layout.images:
            raise InvalidFile("the zip holds no image", where=file.name, expected="images/**/*.png, or any images")

        def read(path: str) -> bytes:
            _check_size(path, members[path].size, importer.limits.file_bytes)
            return archive.read(members[path])

        images = list_images(layout, read(layout.images_csv) if layout.images_csv else None)
        cameras = read_cameras(read(layout.cameras_json)) if layout.cameras_json else {}
        return import_images(importer, ImageSource(images, read, cameras), file.name)


def _import_loose(importer: Importer, files: Mapping[str, UploadedFile]) -> list[ImportReport]:
    def read(path: str) -> bytes:
        stream = files[path].stream
        stream.seek(0)
        data = stream.read(importer.limits.file_bytes + 1)
        _check_size(path, len(data), importer.limits.file_bytes)
        return data

    refused = _refused(files)
    reports = [_failure(path, error) for path, error in refused.items()]
    layout = find_layout(path for path in files if path not in refused)
    images, cameras = list_images(layout, None), {}
    # a table that can't be used says nothing; the images come without it
    if layout.images_csv:
        try:
            images = list_images(layout, read(layout.images_csv))
        except ClearLinesError as error:
            reports.append(_failure(layout.images_csv, error))
    if layout.cameras_json:
        try:
            cameras = read_cameras(read(layout.cameras_json))
        except ClearLinesError as error:
            reports.append(_failure(layout.cameras_json, error))
    reports.append(import_images(importer, ImageSource(images, read, cameras), "upload"))
    if layout.extra_labels:
        reports.append(import_late_labels(importer, layout.extra_labels, read))
    return reports


def _refused(paths: Collection[str]) -> dict[str, ClearLinesError]:
    """Return the files that can't be meant: neither image nor labels nor table, or two images of one name."""
    refused: dict[str, ClearLinesError] = {}
    names = Counter(name_of(path).casefold() for path in paths if is_image_path(path))
    for path in paths:
        if is_image_path(path):
            if names[name_of(path).casefold()] > 1:
                same = sorted(other for other in paths if name_of(other).casefold() == name_of(path).casefold())
                refused[path] = Conflict(
                    f"images of one name: {' and '.join(same)}",
                    where=path,
                    expected="names (paths without extension) that differ, not in case alone",
                    hint="rename one of them or put it into another folder",
                    details={"images": same},
                )
        elif not is_segment_path(path) and PurePosixPath(path).name not in TABLES:
            refused[path] = InvalidFile(
                "this is no image, label file or zip",
                where=path,
                expected="PNG, JPEG, TIFF, BMP, WebP or PNM; .npy, .npz or .json labels; images.csv, cameras.json",
            )
    return refused


def _joined(reports: Sequence[ImportReport]) -> ImportReport:
    return ImportReport(
        added=tuple(image for report in reports for image in report.added),
        existing=tuple(image for report in reports for image in report.existing),
        failed=tuple(file for report in reports for file in report.failed),
        labels=sum(report.labels for report in reports),
    )


def _failure(name: str, error: ClearLinesError) -> ImportReport:
    return ImportReport(failed=(FailedFile(name, error.as_dict()),))


def _nothing_used(failed: Sequence[FailedFile]) -> InvalidInput:
    if not failed:
        raise InvalidInput(
            "there is no image among the files",
            expected="images, labels, or zips of them",
            hint="hidden files don't count",
        )
    first = failed[0]
    several = f"none of {len(failed)} files could be used; the first, {first.name}: " if len(failed) > 1 else ""
    return InvalidInput(
        several + first.error["message"],
        where=None if several else first.name,
        expected=first.error.get("expected"),
        hint=first.error.get("hint"),
        details={"failed": [{"name": file.name, "error": file.error} for file in failed[:1000]]},
    )


def _check_size(path: str, size: int, limit: int) -> None:
    if size > limit:
        raise TooLarge(f"the file has more than {limit:,} bytes", where=path, expected=f"at most {limit:,}")
