"""Segments that a hand drew, as rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import Image, Segment
from app.services.carrying import POINT
from app.services.image_lens import lens_of_image
from app.vision.distortion import DistortionEstimate
from app.vision.segments import Segments
from app.vision.straightness import judge_straightness
from app.vision.tracing import measured_trace


def manual_rows(session: Session, image: Image, segments: Segments) -> list[Segment]:
    """Return rows of origin ``manual``, measured under the image's lens where that is known.

    Args:
        session: A session that holds the image's row.
        image: The image.
        segments: What was drawn, px.
    """
    highest = select(func.max(Segment.ordinal)).where(Segment.image_id == image.id, Segment.origin == "manual")
    first = (session.scalar(highest) or 0) + 1
    estimate = lens_of_image(session, image)
    straightness = [None] * len(segments) if estimate is None else judge_straightness(segments, estimate).tolist()
    boxes, lengths = segments.boxes().tolist(), segments.lengths().tolist()
    return [
        Segment(
            image_id=image.id,
            ordinal=first + index,
            n_points=len(points),
            points=points.astype(POINT).tobytes(),
            x0=boxes[index][0],
            y0=boxes[index][1],
            x1=boxes[index][2],
            y1=boxes[index][3],
            length=lengths[index],
            residual=_residual(points, image, estimate),
            straightness=straightness[index],
            origin="manual",
        )
        for index, points in enumerate(segments)
    ]


def _residual(points: NDArray[np.float32], image: Image, estimate: DistortionEstimate | None) -> float | None:
    if estimate is None:
        return None
    lens = estimate.division if estimate.accepted else None
    return measured_trace(points, (image.width, image.height), lens).residual
