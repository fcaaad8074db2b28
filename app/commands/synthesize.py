"""``clearlines synthesize``: street scenes with exact labels, in the ClearLines dataset layout."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path

from app.commands.synthesis_card import Tally, write_card
from app.commands.synthesized_images import DrawnImage, draw_images
from app.commands.whole_files import json_bytes
from app.formats.dataset import write_dataset
from app.formats.labelled_image import LabelledImage
from app.formats.members import fill_folder
from app.formats.reference_camera import ALL, read_cameras
from app.synthesis import plan_drives

CAMERA = "synthetic"
CARD = "CARD.md"
SIZE = (1280, 720)


def synthesize_folder(
    count: int,
    output: Path,
    *,
    seed: int,
    size: tuple[int, int] = SIZE,
    processes: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[Path]:
    """Write images of synthetic cameras with labels, ``images.csv``, ``cameras.json``, line files and a card.

    Args:
        count: Number of images.
        output: Folder, made if missing; files there are replaced.
        seed: The same seed gives the same files.
        size: Width and height of the images, px.
        processes: How many draw; one per processor if not given.
        progress: Called with the images done and their total.

    Returns:
        The files written.
    """
    return fill_folder(_members(count, seed, size, processes, progress), output)


def _members(
    count: int,
    seed: int,
    size: tuple[int, int],
    processes: int | None,
    progress: Callable[[int, int], None] | None,
) -> Iterator[tuple[str, bytes]]:
    tally = Tally()
    lines: list[tuple[str, bytes]] = []

    def images() -> Iterator[LabelledImage]:
        drives = plan_drives(count, seed, width=size[0], height=size[1])
        for done, drawn in enumerate(draw_images(drives, processes), start=1):
            image = _labelled_image(drawn)
            tally.images[image.camera] += 1
            tally.lenses[image.camera] = drawn.reference
            tally.counts.update(drawn.counts)
            lines.append((f"lines/{drawn.name}.json", drawn.lines))
            yield image
            if progress is not None:
                progress(done, count)

    for member in write_dataset(images()):
        yield member
        yield from lines
        lines.clear()
    yield CARD, write_card(tally, seed=seed, size=size, version=version("clearlines"))


def _labelled_image(drawn: DrawnImage) -> LabelledImage:
    return LabelledImage(
        name=drawn.name,
        file_name=f"{drawn.name}.png",
        width=drawn.width,
        height=drawn.height,
        labelled=drawn.labelled,
        camera=CAMERA if drawn.camera == 0 else f"{CAMERA}-{drawn.camera + 1}",
        source="synthetic",
        sequence=drawn.name.partition("/")[0],
        reference=read_cameras(json_bytes(drawn.reference))[ALL],
        content=lambda: drawn.png,
    )
