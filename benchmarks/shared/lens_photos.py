"""Real images with known lenses, as candidates for an estimate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from app.formats.reference_camera import ALL, ReferenceCamera, read_cameras
from app.images import decode_gray
from app.vision import DetectionParameters, Segments, detect_for_prelabel
from app.vision.conversion import OpenCVLens

CARND = ReferenceCamera(
    1280, 720, ((1160.0, 0.0, 667.0), (0.0, 1160.0, 389.0), (0.0, 0.0, 1.0)), (-0.249, -0.009, 0.0, 0.0, 0.0)
)
"""By the chessboard photos of that camera; itself good to about 1 px."""


@dataclass(frozen=True)
class Photo:
    """Candidates of one image, and the lens that it was taken with."""

    segments: Segments
    truth: OpenCVLens
    width: int
    height: int


def york_photos(folder: Path) -> dict[str, Photo]:
    """Photos that each have a lens of their own; empty if the folder isn't there."""
    if not folder.is_dir():
        return {}
    return _photos(folder / "images", read_cameras((folder / "cameras.json").read_bytes()))


def kitti_frames(folder: Path) -> dict[str, Photo]:
    """Frames of one camera; empty if the folder isn't there."""
    if not folder.is_dir():
        return {}
    return _photos(folder / "images", read_cameras((folder / "camera.json").read_bytes()))


def carnd_frames(folder: Path) -> dict[str, Photo]:
    """Frames of a road that tell too little of their camera's lens; empty if the folder isn't there."""
    return _photos(folder / "road", {ALL: CARND}) if folder.is_dir() else {}


def _photos(folder: Path, cameras: Mapping[str, ReferenceCamera]) -> dict[str, Photo]:
    found: dict[str, Photo] = {}
    for path in sorted(folder.iterdir()):
        camera = cameras[path.stem] if path.stem in cameras else cameras[ALL]
        segments = detect_for_prelabel(decode_gray(path.read_bytes()), DetectionParameters()).lens_segments
        truth = OpenCVLens(camera.matrix, camera.distortion)
        found[path.stem] = Photo(segments, truth, camera.width, camera.height)
    return found
