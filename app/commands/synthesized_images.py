"""Drawing the images of a synthetic dataset, a drive at a time, in as many processes as there are processors."""

from __future__ import annotations

import os
from collections import Counter, deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass
from itertools import islice
from multiprocessing import get_context
from typing import Any

import cv2

from app.formats.labelled import LabelledSegments
from app.synthesis import Drive, SyntheticScene, drive_scenes
from app.synthesis.line_file import write_lines
from app.vision.segments import Segments

ALONE = 1  # drives; for so few no process is started
_AHEAD = 2  # drives per process that may wait to be written


@dataclass(frozen=True, eq=False)
class DrawnImage:
    """One image, ready to be written.

    Attributes:
        name: Path without extension, ``street-00/000003``.
        camera: Number of its camera.
        png: The image file.
        lines: The line file, see `app.synthesis.line_file`.
        labelled: Labels, kept, and hardly visible edges, ambiguous.
        reference: Its lens, as ``cameras.json`` holds it.
        width: In px.
        height: In px.
        counts: How many labels, ambiguous ones and distractors there are, by ``(what, kind)``.
    """

    name: str
    camera: int
    png: bytes
    lines: bytes
    labelled: LabelledSegments
    reference: dict[str, Any]
    width: int
    height: int
    counts: Counter[tuple[str, str]]


def draw_images(drives: Sequence[Drive], processes: int | None = None) -> Iterator[DrawnImage]:
    """Draw the images of drives in order.

    Args:
        drives: What to draw.
        processes: How many to use; one per processor if not given. With few drives this process does it all.
    """
    processes = min(processes or os.cpu_count() or 1, len(drives))
    if processes <= 1 or len(drives) <= ALONE:
        for drive in drives:
            yield from _draw_drive(drive)
        return
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        left = iter(drives)
        waiting: deque[Future[list[DrawnImage]]] = deque(
            pool.submit(_draw_apart, drive) for drive in islice(left, _AHEAD * processes)
        )
        try:
            while waiting:
                drawn = waiting.popleft().result()
                for drive in islice(left, 1):
                    waiting.append(pool.submit(_draw_apart, drive))
                yield from drawn
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _draw_apart(drive: Drive) -> list[DrawnImage]:
    cv2.setNumThreads(1)  # a process per processor is enough
    return _draw_drive(drive)


def _draw_drive(drive: Drive) -> list[DrawnImage]:
    return [_drawn(name, drive.camera, scene) for name, scene in drive_scenes(drive)]


def _drawn(name: str, camera: int, scene: SyntheticScene) -> DrawnImage:
    height, width = scene.image.shape[:2]
    segments = Segments.from_list([*scene.labels, *scene.ambiguous])
    verdicts = ("keep",) * len(scene.labels) + ("ambiguous",) * len(scene.ambiguous)
    counts = Counter(("labels", kind) for kind in scene.kinds)
    counts.update(("ambiguous", kind) for kind in scene.ambiguous_kinds)
    counts.update((reason, kind) for reason, kind in zip(scene.reasons, scene.distractor_kinds, strict=True))
    return DrawnImage(
        name=name,
        camera=camera,
        png=cv2.imencode(".png", scene.image)[1].tobytes(),
        lines=write_lines(scene),
        labelled=LabelledSegments(segments, verdicts=verdicts),
        reference=scene.camera.as_reference(),
        width=width,
        height=height,
        counts=counts,
    )
