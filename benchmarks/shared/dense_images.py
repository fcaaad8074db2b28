"""Large images full of candidates, in the layout that ``clearlines import`` reads."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from app.formats.dataset import write_dataset
from app.formats.labelled import LabelledSegments
from app.formats.labelled_image import LabelledImage
from app.vision.segments import Segments

WIDTH, HEIGHT = 2048, 1536
POINTS = 300
"""Of each candidate."""


def picture(seed: int) -> NDArray[np.uint8]:
    """A picture with structure at several scales, so that decoding it costs what a photo costs."""
    rng = np.random.default_rng(seed)
    image = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    for size in (8, 64, 512):
        coarse = rng.uniform(0, 80, (HEIGHT // size + 1, WIDTH // size + 1, 3)).astype(np.float32)
        image += cv2.resize(coarse, (WIDTH, HEIGHT), interpolation=cv2.INTER_CUBIC)
    return np.clip(image, 0, 255).astype(np.uint8)


def segments(seed: int, candidates: int) -> Segments:
    """Slightly curved lines of 100 to 400 px everywhere, with noise like that of edge points."""
    rng = np.random.default_rng(seed)
    along = np.linspace(-0.5, 0.5, POINTS)
    angle = rng.uniform(0, np.pi, (candidates, 1))
    length = rng.uniform(100, 400, (candidates, 1))
    across = 0.01 * length * (4 * along**2 - 1) + rng.normal(0, 0.1, (candidates, POINTS))
    x = rng.uniform(200, WIDTH - 200, (candidates, 1)) + length * along * np.cos(angle) - across * np.sin(angle)
    y = rng.uniform(200, HEIGHT - 200, (candidates, 1)) + length * along * np.sin(angle) + across * np.cos(angle)
    return Segments.from_list(list(np.stack([x, y], axis=2).astype(np.float32)))


def write_images(folder: Path, *, images: int, candidates: int, quick: bool = False) -> None:
    """Write a dataset.

    Args:
        folder: Where to.
        images: How many.
        candidates: Of each image.
        quick: As JPEG files, which are small, instead of PNG files.
    """

    def image(seed: int) -> LabelledImage:
        extension = ".jpg" if quick else ".png"
        content = cv2.imencode(extension, picture(seed))[1].tobytes()
        labelled = LabelledSegments(segments(seed, candidates))
        name = f"{seed:03}"
        return LabelledImage(name, name + extension, WIDTH, HEIGHT, labelled, content=lambda: content)

    for path, content in write_dataset(image(seed) for seed in range(images)):
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)
