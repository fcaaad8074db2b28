"""Names of images, and which file belongs to which image.

A name is the path under the root without extension, ``KITTI/000000``, with forward slashes and in Unicode's composed
form, so that a folder from macOS matches one from Linux. A label or prediction file is called ``NAME``,
``NAME_edge_segments_filtered`` or, for labels that are not to be scored, ``NAME_edge_segments_ambiguous``.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import PurePath, PurePosixPath

from app.errors import InvalidFile, InvalidInput

FILTERED = "_edge_segments_filtered"
AMBIGUOUS = "_edge_segments_ambiguous"

PART_BYTES = 255 - len(f"{AMBIGUOUS}.npy")
"""Longest part of an image's name: file systems end at 255, and label files are named after the image."""

IMAGE_SUFFIXES = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp", ".pgm", ".ppm", ".pnm"})
SEGMENT_SUFFIXES = frozenset({".npy", ".npz", ".json"})
REPORTS = frozenset({"prelabel.json", "cameras.json", "camera.json", "summary.json"})
"""JSON files that may lie among segment files and hold no segments."""


@dataclass(frozen=True)
class Pairing:
    """Files found for images.

    Attributes:
        files: Path of the file by image name.
        ambiguous: Path of the file with ambiguous labels by image name.
        missing: Names of images without a file.
        extra: Paths of files that belong to no image.
    """

    files: Mapping[str, str]
    ambiguous: Mapping[str, str]
    missing: tuple[str, ...]
    extra: tuple[str, ...]

    def require_complete(self, what: str) -> None:
        """Refuse missing or extra files, naming all of them at once.

        Args:
            what: What the files are, ``predictions`` say.

        Raises:
            InvalidInput: If an image has no file or a file no image.
        """
        if not self.missing and not self.extra:
            return
        parts = [
            f"{len(names)} {word} ({', '.join(names)})"
            for word, names in (("missing", self.missing), ("extra", self.extra))
            if names
        ]
        raise InvalidInput(
            f"{what} don't fit the images: {'; '.join(parts)}",
            expected=f"one file for each image, called NAME or NAME{FILTERED}",
            details={"missing": list(self.missing), "extra": list(self.extra)},
        )


def name_of(path: str | PurePath) -> str:
    """Return the name of an image or file, given its path under the root."""
    text = path.as_posix() if isinstance(path, PurePath) else path
    return composed(PurePosixPath(text).with_suffix("").as_posix())


def composed(name: str) -> str:
    """Return the name in Unicode's composed form (NFC), in which names are compared."""
    return unicodedata.normalize("NFC", name)


def has_control_characters(text: str) -> bool:
    """Whether the text has characters that are no part of a name: controls, lone surrogates, line separators."""
    return any(unicodedata.category(character) in ("Cc", "Cs", "Zl", "Zp") for character in text)


def is_hidden(path: str | PurePath) -> bool:
    """Whether a path has a part that systems hide or add by themselves; such files are left out everywhere."""
    parts = PurePath(path).parts
    return any((part.startswith(".") and part != "..") or part == "__MACOSX" for part in parts)


def is_image_path(path: str | PurePath) -> bool:
    """Whether the path ends as an image does that is read."""
    return PurePath(path).suffix.lower() in IMAGE_SUFFIXES and not is_hidden(path)


def is_segment_path(path: str | PurePath) -> bool:
    """Whether the path ends as a file of segments does, and is no report or hidden file."""
    known = PurePath(path).suffix.lower() in SEGMENT_SUFFIXES
    return known and PurePath(path).name not in REPORTS and not is_hidden(path)


def name_images(paths: Iterable[str]) -> dict[str, str]:
    """Return path by name, sorted by name.

    Args:
        paths: Paths of images under the root.

    Raises:
        InvalidInput: If two images have one name, or names that differ in case only; all of them are named.
    """
    by_key: dict[str, list[str]] = {}
    for path in paths:
        by_key.setdefault(name_of(path).casefold(), []).append(path)
    twice = [sorted(same) for same in by_key.values() if len(same) > 1]
    if twice:
        raise InvalidInput(
            f"images of one name: {'; '.join(' and '.join(same) for same in sorted(twice))}",
            expected="names (paths without extension) that differ, not in case alone",
            hint="rename one of each, or put them into folders",
            details={"images": twice},
        )
    return {name_of(path): path for path in sorted((same[0] for same in by_key.values()), key=name_of)}


def segment_file_name(path: str | PurePath, images: Collection[str] = ()) -> tuple[str, bool]:
    """Return the image name that a segment file is for, and whether it holds ambiguous labels.

    Args:
        path: Path of the file under the root.
        images: Names of the images; a file called exactly as one is that image's, whatever the name ends with.
    """
    name = name_of(path)
    if name not in images:
        if name.endswith(FILTERED):
            return name.removesuffix(FILTERED), False
        if name.endswith(AMBIGUOUS):
            return name.removesuffix(AMBIGUOUS), True
    return name, False


def name_segment_files(paths: Iterable[str], images: Collection[str] = ()) -> tuple[dict[str, str], dict[str, str]]:
    """Return path by image name, of segment files and of those with ambiguous labels.

    Raises:
        InvalidInput: If two files are for one image; all such are named.
    """
    sides: tuple[dict[str, list[str]], dict[str, list[str]]] = ({}, {})
    for path in sorted(paths):
        name, ambiguous = segment_file_name(path, images)
        sides[ambiguous].setdefault(name, []).append(path)
    twice = [same for side in sides for same in side.values() if len(same) > 1]
    if twice:
        raise InvalidInput(
            f"several files for one image: {'; '.join(' and '.join(same) for same in twice)}",
            expected="one file per image",
            details={"files": twice},
        )
    first, second = ({name: same[0] for name, same in side.items()} for side in sides)
    return first, second


def pair_by_name(images: Collection[str], paths: Iterable[str]) -> Pairing:
    """Find the file of each image, by name alone.

    Args:
        images: Names of the images.
        paths: Paths of the segment files under their root.

    Raises:
        InvalidInput: If two files are for one image.
    """
    files, ambiguous = name_segment_files(paths, set(images))
    known = set(images)
    extra = [path for side in (files, ambiguous) for name, path in side.items() if name not in known]
    return Pairing(
        {name: path for name, path in files.items() if name in known},
        {name: path for name, path in ambiguous.items() if name in known},
        tuple(sorted(known - set(files))),
        tuple(sorted(extra)),
    )


def check_names(names: Iterable[str], *, where: str) -> None:
    """Refuse names that are no path under a root, as a file that lists names may hold.

    Raises:
        InvalidFile: With the first such name.
    """
    for name in names:
        parts = name.split("/")
        plain = not has_control_characters(name) and "\\" not in name and len(name) <= 1000
        if not plain or not all(part not in ("", ".", "..") for part in parts):
            raise InvalidFile(
                f"{name!r:.120} is no name of an image", where=where, expected="a path such as KITTI/000000"
            )


def check_image_name(name: str, *, where: str) -> None:
    """Refuse names that an image can't be exported and imported again under.

    Raises:
        InvalidFile: If it is no path under a root, hidden, or too long for the files that are named after it.
    """
    check_names([name], where=where)
    if is_hidden(name):
        raise InvalidFile(f"{name!r:.120} is a hidden file", where=where, expected="no part that begins with a dot")
    if any(len(part.encode()) > PART_BYTES for part in name.split("/")):
        raise InvalidFile(
            "the name of a file or folder is too long", where=where, expected=f"at most {PART_BYTES} bytes of UTF-8"
        )
