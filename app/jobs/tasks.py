"""What a worker does: pure functions, bytes and arrays in, arrays out.

A worker needs no database, no settings and no web code, so it may run on another machine. Every error leaves as one of
``app.errors``: those survive the way back through a process border, whatever the pipeline raised.
"""

from __future__ import annotations

import hashlib
import logging
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import ClearLinesError, TooLarge
from app.formats.labelled import LabelledSegments
from app.formats.npz import read_npz, write_npz
from app.images.decode import decode_gray
from app.vision.distortion import DistortionEstimate, estimate_distortion
from app.vision.division import Division
from app.vision.history import SegmentHistory, detect_with_history
from app.vision.parameters import DetectionParameters
from app.vision.prelabel import detect_for_prelabel, long_enough_for_lens
from app.vision.sampson import sampson_residuals
from app.vision.segments import Segments
from app.vision.straightness import judge_straightness

logger = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Judgement:
    """How straight S candidates are under a lens.

    Attributes:
        straightness: float32 ``(S,)`` in [0, 1].
        residuals: float32 ``(S,)``, RMS deviation from straight, px.
    """

    straightness: NDArray[np.float32]
    residuals: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class DetectionResult:
    """What one image gives.

    Attributes:
        candidates: Segments with scores, px.
        milliseconds: Time of the detection.
        lens_segments: npz bytes of what the joint estimate reads; ``None`` where the lens was estimated here.
        judgement: Of the candidates, under the lens estimated here.
        distortion: That lens.
    """

    candidates: Segments
    milliseconds: float
    lens_segments: bytes | None
    judgement: Judgement | None = None
    distortion: dict[str, Any] | None = None


@dataclass(frozen=True, eq=False)
class ImageHistory:
    """How the candidates of one image came about.

    Attributes:
        by_points: Histories by the ``fingerprint`` of the candidate's points.
        typical: Mean of each feature of the score over the candidates, by name.
    """

    by_points: dict[bytes, SegmentHistory]
    typical: dict[str, float]


def detect_task(
    content: bytes, name: str, parameters: Mapping[str, Any], *, alone: bool, discard: bool, max_pixels: int
) -> DetectionResult:
    """Detect the candidates of one image.

    Args:
        content: The image file.
        name: Of the image, for messages.
        parameters: Fields of ``DetectionParameters``.
        alone: Whether the lens is estimated from this image alone, here and now.
        discard: Whether candidates that fail straightness under that lens are dropped.
        max_pixels: Greatest number of pixels that is decoded.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel(name):
        gray = decode_gray(content, max_pixels=max_pixels)
        found = detect_for_prelabel(gray, DetectionParameters.from_dict(parameters))
        milliseconds = found.seconds * 1000
        if not alone:
            lens_segments = write_npz(LabelledSegments(found.lens_segments))
            return DetectionResult(found.candidates, milliseconds, lens_segments)
        estimate = estimate_distortion([found.lens_segments], (found.width, found.height))
        candidates, judgement = found.candidates, _judge(found.candidates, estimate)
        if discard:
            passing = judgement.straightness >= 0.5
            candidates = candidates.select(passing)
            judgement = Judgement(judgement.straightness[passing], judgement.residuals[passing])
        return DetectionResult(candidates, milliseconds, None, judgement, estimate.as_dict())


def estimate_task(lens_segments: Sequence[bytes], size: tuple[int, int]) -> dict[str, Any]:
    """Estimate the lens that images share.

    Args:
        lens_segments: npz bytes of each image's segments.
        size: Width and height of the images, px.

    Returns:
        ``DistortionEstimate.as_dict()``; a refused one, with reasons, where the segments don't tell.
    """
    with errors_that_travel("camera"):
        return estimate_distortion([read_npz(content).segments for content in lens_segments], size).as_dict()


def judge_task(candidates: Segments, distortion: Mapping[str, Any]) -> Judgement:
    """Judge how straight candidates are under a camera's lens.

    Args:
        candidates: S segments, px.
        distortion: ``DistortionEstimate.as_dict()``.
    """
    with errors_that_travel("candidates"):
        return _judge(candidates, DistortionEstimate.from_dict(distortion))


def history_task(content: bytes, name: str, parameters: Mapping[str, Any], *, max_pixels: int) -> ImageHistory:
    """Detect the candidates of one image as ``detect_task`` does, and tell how each came about.

    Args:
        content: The image file.
        name: Of the image, for messages.
        parameters: Fields of ``DetectionParameters``.
        max_pixels: Greatest number of pixels that is decoded.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel(name):
        chosen = DetectionParameters.from_dict(parameters)
        # as `detect_for_prelabel`: what is merged and trimmed depends on the shortest segment asked for
        gray = decode_gray(content, max_pixels=max_pixels)
        segments, histories = detect_with_history(gray, long_enough_for_lens(chosen))
        candidates = [
            (fingerprint(segments[index].astype("<f4").tobytes()), histories[index])
            for index in np.flatnonzero(segments.extents() >= chosen.min_length).tolist()
        ]
        names = candidates[0][1].features if candidates else {}
        typical = {name: float(np.mean([history.features[name] for _, history in candidates])) for name in names}
        return ImageHistory(dict(candidates), typical)


def fingerprint(points: bytes) -> bytes:
    """Return what tells a polyline from all others, from its points as they are stored: float32, little endian."""
    return hashlib.sha256(points).digest()


def _judge(candidates: Segments, estimate: DistortionEstimate) -> Judgement:
    if not len(candidates):
        return Judgement(np.zeros(0, np.float32), np.zeros(0, np.float32))
    # under a refused lens nothing is known, so a segment is compared with a line in the image as it is
    lens = estimate.division if estimate.accepted else Division(estimate.width, estimate.height)
    residuals = sampson_residuals(candidates, lens)
    squares = np.bincount(candidates.segment_of_point, residuals**2, len(candidates))
    rms = np.sqrt(squares / candidates.counts).astype(np.float32)
    return Judgement(judge_straightness(candidates, estimate), rms)


@contextmanager
def errors_that_travel(where: str, what: str = "the pipeline") -> Iterator[None]:
    """Turn whatever is raised inside into an error of the tree.

    Args:
        where: What it is about, where the error doesn't say it itself.
        what: What is being done, for messages.
    """
    try:
        yield
    except ClearLinesError as error:
        error.where = error.where or where
        raise
    except MemoryError as error:
        raise TooLarge(
            "there isn't enough memory for it", where=where, hint="run with fewer workers, or on a larger machine"
        ) from error
    except Exception as error:
        logger.exception("%s failed on %s", what, where)
        raise ClearLinesError(
            f"{what} failed: {type(error).__name__}: {error}",
            where=where,
            hint="this is a fault of ClearLines, not of what it was given; please report it",
        ) from None
