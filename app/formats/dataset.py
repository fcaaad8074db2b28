"""The paper's dataset layout: ``images/**/STEM.png``, ``labels/**/STEM_edge_segments_filtered.npy``, and what we add.

What we add lies beside it and is optional: ``STEM_edge_segments_ambiguous.npy``, ``images.csv``, ``cameras.json``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from app.errors import NotFound
from app.formats.images_csv import ImageRow, read_images_csv, write_images_csv
from app.formats.label_npy import write_label_npy
from app.formats.labelled import LabelledSegments
from app.formats.labelled_image import LabelledImage
from app.formats.layout import Layout, find_layout
from app.formats.naming import AMBIGUOUS, FILTERED
from app.formats.reference_camera import ALL, ReferenceCamera, read_cameras, write_cameras


@dataclass(frozen=True)
class DatasetImage:
    """One image of a dataset.

    Attributes:
        name: Path under ``images/`` without extension.
        path: Where the image lies: under the folder, or in the zip.
        labels: Where its labels lie, if it has any.
        ambiguous: Where its ambiguous labels lie, if it has any.
        camera: As ``images.csv`` says; empty if it doesn't, see `assign_cameras`.
        source: As ``images.csv`` says, else the image's folder; may be empty.
        sequence: As ``images.csv`` says; may be empty.
    """

    name: str
    path: str
    labels: str | None = None
    ambiguous: str | None = None
    camera: str = ""
    source: str = ""
    sequence: str = ""


@dataclass(frozen=True)
class DatasetFolder:
    """A dataset on disk.

    Attributes:
        root: The folder.
        images: Its images, sorted by name.
        cameras: Reference distortions by name of camera or image; ``*`` is for all.
        extra_labels: Label files that belong to no image, for a warning.
    """

    root: Path
    images: tuple[DatasetImage, ...]
    cameras: Mapping[str, ReferenceCamera]
    extra_labels: tuple[str, ...] = ()


def read_dataset(folder: Path) -> DatasetFolder:
    """List a dataset folder, or a plain folder of images; reads no image and no label.

    Raises:
        NotFound: If there is no such folder or no image in it.
        InvalidInput: If two images have one name, or an image has two label files.
        InvalidFile: On a broken ``images.csv`` or ``cameras.json``.
    """
    if not folder.is_dir():
        raise NotFound("there is no such folder", where=str(folder))
    layout = find_layout(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    if not layout.images:
        raise NotFound("there is no image in the folder", where=str(folder), expected="images/**/*.png, or any images")

    def read(path: str | None) -> bytes | None:
        return None if path is None else (folder / path).read_bytes()

    images = list_images(layout, read(layout.images_csv))
    cameras = read(layout.cameras_json)
    return DatasetFolder(folder, images, {} if cameras is None else read_cameras(cameras), layout.extra_labels)


def list_images(layout: Layout, images_csv: bytes | None) -> tuple[DatasetImage, ...]:
    """Join the layout with its ``images.csv``; for a zip, whose members the caller reads.

    Raises:
        InvalidFile: On a broken table.
    """
    rows = read_images_csv(images_csv, layout.images) if images_csv is not None else {}
    found: list[DatasetImage] = []
    for name, path in layout.images.items():
        row = rows.get(name, ImageRow())
        found.append(
            DatasetImage(
                name,
                path,
                layout.labels.get(name),
                layout.ambiguous.get(name),
                row.camera,
                row.source or folder_of(name),
                row.sequence,
            )
        )
    return tuple(found)


def folder_of(name: str) -> str:
    """Return the folder part of an image's name, empty at the top."""
    parent = PurePosixPath(name).parent.as_posix()
    return "" if parent == "." else parent


def assign_cameras(images: Iterable[DatasetImage], sizes: Mapping[str, tuple[int, int]]) -> dict[str, str]:
    """Return the camera of each image: as stated, else images of one folder and size are one camera.

    Args:
        images: The images.
        sizes: (width, height) in px by image name.
    """
    cameras: dict[str, str] = {}
    for image in images:
        width, height = sizes[image.name]
        cameras[image.name] = image.camera or f"{folder_of(image.name)} {width}x{height}".strip()
    return cameras


def reference_of(image: str, camera: str, cameras: Mapping[str, ReferenceCamera]) -> ReferenceCamera | None:
    """Return an image's reference distortion: its own, else its camera's, else the one for all."""
    return cameras.get(image) or cameras.get(camera) or cameras.get(ALL)


def write_dataset(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Write a dataset, member by member.

    Kept segments become labels, ambiguous ones lie beside them; the format holds no others. An image without labels
    gets an empty label file: somebody looked at it. Fill a folder or a zip with `app.formats.members`.

    Yields:
        Path and content of each file.
    """
    rows: list[tuple[str, ImageRow]] = []
    cameras: dict[str, ReferenceCamera] = {}
    for image in images:
        if image.content is not None:
            yield f"images/{image.file_name}", image.content()
        kept, ambiguous = split_labels(image.labelled)
        yield f"labels/{image.name}{FILTERED}.npy", write_label_npy(kept.segments)
        if len(ambiguous):
            yield f"labels/{image.name}{AMBIGUOUS}.npy", write_label_npy(ambiguous.segments)
        rows.append((image.name, ImageRow(image.camera, image.source, image.sequence)))
        if image.reference is not None:
            cameras[image.camera or image.name] = image.reference
    yield "images.csv", write_images_csv(rows)
    if cameras:
        yield "cameras.json", write_cameras(cameras)


def split_labels(labelled: LabelledSegments) -> tuple[LabelledSegments, LabelledSegments]:
    """Return the kept and the ambiguous segments; without verdicts all are kept."""
    if labelled.verdicts is None:
        return labelled, labelled.select([])
    return labelled.with_verdict("keep"), labelled.with_verdict("ambiguous")
