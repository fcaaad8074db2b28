"""Real images with known lenses, as lines that a reviewer would keep."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from shared.lens_photos import Photo

from app.formats.inert_npy import read_label_npy
from app.formats.reference_camera import read_cameras
from app.vision.conversion import OpenCVLens
from app.vision.persistence import static_segments
from app.vision.sampson import Lens, sampson_residuals
from app.vision.segments import Segments

KEPT_RMS, KEPT_MAXIMUM, SHORTEST = 0.5, 1.5, 60.0
"""px; what a reviewer who saw the image under its true lens would take for straight."""


class _Numeric:
    """A lens with its Jacobian by differences."""

    def __init__(self, lens: OpenCVLens) -> None:
        self.lens = lens

    def undistort(self, points: ArrayLike) -> NDArray[np.float64]:
        return self.lens.undistort(points)

    def jacobian(self, points: ArrayLike) -> NDArray[np.float64]:
        points = np.asarray(points, np.float64).reshape(-1, 2)
        steps = np.array([[0.5, 0.0], [0.0, 0.5]])
        return np.stack([self.undistort(points + step) - self.undistort(points - step) for step in steps], -1)


def reviewed(photos: Mapping[str, Photo]) -> dict[str, Photo]:
    """Return the candidates of one camera that are straight under the true lens: what careful review would leave.

    Edges of the vehicle, which are the same in every image, are left out as a person would.
    """
    long = {name: photo.segments.select(photo.segments.extents() >= SHORTEST) for name, photo in photos.items()}
    first = next(iter(photos.values()))
    static = static_segments(list(long.values()), first.width, first.height)
    return {
        name: replace(photo, segments=long[name].select(_is_straight(long[name], photo.truth) & ~vehicle))
        for (name, photo), vehicle in zip(photos.items(), static, strict=True)
    }


def _is_straight(segments: Segments, truth: OpenCVLens) -> NDArray[np.bool_]:
    if not len(segments):
        return np.zeros(0, np.bool_)
    lens: Lens = _Numeric(truth)
    distance = np.abs(sampson_residuals(segments, lens))
    rms = np.sqrt(np.add.reduceat(distance**2, segments.offsets[:-1]) / segments.counts)
    largest = np.maximum.reduceat(distance, segments.offsets[:-1])
    return (rms < KEPT_RMS) & (largest < KEPT_MAXIMUM)


def york_labels(folder: Path) -> dict[str, Photo]:
    """Return the lines that people labelled in each photo; empty if the folder isn't there."""
    if not folder.is_dir():
        return {}
    cameras = read_cameras((folder / "cameras.json").read_bytes())
    found: dict[str, Photo] = {}
    for path in sorted((folder / "labels").glob("*_edge_segments_filtered.npy")):
        name = path.name.removesuffix("_edge_segments_filtered.npy")
        camera = cameras[name]
        lens = OpenCVLens(camera.matrix, camera.distortion)
        found[name] = Photo(read_label_npy(path.read_bytes()), lens, camera.width, camera.height)
    return found
