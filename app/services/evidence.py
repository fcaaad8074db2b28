"""What speaks for and against a candidate, measured along it when somebody looks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from sqlalchemy.orm import Session, undefer

from app.db.models import Segment
from app.errors import NotFound
from app.images import decode_gray
from app.services.image_lens import lens_of_image
from app.services.images import get_image
from app.vision.brown import Brown
from app.vision.distortion import DistortionEstimate
from app.vision.edge_profile import edge_profile
from app.vision.intensity import to_eight_bit
from app.vision.sampson import sampson_residuals
from app.vision.segments import Segments
from app.vision.straightness import edge_noise

MOST_SAMPLES = 400
"""Places along a candidate that are told; a strip on the page is no wider in px."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Subject:
    """A segment and what its evidence is measured with."""

    segment_id: int
    image_id: int
    sha256: str
    points: NDArray[np.float32]
    length: float
    score: float | None
    straightness: float | None
    lens: DistortionEstimate | None


@dataclass(frozen=True)
class Evidence:
    """Evidence along a segment, from its first point to its last.

    Attributes:
        along: Arc length at each place, px.
        deviation: Distance from the segment's straight line under the lens, in the measured image, px; positive towards
            (-dy, dx) where (dx, dy) leads from the first point to the last.
        step: Brightness to the right of the way minus to the left, grey levels.
        lens: Whether the lens is known: ``accepted``, or ``refused`` or ``none``, where straight means straight in the
            image as it is.
        residual: RMS of the deviation, px.
        maximum: Its largest size, px.
        noise: Standard deviation of the segment's own points across the edge, px.
        contrast: Median size of the step, grey levels.
        evenness: Lower quartile of the step's size over its median, 0 to 1.
        polarity: Share of the points whose bright side is the one that most have, 0.5 to 1.
    """

    segment_id: int
    image_id: int
    along: tuple[float, ...]
    deviation: tuple[float, ...]
    step: tuple[float, ...]
    lens: str
    residual: float
    maximum: float
    noise: float
    length: float
    contrast: float
    evenness: float
    polarity: float
    score: float | None
    straightness: float | None


def subject_of(session: Session, segment_id: int) -> Subject:
    """Return a segment with what its evidence is measured with.

    Raises:
        NotFound: When there is no such segment, or its image is deleted.
    """
    segment = session.get(Segment, segment_id, options=[undefer(Segment.points)])
    if segment is None:
        raise NotFound(f"there is no segment {segment_id}")
    image = get_image(session, segment.image_id)
    return Subject(
        segment_id=segment.id,
        image_id=image.id,
        sha256=image.sha256,
        points=np.frombuffer(segment.points, "<f4").reshape(-1, 2),
        length=segment.length,
        score=segment.score,
        straightness=segment.straightness,
        lens=lens_of_image(session, image),
    )


def measure_evidence(subject: Subject, content: bytes, *, max_pixels: int) -> Evidence:
    """Measure the evidence.

    Args:
        subject: The segment.
        content: The image's file.
        max_pixels: Greatest number of pixels to decode.

    Raises:
        InvalidImage: If the image can't be read.
        TooLarge: If it has more pixels than accepted.
    """
    gray = to_eight_bit(decode_gray(content, max_pixels=max_pixels))
    points = subject.points
    segments = Segments.from_list([points])
    known = subject.lens is not None and subject.lens.accepted
    brown = subject.lens.brown if subject.lens is not None and known else Brown.identity(gray.shape[1], gray.shape[0])
    deviation = sampson_residuals(segments, brown)
    profile = edge_profile(gray, points)
    places = np.linspace(0, len(points) - 1, min(len(points), MOST_SAMPLES)).round().astype(np.int64)
    return Evidence(
        segment_id=subject.segment_id,
        image_id=subject.image_id,
        along=_told(profile.along, places),
        deviation=_told(deviation, places),
        step=_told(profile.step, places),
        lens="none" if subject.lens is None else "accepted" if known else "refused",
        residual=float(np.sqrt(np.mean(deviation**2))),
        maximum=float(np.abs(deviation).max()),
        noise=edge_noise(segments),
        length=subject.length,
        contrast=profile.contrast,
        evenness=profile.evenness,
        polarity=profile.polarity,
        score=subject.score,
        straightness=subject.straightness,
    )


def _told(values: Array, places: NDArray[np.int64]) -> tuple[float, ...]:
    return tuple(np.round(values[places], 4).tolist())
