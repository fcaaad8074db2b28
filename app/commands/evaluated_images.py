"""What is known of the images of an evaluation: size, source, sequence and camera."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from app.errors import ClearLinesError
from app.evaluation.split_image import SplitImageInfo
from app.formats.dataset import DatasetImage, assign_cameras, folder_of, reference_of
from app.formats.files import read_file
from app.formats.images_csv import ImageRow, read_images_csv
from app.formats.reference_camera import ReferenceCamera, read_cameras
from app.images import describe

_TABLE = "images.csv"
_CAMERAS = ("cameras.json", "camera.json")


def describe_images(names: Sequence[str], folder: Path | None, found: Mapping[str, Path]) -> list[SplitImageInfo]:
    """Describe images as far as files say anything.

    The table of sources, sequences and cameras (``images.csv``) and the reference distortions (``cameras.json``) lie
    beside the image folder, as in a ClearLines dataset, or in it.

    Args:
        names: Names of the scored images.
        folder: The image folder, if there is one.
        found: Image files by name, of the scored images and perhaps of others.

    Raises:
        InvalidFile: On a broken table or camera file.
        TooLarge: If one is over the limits.
    """
    table = _beside(folder, (_TABLE,))
    rows = {} if table is None else read_images_csv(read_file(table), {*names, *found}, where=str(table))
    references = _beside(folder, _CAMERAS)
    cameras = {} if references is None else read_cameras(read_file(references), where=str(references))
    sizes = {name: size for name in names if name in found and (size := _size(found[name])) is not None}
    of_name = {name: rows.get(name, ImageRow()) for name in names}
    stated = [DatasetImage(name, "", camera=of_name[name].camera) for name in sizes]
    camera_names = assign_cameras(stated, sizes)
    return [
        SplitImageInfo(
            name,
            *sizes.get(name, (None, None)),
            source=row.source or folder_of(name) or None,
            sequence=row.sequence or None,
            camera=camera_names.get(name),
            reference=_reference(name, camera_names.get(name, ""), cameras),
        )
        for name, row in of_name.items()
    ]


def _beside(folder: Path | None, names: Sequence[str]) -> Path | None:
    if folder is None:
        return None
    places = (place / name for place in (folder.absolute().parent, folder) for name in names)
    return next((place for place in places if place.is_file()), None)


def _size(image: Path) -> tuple[int, int] | None:
    """Return width and height; a broken image costs its picture, not its score."""
    try:
        header = describe(read_file(image))
    except ClearLinesError:
        return None
    return header.width, header.height


def _reference(name: str, camera: str, cameras: Mapping[str, ReferenceCamera]) -> dict[str, Any] | None:
    reference = reference_of(name, camera, cameras)
    return None if reference is None else reference.as_dict()
