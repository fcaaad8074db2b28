"""Where the parts of a dataset lie, told from paths alone: the same for a folder and for a zip."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from app.formats.naming import is_image_path, is_segment_path, name_images, pair_by_name


@dataclass(frozen=True)
class Layout:
    """Paths of a dataset's parts, as they were given.

    Attributes:
        images: Path by image name, sorted by name.
        labels: Path of the label file by image name.
        ambiguous: Path of the file with ambiguous labels by image name.
        images_csv: Path of the table of cameras, sources and sequences.
        cameras_json: Path of the reference distortions.
        extra_labels: Label files that belong to no image.
    """

    images: Mapping[str, str]
    labels: Mapping[str, str]
    ambiguous: Mapping[str, str]
    images_csv: str | None = None
    cameras_json: str | None = None
    extra_labels: tuple[str, ...] = ()


def find_layout(paths: Iterable[str]) -> Layout:
    """Find images and labels among paths with forward slashes.

    With an ``images/`` folder, at the top or one or more folders down (a zipped folder), names are paths under it, and
    labels lie in ``labels/`` beside it. Without one every image counts and names are paths under the top; labels lie in
    ``labels/`` or beside their image.

    Raises:
        InvalidInput: If two images have one name or an image has two label files.
    """
    given = sorted(paths)
    base = _base(given)
    inner = {path[len(base) :]: path for path in given if path.startswith(base)}
    folder = "images/" if any(path.startswith("images/") and is_image_path(path) for path in inner) else ""
    pictures = [path for path in inner if is_image_path(path)]
    images = {path[len(folder) :]: inner[path] for path in pictures if path.startswith(folder)}
    names = name_images(images)
    segment_files = [path for path in inner if is_segment_path(path)]
    label_folder = "labels/" if folder or any(path.startswith("labels/") for path in segment_files) else ""
    labels = {path[len(label_folder) :]: inner[path] for path in segment_files if path.startswith(label_folder)}
    pairing = pair_by_name(names, labels)
    cameras = next((name for name in ("cameras.json", "camera.json") if name in inner), None)
    return Layout(
        images={name: images[path] for name, path in names.items()},
        labels={name: labels[path] for name, path in pairing.files.items()},
        ambiguous={name: labels[path] for name, path in pairing.ambiguous.items()},
        images_csv=inner.get("images.csv"),
        cameras_json=inner[cameras] if cameras else None,
        extra_labels=tuple(labels[path] for path in pairing.extra),
    )


def _base(paths: list[str]) -> str:
    """Return the folder, with its slash, that holds the one ``images/`` highest up; empty if there are several."""
    bases: set[str] = set()
    for path in paths:
        parts = PurePosixPath(path).parts[:-1]
        if "images" in parts and is_image_path(path):
            bases.add("".join(f"{part}/" for part in parts[: parts.index("images")]))
    depth = min((base.count("/") for base in bases), default=0)
    highest = [base for base in bases if base.count("/") == depth]
    return highest[0] if len(highest) == 1 else ""
