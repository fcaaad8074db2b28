"""Features of an image's candidates: what they are computed from, and their copy in the database.

They follow from the image, its candidates, its lens and the frames beside it, and from nothing that a person decided.
What is stored is made anew when any of these changes.
"""

from __future__ import annotations

import hashlib
import io
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import ColumnElement, or_, select
from sqlalchemy.orm import Session, undefer

from app.db.models import Dataset, Image, ImageFeatures, Run, RunImage, Segment
from app.review.features import FEATURE_VERSION, FEATURES
from app.services.candidates import current_segments
from app.services.carrying import stored_polyline
from app.services.image_lens import lens_fields
from app.services.images import get_image
from app.services.neighbour_frames import FramesBeside, frames_beside
from app.services.run_queue import UNFINISHED
from app.vision.segments import Segments


@dataclass(frozen=True, eq=False)
class FeatureInputs:
    """What the features of one image's S candidates are computed from.

    Attributes:
        revision: The image's, when this was read.
        version: Of the features, and of the frames beside the image.
        sha256: Of the image's file.
        size: Width and height, px.
        segment_ids: int64 ``(S,)``.
        segments: The candidates with their scores, NaN where not known, px.
        residuals: float32 ``(S,)``, RMS deviation from straight under the lens, px; NaN where not known.
        straightness: float32 ``(S,)`` in [0, 1]; NaN where not known.
        distortion: ``DistortionEstimate.as_dict``, if there is a lens.
        before: Candidates of the frame before, px.
        after: Candidates of the frame after, px.
    """

    image_id: int
    image_name: str
    revision: int
    version: str
    sha256: str
    size: tuple[int, int]
    segment_ids: NDArray[np.int64]
    segments: Segments
    residuals: NDArray[np.float32]
    straightness: NDArray[np.float32]
    distortion: dict[str, Any] | None
    before: Segments | None
    after: Segments | None


@dataclass(frozen=True, eq=False)
class KnownFeatures:
    """What is known of S candidates of one image.

    Attributes:
        segment_ids: int64 ``(S,)``.
        features: float32 ``(S, F)`` in the order of ``app.review.features.FEATURES``.
        families: int64 ``(S,)``, number of each candidate's family, -1 for one alone.
        lens_information: float64 ``(S,)`` in [0, 1], what each would tell of the lens.
    """

    segment_ids: NDArray[np.int64]
    features: NDArray[np.float32]
    families: NDArray[np.int64]
    lens_information: NDArray[np.float64]


def known_features(session: Session, image: Image) -> KnownFeatures | None:
    """Return the stored features of an image; ``None`` if there are none, or they are out of date."""
    if image.n_candidates == 0:
        return KnownFeatures(
            np.zeros(0, np.int64), np.zeros((0, len(FEATURES)), np.float32), np.zeros(0, np.int64), np.zeros(0)
        )
    row = session.get(ImageFeatures, image.id, options=[undefer(ImageFeatures.content)])
    if row is None or (row.revision, row.version) != (image.revision, _version(frames_beside(session, image))):
        return None
    return unpacked(row.content)


def feature_inputs(session: Session, image_id: int) -> FeatureInputs:
    """Return what the features of an image's candidates are computed from.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    image = get_image(session, image_id)
    beside = frames_beside(session, image)
    wanted = (Segment.id, Segment.points, Segment.score, Segment.residual, Segment.straightness)
    rows = session.execute(current_segments(*wanted).where(Segment.image_id == image.id)).all()
    polylines = [stored_polyline(row.points) for row in rows]
    work = session.get(RunImage, image.current_run_image_id) if image.current_run_image_id else None
    return FeatureInputs(
        image_id=image.id,
        image_name=image.name,
        revision=image.revision,
        version=_version(beside),
        sha256=image.sha256,
        size=(image.width, image.height),
        segment_ids=np.array([row.id for row in rows], np.int64),
        segments=Segments.from_list(polylines, _numbers([row.score for row in rows])),
        residuals=_numbers([row.residual for row in rows]),
        straightness=_numbers([row.straightness for row in rows]),
        distortion=lens_fields(session, image, work),
        before=_candidates(session, beside.before),
        after=_candidates(session, beside.after),
    )


def store_features(session: Session, inputs: FeatureInputs, known: KnownFeatures, now: datetime) -> bool:
    """Store the features of an image's candidates; False, with nothing stored, if these are others by now.

    Args:
        session: A writing session.
        inputs: What they were computed from.
        known: Them.
        now: When.
    """
    image = session.get(Image, inputs.image_id, with_for_update=True, populate_existing=True)
    if image is None or image.revision != inputs.revision:
        return False
    row = session.get(ImageFeatures, image.id)
    if row is None:
        row = ImageFeatures(image_id=image.id)
        session.add(row)
    row.revision, row.version = inputs.revision, inputs.version
    row.content, row.created_at = packed(known), now
    return True


def images_without_features(session: Session, limit: int) -> list[int]:
    """Return images whose features aren't stored, or were of other candidates; not of datasets that a run works on."""
    busy = select(Run.dataset_id).where(Run.status.in_(UNFINISHED), Run.deleted_at.is_(None))
    query = (
        select(Image.id)
        .join(Dataset, Dataset.id == Image.dataset_id)
        .outerjoin(ImageFeatures, ImageFeatures.image_id == Image.id)
        .where(Image.deleted_at.is_(None), Dataset.deleted_at.is_(None), Image.n_candidates > 0, has_no_features())
        .where(Image.dataset_id.not_in(busy))
        .order_by(Image.id)
        .limit(limit)
    )
    return list(session.scalars(query))


def has_no_features() -> ColumnElement[bool]:
    """Return the condition that an image's features are to be computed, on ``Image`` outer-joined to its features."""
    return or_(ImageFeatures.image_id.is_(None), ImageFeatures.revision != Image.revision, ~of_this_version())


def of_this_version() -> ColumnElement[bool]:
    """Return the condition that stored features mean what they mean now."""
    return ImageFeatures.version.like(f"{FEATURE_VERSION}-%")


def packed(known: KnownFeatures) -> bytes:
    """Return features as bytes: plain arrays in an npz."""
    stream = io.BytesIO()
    np.savez(
        stream,
        segment_ids=known.segment_ids,
        features=known.features,
        families=known.families.astype(np.int32),
        lens_information=known.lens_information.astype(np.float32),
    )
    return stream.getvalue()


def unpacked(content: bytes) -> KnownFeatures:
    """Return the features that `packed` made bytes of."""
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        return KnownFeatures(
            arrays["segment_ids"],
            arrays["features"],
            arrays["families"].astype(np.int64),
            arrays["lens_information"].astype(np.float64),
        )


def _version(beside: FramesBeside) -> str:
    frames = [(frame.id, frame.current_run_image_id) if frame else None for frame in (beside.before, beside.after)]
    return f"{FEATURE_VERSION}-{hashlib.sha256(repr(frames).encode()).hexdigest()[:16]}"


def _candidates(session: Session, image: Image | None) -> Segments | None:
    if image is None or image.n_candidates == 0:
        return None
    rows = session.scalars(current_segments(Segment.points).where(Segment.image_id == image.id)).all()
    return Segments.from_list([stored_polyline(points) for points in rows])


def _numbers(values: Sequence[float | None]) -> NDArray[np.float32]:
    return np.array([np.nan if value is None else value for value in values], np.float32)
