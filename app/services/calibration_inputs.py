"""The lines that a camera's lens is estimated from, read from the rows: bounded, and an image at a time.

What a camera has beyond the bounds is left out evenly: images spread over all of them, and in each image the shorter
lines first, which tell least of a lens.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.calibration.work_order import CalibrationInputs, StoredLines
from app.db.models import Camera, Image, Review, Segment
from app.services.calibration_queue import CalibrationClaim
from app.services.calibration_scope import images_of_camera, images_with_lines, newest_decision
from app.services.candidates import current_segments, verdict_of_segment
from app.services.carrying import stored_polyline
from app.vision.segments import Segments

MOST_IMAGES = 200
MOST_SEGMENTS = 12_000
"""Lines of all images together, 60 of each of 200: more take minutes, and tell no more of a lens."""
MOST_POINTS = 4_000_000
"""Points of all lines together; they take 8 bytes each."""
MOST_UNLABELLED_IMAGES = 40
"""Images of which the advice says what their lines would tell."""
MOST_UNLABELLED_SEGMENTS = 400
"""Candidates of each of these."""
UNKNOWN = 0.5
"""Probability of being straight of a candidate that nothing is known of."""


def calibration_inputs(session: Session, claim: CalibrationClaim) -> CalibrationInputs:
    """Return what a calibration is made from.

    Args:
        session: A session that sees one snapshot.
        claim: Which one.
    """
    camera = session.get_one(Camera, claim.camera_id)
    available = session.execute(images_with_lines(camera, claim.source)).all()
    chosen = [available[index] for index in spread(len(available), MOST_IMAGES)]
    share = fair_share([row.segments for row in chosen], MOST_SEGMENTS)
    points = MOST_POINTS // max(len(chosen), 1)
    lines = [_lines_of(session, row.id, claim.source, share, points) for row in chosen]
    images = tuple(each for each in lines if len(each.segments))
    parameters = {
        "images": [each.image_id for each in images],
        "segments": sum(len(each.segments) for each in images),
        "images_available": len(available),
        "segments_available": sum(row.segments for row in available),
        "most_images": MOST_IMAGES,
        "most_segments": MOST_SEGMENTS,
        "newest_decision": newest_decision(session, camera),
    }
    return CalibrationInputs(images, _unlabelled(session, camera), parameters)


def spread(count: int, most: int) -> list[int]:
    """Return at most ``most`` of the indices below ``count``, spread evenly."""
    if count <= most:
        return list(range(count))
    return [int(index) for index in np.linspace(0, count - 1, most)]


def fair_share(numbers: Sequence[int], most: int) -> int:
    """Return how many each may give at most, so that all together give no more than ``most``.

    Who has fewer gives all; what they leave over goes to the others.
    """
    left = most
    for place, number in enumerate(sorted(numbers)):
        share = left // (len(numbers) - place)
        if number > share:
            return max(share, 1)
        left -= number
    return max(numbers, default=1)


def _unlabelled(session: Session, camera: Camera) -> tuple[StoredLines, ...]:
    """Return candidates of open images without kept lines, those of images spread over all of them."""
    rows = session.scalars(
        select(Image.id)
        .join(Review, Review.image_id == Image.id)
        .where(images_of_camera(camera), Image.n_keep == 0, Image.n_candidates > Image.n_reject)
        .where(Review.status == "open")
        .order_by(Image.name)
    ).all()
    chosen = [rows[index] for index in spread(len(rows), MOST_UNLABELLED_IMAGES)]
    points = MOST_POINTS // MOST_IMAGES
    lines = [_lines_of(session, image_id, "candidates", MOST_UNLABELLED_SEGMENTS, points) for image_id in chosen]
    return tuple(each for each in lines if len(each.segments))


def _lines_of(session: Session, image_id: int, source: str, most: int, most_points: int) -> StoredLines:
    """Read the longest lines of an image."""
    verdict = verdict_of_segment()
    wanted = verdict == "keep" if source == "labels" else verdict != "reject"
    columns = (
        Segment.id,
        Segment.n_points,
        Segment.points,
        func.coalesce(Segment.straightness, Segment.score, UNKNOWN).label("probability"),
        verdict.label("verdict"),
    )
    query = current_segments(*columns).where(Segment.image_id == image_id, Segment.n_points >= 2, wanted)
    rows = session.execute(query.order_by(None).order_by(Segment.length.desc(), Segment.id).limit(most)).all()
    within = np.cumsum([row.n_points for row in rows]) <= most_points
    read = sorted((row for row, fits in zip(rows, within, strict=True) if fits), key=lambda row: row.id)
    name = session.get_one(Image, image_id).name
    return StoredLines(
        image_id,
        name,
        np.array([row.id for row in read], np.int64),
        Segments.from_list([stored_polyline(row.points) for row in read]),
        None if source == "labels" else _probabilities(read),
    )


def _probabilities(rows: Sequence[Any]) -> NDArray[np.float64]:
    """What a person kept is straight; of the others it is as likely as the detection says."""
    stated = [1.0 if row.verdict == "keep" else row.probability for row in rows]
    return np.clip(np.nan_to_num(np.array(stated, np.float64), nan=UNKNOWN), 0.0, 1.0)
