"""The lines that a camera is calibrated from: candidates found in images, labels of a dataset, or files of segments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from app.calibration.calibrate import CalibrationImage
from app.commands.calibrate_detection import Progress, detect_candidates
from app.commands.prelabel_images import FoundImage, find_prelabel_images
from app.commands.segment_files import Read, one_error, open_segment_files, read_segment_file
from app.errors import ClearLinesError, InvalidFile, InvalidInput, NotFound
from app.formats.dataset import read_dataset
from app.formats.labelled import LabelledSegments
from app.formats.naming import is_image_path, is_segment_path, name_of
from app.formats.reference_camera import ALL, ReferenceCamera
from app.vision.distortion import estimate_distortion
from app.vision.segments import Segments
from app.vision.straightness import judge_straightness

Source = Literal["labels", "candidates"]


@dataclass(frozen=True, eq=False)
class CameraLines:
    """What one camera is calibrated from.

    Attributes:
        name: Of the camera.
        size: Width and height of its images, px.
        source: Whether a person kept the lines, or they are candidates with probabilities.
        images: Their lines.
        files: Image files by name; empty where there are only labels.
        reference: Calibration that the dataset's ``cameras.json`` has for the camera.
    """

    name: str
    size: tuple[int, int]
    source: Source
    images: tuple[CalibrationImage, ...]
    files: Mapping[str, Path] = field(default_factory=dict)
    reference: ReferenceCamera | None = None


@dataclass(frozen=True, eq=False)
class GatheredLines:
    """The cameras, and why images failed, by name."""

    cameras: tuple[CameraLines, ...]
    failed: Mapping[str, ClearLinesError]


def gather_lines(
    paths: Sequence[Path],
    *,
    labels: Path | None = None,
    size: tuple[int, int] | None = None,
    camera: str | None = None,
    workers: int = 1,
    progress: Progress | None = None,
) -> GatheredLines:
    """Find what there is to calibrate from.

    Args:
        paths: Folders or files: images, datasets (images with labels), or segments alone.
        labels: Folder of label files for the images.
        size: Width and height of the images in px; for segments without images.
        camera: The only camera that is wanted.
        workers: Processes that detect.
        progress: Called as images are done.

    Raises:
        NotFound: If a path doesn't exist, or there is neither an image nor a file of segments.
        InvalidInput: On images without readable lines, a camera of several image sizes, or a missing size.
        InvalidFile: If label files can't be read; all of them are named.
    """
    if not any(_has_images(path) for path in paths):
        return GatheredLines(tuple(_from_segment_files(path, size) for path in paths), {})
    found = find_prelabel_images(paths)
    failed = {image.name: image.error for image in found if image.error is not None}
    if len(failed) == len(found):
        raise InvalidInput(f"no image could be read: {'; '.join(map(str, list(failed.values())[:3]))}")
    cameras = _by_camera([image for image in found if image.error is None], camera)
    readers = _label_readers(paths, labels, {image.name for image in found})
    references = {
        name: known for path in filter(Path.is_dir, paths) for name, known in read_dataset(path).cameras.items()
    }
    if readers:
        return GatheredLines(_with_references(_from_labels(cameras, readers), references), failed)
    found = detect_candidates([image for members in cameras.values() for image in members], workers, progress)
    failed |= found.failed
    detected = {
        name: kept
        for name, members in cameras.items()
        if (kept := [image for image in members if image.name in found.segments])
    }
    lines = [_from_candidates(name, members, found.segments) for name, members in detected.items()]
    return GatheredLines(_with_references(lines, references), failed)


def _has_images(path: Path) -> bool:
    if not path.is_dir():
        return is_image_path(path)
    return any(is_image_path(file.relative_to(path)) for file in path.rglob("*") if file.is_file())


def _by_camera(images: Sequence[FoundImage], camera: str | None) -> dict[str, list[FoundImage]]:
    cameras: dict[str, list[FoundImage]] = {}
    for image in images:
        cameras.setdefault(image.camera, []).append(image)
    if camera is not None and camera not in cameras:
        raise NotFound(f"there is no camera {camera!r}", where="--camera", expected=", ".join(sorted(cameras)))
    return cameras if camera is None else {camera: cameras[camera]}


def _size_of(name: str, images: Sequence[FoundImage]) -> tuple[int, int]:
    sizes = sorted({(image.header.width, image.header.height) for image in images if image.header is not None})
    if len(sizes) != 1:
        raise InvalidInput(
            f"its images are of {len(sizes)} sizes: {', '.join(f'{width} x {height}' for width, height in sizes)}",
            where=f"camera {name}",
            expected="one size",
        )
    return sizes[0]


def _label_readers(paths: Sequence[Path], labels: Path | None, images: set[str]) -> dict[str, Read]:
    """Return what reads the labels of an image, by name; empty where there are none."""
    if labels is not None:
        readers = dict(open_segment_files(labels, "label", images).files)
        if images.isdisjoint(readers):
            raise NotFound("no label file is for any of the images", where=str(labels), expected="files named NAME")
        return readers
    found: dict[str, Read] = {}
    for path in filter(Path.is_dir, paths):
        for image in read_dataset(path).images:
            if image.labels is not None:
                found[image.name] = _reader(path / image.labels)
    return found


def _reader(path: Path) -> Read:
    return lambda: read_segment_file(path)


def _from_labels(cameras: Mapping[str, Sequence[FoundImage]], readers: Mapping[str, Read]) -> tuple[CameraLines, ...]:
    """Return the kept lines of all labelled images; images that nobody labelled are left out."""
    errors: list[ClearLinesError] = []
    lines: list[CameraLines] = []
    for name, members in cameras.items():
        labelled = [image for image in members if image.name in readers]
        images: list[CalibrationImage] = []
        for image in labelled:
            try:
                images.append(_calibration_image(image.name, readers[image.name]()))
            except ClearLinesError as error:
                errors.append(error)
        if images:
            files = {image.name: image.path for image in labelled}
            lines.append(CameraLines(name, _size_of(name, labelled), _source(images), tuple(images), files))
    if errors:
        raise one_error(errors)
    return tuple(lines)


def _from_segment_files(path: Path, size: tuple[int, int] | None) -> CameraLines:
    readers = _segment_readers(path)
    if size is None:
        raise InvalidInput(
            "segments alone don't tell how large the images are", where=str(path), expected="--size WIDTHxHEIGHT"
        )
    images = [_calibration_image(name, read()) for name, read in sorted(readers.items())]
    return CameraLines(path.stem or "camera", size, _source(images), tuple(images))


def _segment_readers(path: Path) -> Mapping[str, Read]:
    if path.is_dir():
        readers = open_segment_files(path, "label").files
        if not readers:
            raise NotFound(
                "there is neither an image nor a file of segments",
                where=str(path),
                expected=".png, .jpg, .npy, .npz...",
            )
        return readers
    if not is_segment_path(path):
        raise InvalidInput(
            "the file is neither an image nor one of segments",
            where=str(path),
            expected=".png, .jpg, .npy, .npz, .json",
        )
    try:
        one = read_segment_file(path)
    except InvalidFile as error:  # it may be the one file for all images
        try:
            return open_segment_files(path, "label").files
        except InvalidFile:
            raise error from None
    return {name_of(path.name): lambda: one}


def _calibration_image(name: str, labelled: LabelledSegments) -> CalibrationImage:
    """Return the kept lines; without verdicts all of them, with the straightness that pre-labelling gave them."""
    if labelled.verdicts is not None:
        return CalibrationImage(name, labelled.with_verdict("keep").segments)
    straightness = None if labelled.straightness is None else labelled.straightness.astype(float)
    return CalibrationImage(name, labelled.segments, straightness)


def _source(images: Sequence[CalibrationImage]) -> Source:
    return "labels" if all(image.probability is None for image in images) else "candidates"


def _from_candidates(name: str, members: Sequence[FoundImage], found: Mapping[str, Segments]) -> CameraLines:
    """Return a camera's candidates with their probability of being straight under its first estimate of the lens."""
    size = _size_of(name, members)
    estimate = estimate_distortion([found[image.name] for image in members], size)
    images = [
        CalibrationImage(image.name, found[image.name], judge_straightness(found[image.name], estimate).astype(float))
        for image in members
    ]
    return CameraLines(name, size, "candidates", tuple(images), {image.name: image.path for image in members})


def _with_references(
    cameras: Sequence[CameraLines], references: Mapping[str, ReferenceCamera]
) -> tuple[CameraLines, ...]:
    """Give each camera the dataset's own reference, if that is for images of its size."""
    known = [references.get(camera.name) or references.get(ALL) for camera in cameras]
    return tuple(
        replace(camera, reference=reference)
        if reference is not None and (reference.width, reference.height) == camera.size
        else camera
        for camera, reference in zip(cameras, known, strict=True)
    )
