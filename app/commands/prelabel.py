"""``clearlines prelabel``: the pipeline over image files, without server or database."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from app import __version__
from app.commands.detection_cache import FOLDER, DetectionCache
from app.commands.prelabel_images import FoundImage, find_prelabel_images
from app.commands.whole_files import json_bytes, write_whole
from app.errors import ClearLinesError, InvalidInput
from app.formats.files import read_file
from app.formats.json_writer import write_json
from app.formats.label_npy import write_label_npy
from app.formats.labelled import LabelledSegments
from app.formats.naming import FILTERED
from app.formats.npz import write_npz
from app.images import MAX_PIXELS
from app.jobs.mapping import map_in_processes
from app.jobs.tasks import DetectionResult, detect_task, estimate_task, judge_task
from app.vision import DetectionParameters

Format = Literal["npz", "json", "npy"]
CameraMode = Literal["joint", "per-image"]
Progress = Callable[[int, int], None]
PASSES = 0.5

WRITERS: Mapping[str, tuple[str, Callable[[LabelledSegments], bytes]]] = {
    "npz": (".npz", write_npz),
    "json": (".json", write_json),
    "npy": (f"{FILTERED}.npy", lambda labelled: write_label_npy(labelled.segments)),
}


@dataclass(frozen=True)
class PrelabelChoice:
    """How to pre-label.

    Attributes:
        parameters: Of the detection.
        camera: Whether the images of a camera share one lens, or each has its own.
        discard: Drop candidates that fail straightness, as the paper does.
        format: Of the files per image.
        workers: Number of processes.
    """

    parameters: DetectionParameters
    camera: CameraMode = "joint"
    discard: bool = False
    format: Format = "npz"
    workers: int = 1


@dataclass(frozen=True)
class PrelabelReport:
    """What came of it.

    Attributes:
        output: The folder.
        images: Names of the images that were finished.
        candidates: Segments written.
        cameras: Each camera's entry in ``prelabel.json``.
        failed: Why images failed, by name.
    """

    output: Path
    images: tuple[str, ...]
    candidates: int
    cameras: tuple[Mapping[str, Any], ...]
    failed: Mapping[str, ClearLinesError]


@dataclass(frozen=True)
class _Work:
    """One image for a worker."""

    image: FoundImage
    parameters: Mapping[str, Any]


@dataclass(frozen=True)
class _Detected:
    """A finished detection, as kept in the cache."""

    image: FoundImage
    key: str
    milliseconds: float


def prelabel_files(
    paths: Sequence[Path], output: Path, choice: PrelabelChoice, *, progress: Progress | None = None
) -> PrelabelReport:
    """Pre-label images and write one file per image and ``prelabel.json``.

    Finished detections are kept in the output folder until all is written: the same call after an interruption goes on
    where it was. An image that fails doesn't stop the others.

    Raises:
        NotFound: If a path doesn't exist or holds no image.
        InvalidInput: If two images have one name, or all images failed.
        OSError: If the output can't be written.
    """
    images = find_prelabel_images(paths)
    cache = DetectionCache(output / FOLDER, choice.parameters.as_dict())
    failed = {image.name: image.error for image in images if image.error is not None}
    detected: list[_Detected] = []
    readable = [image for image in images if image.error is None]
    for outcome in _detections(readable, cache, choice):
        if isinstance(outcome, _Detected):
            detected.append(outcome)
        else:
            failed.update(outcome)
        if progress is not None:
            progress(len(detected) + len(failed), len(images))
    if not detected:
        reasons = "; ".join(str(error) for error in list(failed.values())[:3])
        raise InvalidInput(f"no image could be pre-labelled: {reasons}", where=", ".join(map(str, paths)))
    detected.sort(key=lambda each: each.image.name)
    cameras = [_camera_entry(name, members, cache) for name, members in _cameras(detected, choice.camera).items()]
    lenses = {name: camera["distortion"] for camera in cameras for name in camera["images"]}
    entries = [_write_image(each, lenses[each.image.name], cache, output, choice) for each in detected]
    entries += [{"name": name, "error": error.as_dict()} for name, error in failed.items()]
    report = {
        "clearlines": __version__,
        "parameters": choice.parameters.as_dict(),
        "camera": choice.camera,
        "discard": choice.discard,
        "images": sorted(entries, key=lambda entry: entry["name"]),
        "cameras": cameras,
    }
    write_whole(output / "prelabel.json", json_bytes(report))
    cache.clear()
    written = sum(entry.get("candidates", 0) for entry in entries)
    return PrelabelReport(output, tuple(each.image.name for each in detected), written, tuple(cameras), failed)


def detect_file(work: _Work) -> DetectionResult:
    """Detect the candidates of one image file; runs in a worker."""
    image = work.image
    content = read_file(image.path)
    return detect_task(content, image.name, work.parameters, alone=False, discard=False, max_pixels=MAX_PIXELS)


def _detections(
    images: Sequence[FoundImage], cache: DetectionCache, choice: PrelabelChoice
) -> Iterator[_Detected | dict[str, ClearLinesError]]:
    """Yield what is finished already, then the rest as it arrives; failures as name and reason."""
    missing: list[_Work] = []
    keys = {image.name: cache.key(read_file(image.path)) for image in images}
    for image in images:
        if cache.is_whole(keys[image.name]):
            yield _Detected(image, keys[image.name], cache.milliseconds(keys[image.name]) or 0.0)
        else:
            missing.append(_Work(image, cache.parameters))
    for outcome in map_in_processes(detect_file, missing, min(choice.workers, max(len(missing), 1))):
        name = outcome.item.image.name
        if outcome.result is None:
            yield {name: outcome.error or ClearLinesError("it failed for an unknown reason", where=name)}
            continue
        cache.put(keys[name], outcome.result)
        yield _Detected(outcome.item.image, keys[name], outcome.result.milliseconds)


def _cameras(detected: Sequence[_Detected], mode: CameraMode) -> dict[str, list[_Detected]]:
    cameras: dict[str, list[_Detected]] = {}
    for each in detected:
        cameras.setdefault(each.image.camera if mode == "joint" else each.image.name, []).append(each)
    return cameras


def _camera_entry(name: str, members: Sequence[_Detected], cache: DetectionCache) -> dict[str, Any]:
    header = members[0].image.header
    assert header is not None  # noqa: S101 - a detected image was readable
    segments = [cache.lens_segments(member.key) for member in members]
    return {
        "name": name,
        "images": [member.image.name for member in members],
        "distortion": estimate_task(segments, (header.width, header.height)),
    }


def _write_image(
    each: _Detected, distortion: Mapping[str, Any], cache: DetectionCache, output: Path, choice: PrelabelChoice
) -> dict[str, Any]:
    """Write one image's candidates and return its entry in ``prelabel.json``."""
    candidates = cache.candidates(each.key)
    straightness = judge_task(candidates, distortion).straightness
    labelled = LabelledSegments(candidates, straightness)
    straight = straightness >= PASSES
    if choice.discard:
        labelled = labelled.select(straight)
    suffix, write = WRITERS[choice.format]
    file = f"{each.image.name}{suffix}"
    write_whole(output / file, write(labelled))
    header = each.image.header
    return {
        "name": each.image.name,
        "file": file,
        "width": header.width if header else None,
        "height": header.height if header else None,
        "candidates": len(labelled),
        "straight": int(straight.sum()),
        "milliseconds": round(each.milliseconds, 1),
    }
