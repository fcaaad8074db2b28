"""``clearlines synthesize``: street scenes with exact labels, in the ClearLines dataset layout."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import cv2

from app.commands.whole_files import json_bytes
from app.formats.dataset import write_dataset
from app.formats.labelled import LabelledSegments
from app.formats.labelled_image import LabelledImage
from app.formats.members import fill_folder
from app.formats.reference_camera import ALL, read_cameras
from app.synthesis import SyntheticScene, synthesize_dataset

CAMERA = "synthetic"


def synthesize_folder(
    count: int, output: Path, *, seed: int, progress: Callable[[int, int], None] | None = None
) -> list[Path]:
    """Write images of one synthetic camera with labels, ``images.csv`` and ``cameras.json``.

    Args:
        count: Number of images.
        output: Folder, made if missing; files there are replaced.
        seed: The same seed gives the same files.
        progress: Called with the images done and their total.

    Returns:
        The files written.
    """
    return fill_folder(write_dataset(_labelled_images(count, seed, progress)), output)


def _labelled_images(count: int, seed: int, progress: Callable[[int, int], None] | None) -> Iterator[LabelledImage]:
    for done, (name, scene) in enumerate(synthesize_dataset(count, seed), start=1):
        yield _labelled_image(name, scene)
        if progress is not None:
            progress(done, count)


def _labelled_image(name: str, scene: SyntheticScene) -> LabelledImage:
    height, width = scene.image.shape[:2]
    lens = scene.camera.as_reference()

    def content() -> bytes:
        return cv2.imencode(".png", scene.image)[1].tobytes()

    return LabelledImage(
        name=name,
        file_name=f"{name}.png",
        width=width,
        height=height,
        labelled=LabelledSegments(scene.labels),
        camera=CAMERA,
        source="synthetic",
        sequence=name.partition("/")[0],
        reference=read_cameras(json_bytes(lens))[ALL],
        content=content,
    )
