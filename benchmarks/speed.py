"""How long detection takes: beside other detectors, in a fresh process, and as the image grows to 40 megapixels.

python benchmarks/speed.py [--json] [--york DIR] [--kitti DIR]

Times are the best of three passes where nothing else is said, on one thread. Ours and OpenCV's LSD take turns on each
image in one process; EDLines and FastLineDetector, of opencv-contrib, need a process of their own. Large images are
mosaics of a photo whose every other tile is mirrored, so that edges are as sharp and as dense as in the photo.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from shared.detectors import Detector, clearlines, opencv_lsd
from shared.mosaic import mirrored
from shared.peers import NAMES, PeersUnavailable, run_peers
from shared.reporting import Target, arguments, finish, show_table
from shared.york import MIN_LENGTH, read_gray, read_photos

PASSES = 3
GROWTH_IMAGES = 8
LARGE = (2048, 1536)
FORTY_MEGAPIXELS = (7300, 5475)
CANNY = (80, 160)
PROGRAMS = Path(__file__).parent / "shared"
TARGETS = (
    Target("york_ratio_to_lsd", 0.6),
    Target("york_processor_per_wall", 1.05),  # more than one thread would take more
    Target("first_detect_seconds", 2.0),
)
GROWTH_BOUND = 1.1
"""Time per pixel should not grow with the image; a tenth is left to noise."""


@dataclass(frozen=True, eq=False)
class Times:
    """Best times of N images by two detectors that took turns: ours in row 0, OpenCV's LSD in row 1.

    Attributes:
        wall: Elapsed time, float64 ``(2, N)``, s.
        processor: Time on the processor, float64 ``(2, N)``, s.
        megapixels: float64 ``(N,)``.
    """

    wall: NDArray[np.float64]
    processor: NDArray[np.float64]
    megapixels: NDArray[np.float64]


def take_turns(images: Sequence[NDArray[np.uint8]]) -> Times:
    """Time our detector and OpenCV's LSD on N images, pass by pass and in turn."""
    detectors: tuple[Detector, Detector] = (clearlines(MIN_LENGTH), opencv_lsd())
    wall, processor = np.full((2, 2, len(images)), np.inf)
    for detector in detectors:
        detector(images[0])
    for index, image in enumerate(images):
        for _ in range(PASSES):
            for row, detector in enumerate(detectors):
                processor_start, start = time.process_time(), time.perf_counter()
                detector(image)
                elapsed, worked = time.perf_counter() - start, time.process_time() - processor_start
                wall[row, index] = min(wall[row, index], elapsed)
                processor[row, index] = min(processor[row, index], worked)
    return Times(wall, processor, np.array([image.size / 1e6 for image in images]))


def beside_others(photos: Sequence[NDArray[np.uint8]], times: Times) -> dict[str, float]:
    """Medians over the photos, and ours over that of LSD."""
    ours, lsd = np.median(times.wall, axis=1)
    figures = {
        "york_milliseconds": float(ours * 1000),
        "york_lsd_milliseconds": float(lsd * 1000),
        "york_ratio_to_lsd": float(ours / lsd),
        "york_processor_per_wall": float(times.processor[0].sum() / times.wall[0].sum()),
    }
    rows = [["ClearLines", "york_milliseconds"], ["OpenCV LSD", "york_lsd_milliseconds"]]
    try:
        for name, found in run_peers(photos, PASSES).items():
            figures[f"york_{name}_milliseconds"] = found.milliseconds
            rows.append([NAMES[name], f"york_{name}_milliseconds"])
    except PeersUnavailable as reason:
        print(f"EDLines, FastLineDetector: opencv-contrib is not installable here: {reason}")
    show_table(
        f"{len(photos)} photos of 640 x 480, one thread, best of {PASSES}",
        ["detector", "ms, median", "of LSD"],
        [[name, f"{figures[key]:.1f}", f"{figures[key] / figures[rows[1][1]]:.2f}"] for name, key in rows],
    )
    return figures


def first_detect(photo: NDArray[np.uint8]) -> dict[str, float]:
    """Seconds of the first `detect` in a fresh process: the middle one of three processes."""
    with tempfile.TemporaryDirectory() as folder:
        image = save(photo, Path(folder) / "photo.npy")
        runs = [ask("first_detect.py", image) for _ in range(PASSES)]
    seconds = sorted(runs, key=lambda run: run["total"])[PASSES // 2]
    rows = [
        ["imports", "import"],
        ["first image", "first"],
        ["imports and first image", "total"],
        ["second image", "second"],
    ]
    show_table(
        f"A fresh process, 640 x 480, middle of {PASSES}",
        ["", "s"],
        [[name, f"{seconds[key]:.3f}"] for name, key in rows],
    )
    return {
        "first_detect_seconds": seconds["total"],
        "first_detect_import_seconds": seconds["import"],
        "first_detect_image_seconds": seconds["first"],
    }


def growth(photos: Sequence[NDArray[np.uint8]], times: Times, kitti: Path) -> dict[str, float]:
    """Processor time per megapixel of larger images over that of the photos, and LSD's for comparison.

    A mosaic is compared with the photo it is made of; the frames of KITTI, which show something else, with all photos:
    there LSD's figure says how much of it is the content. Elapsed time would favour short runs, which other processes
    interrupt less often.
    """
    of_photos = times.processor / times.megapixels
    sizes = [("640 x 480", of_photos, np.ones(2))]
    if kitti.is_dir():
        paths = sorted((kitti / "images").iterdir())
        frames = take_turns([read_gray(paths[index]) for index in spread(len(paths), GROWTH_IMAGES)])
        of_frames = frames.processor / frames.megapixels
        sizes.append(("1300 x 398", of_frames, np.median(of_frames, axis=1) / np.median(of_photos, axis=1)))
    chosen = spread(len(photos), GROWTH_IMAGES)
    mosaics = take_turns([mirrored(photos[index], *LARGE) for index in chosen])
    of_mosaics = mosaics.processor / mosaics.megapixels
    sizes.append(("2048 x 1536", of_mosaics, np.median(of_mosaics / of_photos[:, chosen], axis=1)))
    rows = []
    for size, of_images, ratios in sizes:
        medians = (f"{median * 1000:.1f}" for median in np.median(of_images, axis=1))
        rows.append([size, str(of_images.shape[1]), *medians, *(f"{ratio:.2f}" for ratio in ratios)])
    columns = ["size", "images", "ms / megapixel", "LSD", "growth", "LSD"]
    show_table(f"Processor time per pixel, one thread, best of {PASSES}", columns, rows)
    return {f"growth_{size.replace(' ', '')}": float(ratios[0]) for size, _, ratios in sizes[1:]}


def forty_megapixels(photos: dict[str, NDArray[np.uint8]]) -> dict[str, float]:
    """Seconds and bytes per pixel of mosaics of 40 megapixels, each in a fresh process."""
    width, height = FORTY_MEGAPIXELS
    figures, rows = {}, []
    for name, photo in photos.items():
        with tempfile.TemporaryDirectory() as folder:
            image = save(mirrored(photo, width, height), Path(folder) / "mosaic.npy")
            result = ask("peak_memory.py", image, save(photo, Path(folder) / "photo.npy"))
        bytes_per_pixel = result["bytes"] / (width * height)
        figures |= {
            f"forty_megapixels_{name}_seconds": result["seconds"],
            f"forty_megapixels_{name}_processor_seconds": result["processor"],
            f"forty_megapixels_{name}_bytes_per_pixel": bytes_per_pixel,
        }
        times = (f"{result[key]:.1f}" for key in ("seconds", "processor"))
        rows.append([f"{name} photo", *times, f"{bytes_per_pixel:.1f}", f"{result['segments']:.0f}"])
    columns = ["mosaic of the", "s", "s on the processor", "bytes / pixel", "segments"]
    show_table(f"{width} x {height}, fresh process, one thread, one pass", columns, rows)
    return figures


def by_edges(photos: Sequence[NDArray[np.uint8]]) -> dict[str, NDArray[np.uint8]]:
    """Return the photos with the median and the greatest number of edge pixels, whatever our detector makes of them."""
    order = np.argsort([cv2.countNonZero(cv2.Canny(photo, *CANNY)) for photo in photos])
    return {"middle": photos[order[len(order) // 2]], "busiest": photos[order[-1]]}


def spread(count: int, wanted: int) -> NDArray[np.int64]:
    """Return ``wanted`` indices, or all, evenly over ``count``."""
    return np.unique(np.linspace(0, count - 1, min(wanted, count)).astype(np.int64))


def save(image: NDArray[np.uint8], path: Path) -> Path:
    np.save(path, image)
    return path


def ask(program: str, *arguments_: Path) -> dict[str, float]:
    """Run a program of ``shared`` in a fresh process and return the JSON object it prints."""
    command = [sys.executable, str(PROGRAMS / program), *map(str, arguments_)]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)


def main() -> None:
    options = arguments(str(__doc__), "york", "kitti")
    cv2.setNumThreads(1)
    if not options.york.is_dir():
        print(f"no data: {options.york} is not there")
        finish({}, [], as_json=options.json)
        return
    photos = [photo.gray for photo in read_photos(options.york)]
    times = take_turns(photos)
    chosen = by_edges(photos)
    figures = beside_others(photos, times)
    figures |= first_detect(chosen["middle"])
    grown = growth(photos, times, options.kitti)
    figures |= grown | forty_megapixels(chosen)
    finish(figures, [*TARGETS, *(Target(name, GROWTH_BOUND) for name in grown)], as_json=options.json)


if __name__ == "__main__":
    main()
