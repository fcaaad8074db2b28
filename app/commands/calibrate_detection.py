"""Candidates of image files for a calibration, found in worker processes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from app.commands.prelabel_images import FoundImage
from app.errors import ClearLinesError, InvalidInput
from app.formats.files import read_file
from app.formats.npz import read_npz
from app.images import MAX_PIXELS
from app.jobs.mapping import map_in_processes
from app.jobs.tasks import DetectionResult, detect_task
from app.vision import DetectionParameters
from app.vision.segments import Segments

Progress = Callable[[int, int], None]


class FoundCandidates(NamedTuple):
    """Segments of each image, and why others failed, both by name."""

    segments: Mapping[str, Segments]
    failed: Mapping[str, ClearLinesError]


def detect_candidates(images: Sequence[FoundImage], workers: int, progress: Progress | None) -> FoundCandidates:
    """Find the segments of images that tell a lens; one that fails doesn't stop the others.

    Raises:
        InvalidInput: If all of them failed.
    """
    found: dict[str, Segments] = {}
    failed: dict[str, ClearLinesError] = {}
    for outcome in map_in_processes(detect_file, images, min(workers, max(len(images), 1))):
        name = outcome.item.name
        if outcome.result is None or outcome.result.lens_segments is None:
            failed[name] = outcome.error or ClearLinesError("it failed for an unknown reason", where=name)
        else:
            found[name] = read_npz(outcome.result.lens_segments, where=name).segments
        if progress is not None:
            progress(len(found) + len(failed), len(images))
    if not found:
        reasons = "; ".join(str(error) for error in list(failed.values())[:3])
        raise InvalidInput(f"no image could be read: {reasons}")
    return FoundCandidates(found, failed)


def detect_file(image: FoundImage) -> DetectionResult:
    """Find the candidates of one image file; runs in a worker."""
    parameters = DetectionParameters().as_dict()
    content = read_file(image.path)
    return detect_task(content, image.name, parameters, alone=False, discard=False, max_pixels=MAX_PIXELS)
