"""What a worker does to describe candidates: pure functions, bytes and arrays in, arrays out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput, TooLarge
from app.images.decode import decode_gray
from app.jobs.tasks import errors_that_travel
from app.review.families import families
from app.review.features import NeighbourFrames, candidate_features
from app.review.review_order import lens_information
from app.vision.distortion import DistortionEstimate
from app.vision.intensity import to_eight_bit
from app.vision.segments import Segments


@dataclass(frozen=True, eq=False)
class CandidateFacts:
    """What is told of S candidates of one image.

    Attributes:
        features: float32 ``(S, F)``.
        families: int64 ``(S,)``, -1 for one alone.
        lens_information: float64 ``(S,)`` in [0, 1].
    """

    features: NDArray[np.float32]
    families: NDArray[np.int64]
    lens_information: NDArray[np.float64]


def features_task(
    content: bytes,
    name: str,
    segments: Segments,
    size: tuple[int, int],
    *,
    residuals: NDArray[np.float32],
    straightness: NDArray[np.float32],
    distortion: Mapping[str, Any] | None,
    before: Segments | None,
    after: Segments | None,
    max_pixels: int,
) -> CandidateFacts:
    """Describe the candidates of one image.

    Args:
        content: The image file; what it would tell isn't known where it can't be read.
        name: Of the image, for messages.
        segments: S candidates with scores, NaN where not known, px.
        size: Width and height of the image, px.
        residuals: float32 ``(S,)``, px, NaN where not known.
        straightness: float32 ``(S,)`` in [0, 1], NaN where not known.
        distortion: ``DistortionEstimate.as_dict()``, if there is a lens.
        before: Candidates of the frame before, px.
        after: Candidates of the frame after, px.
        max_pixels: Greatest number of pixels that is decoded.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel(name, "describing the candidates"):
        features = candidate_features(
            segments,
            gray=_gray(content, size, max_pixels),
            size=size,
            residuals=residuals,
            straightness=straightness,
            lens=_lens(distortion),
            neighbours=NeighbourFrames(before, after),
        )
        return CandidateFacts(features, families(segments, size), lens_information(segments, size))


def _gray(content: bytes, size: tuple[int, int], max_pixels: int) -> NDArray[np.uint8] | None:
    try:
        gray = to_eight_bit(decode_gray(content, max_pixels=max_pixels))
    except (InvalidInput, TooLarge):
        return None
    return gray if gray.shape == (size[1], size[0]) else None


def _lens(distortion: Mapping[str, Any] | None) -> DistortionEstimate | None:
    """Return the lens; none where another version of ClearLines wrote it in another way."""
    try:
        return None if distortion is None else DistortionEstimate.from_dict(distortion)
    except InvalidInput:
        return None
