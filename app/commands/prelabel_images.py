"""The images of a pre-labelling: where they lie, what they are called, and which of them share a lens."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from app.commands.paths import require_there
from app.errors import ClearLinesError, InvalidInput
from app.formats.dataset import DatasetImage, assign_cameras, read_dataset
from app.formats.files import read_file
from app.formats.naming import check_names, is_image_path, name_of
from app.images import ImageHeader, describe


@dataclass(frozen=True)
class FoundImage:
    """An image file.

    Attributes:
        name: Path under its folder without extension; results are named after it.
        path: The file.
        camera: Images of one camera share a lens.
        header: What the file says of itself; ``None`` if it can't be read.
        error: Why it can't.
    """

    name: str
    path: Path
    camera: str
    header: ImageHeader | None
    error: ClearLinesError | None = None


def find_prelabel_images(paths: Sequence[Path]) -> list[FoundImage]:
    """List the images of folders (subfolders included) and single files, by name.

    A file that is broken is listed with its error, so that it fails alone.

    Raises:
        NotFound: If a path doesn't exist, or a folder holds no image.
        InvalidInput: If a file is no image, or two images have one name.
    """
    require_there(paths)
    found = [image for path in paths for image in _images_under(path)]
    by_name: dict[str, FoundImage] = {}
    for image in found:
        if image.name in by_name:
            raise InvalidInput(
                f"two images are called {image.name}: {by_name[image.name].path} and {image.path}",
                expected="names (paths under the folder, without extension) that differ",
                hint="give the folder above both of them",
            )
        by_name[image.name] = image
    return sorted(found, key=lambda image: image.name)


def _images_under(path: Path) -> list[FoundImage]:
    if path.is_dir():
        dataset = read_dataset(path)
        return _described(path, dataset.images)
    if not is_image_path(path):
        raise InvalidInput("the file doesn't look like an image", where=str(path), expected=".png, .jpg, .tif ...")
    return _described(path.parent, [DatasetImage(name_of(path.name), path.name)])


def _described(root: Path, images: Sequence[DatasetImage]) -> list[FoundImage]:
    headers: dict[str, ImageHeader] = {}
    errors: dict[str, ClearLinesError] = {}
    for image in images:
        try:
            check_names([image.name], where=_printable(image.path))
            headers[image.name] = describe(read_file(root / image.path))
        except ClearLinesError as error:
            errors[image.name] = error
    sizes = {name: (header.width, header.height) for name, header in headers.items()}
    cameras = assign_cameras([image for image in images if image.name in sizes], sizes)
    return [
        FoundImage(
            _printable(image.name),
            root / image.path,
            cameras.get(image.name, ""),
            headers.get(image.name),
            errors.get(image.name),
        )
        for image in images
    ]


def _printable(name: str) -> str:
    """Return the name with what isn't UTF-8 spelt out; the file system takes any bytes, a report doesn't."""
    return name.encode("utf-8", "backslashreplace").decode()
