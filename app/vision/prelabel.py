"""Pre-labelling: candidates of every image, the lens of every camera, and how straight each candidate is under it.

`prelabel` does it all for images in memory. A server runs the same steps apart: `detect_for_prelabel` for each image in
a worker process, then `assemble`, or `estimate_distortion` and `judge_straightness`, over all images of a camera.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.vision.distortion import DistortionEstimate, estimate_distortion
from app.vision.lens_segments import MIN_LENS_LENGTH
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.segments import Segments
from app.vision.straightness import judge_straightness

CameraMode = Literal["joint", "per-image"]
Progress = Callable[[int, int], None]
"""Called with the number of images done and their total."""


@dataclass(frozen=True, eq=False)
class Detection:
    """What one image gives; plain arrays, so it can cross a process border.

    Attributes:
        width: Image width in px.
        height: Image height in px.
        candidates: Segments of at least the length asked for.
        lens_segments: Segments of 60 px and more, from which the lens is estimated.
        seconds: Time that the detection took.
    """

    width: int
    height: int
    candidates: Segments
    lens_segments: Segments
    seconds: float


@dataclass(frozen=True, eq=False)
class PrelabelledImage:
    """Candidates of one image.

    Attributes:
        segments: Candidates, with scores: evidence for an edge, in [0, 1].
        straightness: float32 ``(S,)`` in [0, 1], probability of being straight under the camera's lens.
        seconds: Time that the detection took.
    """

    segments: Segments
    straightness: NDArray[np.float32]
    seconds: float


@dataclass(frozen=True, eq=False)
class PrelabelledCamera:
    """Images that share a lens, by index, and the lens."""

    images: tuple[int, ...]
    estimate: DistortionEstimate


@dataclass(frozen=True, eq=False)
class PrelabelResult:
    """Result of `prelabel`: the images in the order given, and their cameras."""

    images: tuple[PrelabelledImage, ...]
    cameras: tuple[PrelabelledCamera, ...]


def prelabel(
    images: Sequence[NDArray[Any]],
    parameters: DetectionParameters | None = None,
    *,
    camera: CameraMode = "joint",
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
    seed: int = 0,
) -> PrelabelResult:
    """Detect candidates in all images, estimate the lens and judge straightness.

    Args:
        images: Grey images ``(H, W)``, uint8, uint16 or float.
        parameters: Of the detection; the defaults if left out.
        camera: ``"joint"`` if all images share a lens, ``"per-image"`` if each has its own.
        progress: Told after each image.
        cancelled: Asked now and then while images are detected; True calls the whole off.
        seed: Of the random samples of MSAC.

    Raises:
        InvalidInput: If `camera` is neither, or images of different size should share a lens.
        InvalidImage: If an image is none.
        Cancelled: If `cancelled` says so.
    """
    parameters = parameters or DetectionParameters()
    _check_mode(camera)
    if camera == "joint":
        _check_one_size([image.shape[1::-1] for image in images if np.ndim(image) == 2])
    detections = []
    for number, image in enumerate(images):
        detections.append(detect_for_prelabel(image, parameters, cancelled=cancelled))
        if progress is not None:
            progress(number + 1, len(images))
    return assemble(detections, camera=camera, seed=seed)


def detect_for_prelabel(
    gray: NDArray[Any], parameters: DetectionParameters, *, cancelled: Callable[[], bool] | None = None
) -> Detection:
    """Detect the candidates of one image and, in the same pass, the shorter segments that the lens is read off.

    Args:
        gray: Grey image ``(H, W)``.
        parameters: Of the detection; its `min_length` holds for the candidates.
        cancelled: Asked now and then; True calls the detection off.

    Raises:
        InvalidImage: If it is no grey image.
        Cancelled: If `cancelled` says so.
    """
    start = time.perf_counter()
    found = detect(gray, long_enough_for_lens(parameters), cancelled=cancelled)
    extents = found.extents()
    candidates, lens_segments = (found.select(extents >= least) for least in (parameters.min_length, MIN_LENS_LENGTH))
    height, width = gray.shape
    return Detection(width, height, candidates, lens_segments, time.perf_counter() - start)


def long_enough_for_lens(parameters: DetectionParameters) -> DetectionParameters:
    """Return parameters that let the segments pass that the lens is read off, where they are shorter than asked for."""
    return replace(parameters, min_length=min(MIN_LENS_LENGTH, parameters.min_length))


def assemble(detections: Sequence[Detection], *, camera: CameraMode = "joint", seed: int = 0) -> PrelabelResult:
    """Estimate the lens of detected images and judge their candidates.

    Args:
        detections: Of all images, in order.
        camera: ``"joint"`` if all images share a lens, ``"per-image"`` if each has its own.
        seed: Of the random samples of MSAC.

    Raises:
        InvalidInput: If `camera` is neither, or images of different size should share a lens.
    """
    _check_mode(camera)
    everything = range(len(detections))
    if camera == "joint":
        _check_one_size([(each.width, each.height) for each in detections])
        groups = [tuple(everything)] if detections else []
    else:
        groups = [(image,) for image in everything]
    cameras = tuple(_camera(group, detections, seed) for group in groups)
    estimates = {image: each.estimate for each in cameras for image in each.images}
    return PrelabelResult(
        tuple(
            PrelabelledImage(each.candidates, judge_straightness(each.candidates, estimates[image]), each.seconds)
            for image, each in enumerate(detections)
        ),
        cameras,
    )


def _camera(images: tuple[int, ...], detections: Sequence[Detection], seed: int) -> PrelabelledCamera:
    first = detections[images[0]]
    segments = [detections[image].lens_segments for image in images]
    return PrelabelledCamera(images, estimate_distortion(segments, (first.width, first.height), seed=seed))


def _check_mode(camera: str) -> None:
    if camera not in ("joint", "per-image"):
        raise InvalidInput(f"{camera!r} is no way to share lenses", where="camera", expected="'joint' or 'per-image'")


def _check_one_size(sizes: Sequence[tuple[int, ...]]) -> None:
    """Raise if images can't be of one camera, naming the ones that differ from the first."""
    other = [image for image, size in enumerate(sizes) if size != sizes[0]]
    if other:
        named = ", ".join(f"image {image} ({sizes[image][0]} x {sizes[image][1]})" for image in other[:5])
        more = f" and {len(other) - 5} more" if len(other) > 5 else ""
        raise InvalidInput(
            f"images of different size can't share a lens: {named}{more}",
            where="camera",
            expected=f"{sizes[0][0]} x {sizes[0][1]}, as image 0",
            hint="give each camera's images apart, or estimate a lens for each image",
            details={"images": other},
        )
