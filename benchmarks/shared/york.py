"""Photos of the York Urban line segment database (Denis, Elder, Estrada, ECCV 2008) with their labelled lines."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.formats.inert_npy import read_label_npy
from app.images import decode_gray
from app.vision import Segments
from app.vision.intensity import to_eight_bit

MIN_LENGTH = 50.0
"""Shorter lines, labelled or found, aren't looked at, px of arc length."""


@dataclass(frozen=True, eq=False)
class Photo:
    """A photo and its labels.

    Attributes:
        name: File name without its extension.
        gray: uint8 ``(H, W)``.
        labels: The labelled lines of at least `MIN_LENGTH`, px.
    """

    name: str
    gray: NDArray[np.uint8]
    labels: Segments


def read_gray(path: Path) -> NDArray[np.uint8]:
    """Return an image file as 8 bit grey ``(H, W)``."""
    return to_eight_bit(decode_gray(path.read_bytes()))


def read_photos(folder: Path) -> list[Photo]:
    """Read ``images/NAME.*`` and ``labels/NAME_edge_segments_filtered.npy``, in the order of their names."""
    photos = []
    for path in sorted((folder / "images").iterdir()):
        labels = read_label_npy((folder / "labels" / f"{path.stem}_edge_segments_filtered.npy").read_bytes())
        photos.append(Photo(path.stem, read_gray(path), labels.select(labels.lengths() >= MIN_LENGTH)))
    return photos
