"""What a dataset's suggestions are learnt from.

An image teaches once all of its candidates are decided: half-way through, those decided are the most obvious ones, and
a model would take them for typical. What a person accepted of earlier suggestions counts then, too: who calls an image
done has looked at it. Imported verdicts and segments drawn by hand don't count: nobody judged these as candidates.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import datetime

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import ColumnElement, Select, and_, select
from sqlalchemy.orm import Session

from app.db.models import Decision, Image, ImageFeatures, Review, Segment, SegmentState
from app.review.features import FEATURES
from app.services.batches import in_batches
from app.services.candidates import current_segments
from app.services.suggestion_features import KnownFeatures, has_no_features, of_this_version, unpacked

MOST_EXAMPLES = 20_000
"""Decisions that one model is learnt from, the newest images' first."""


@dataclass(frozen=True, eq=False)
class Examples:
    """N decisions to learn from.

    Attributes:
        features: float32 ``(N, F)``.
        kept: bool ``(N,)``, whether a person kept the candidate.
        image_index: int64 ``(N,)``, which image it is in: 0 for the one finished first.
    """

    features: NDArray[np.float32]
    kept: NDArray[np.bool_]
    image_index: NDArray[np.int64]


def teaches() -> ColumnElement[bool]:
    """Return the rule which images count as a condition on ``Image`` and ``Review``."""
    return and_(
        Image.deleted_at.is_(None),
        Image.n_candidates > 0,
        Image.n_candidates == Image.n_keep + Image.n_reject + Image.n_ambiguous,
        Review.status != "discarded",
    )


def judged_candidates(dataset_id: int) -> Select[int, int, str]:
    """Select image_id, segment id and verdict of the candidates that a dataset's model is learnt from."""
    return (
        current_segments(Segment.image_id, Segment.id, SegmentState.verdict)
        .join(Decision, Decision.id == SegmentState.decision_id)
        .join(Image, Image.id == Segment.image_id)
        .join(Review, Review.image_id == Image.id)
        .where(
            Image.dataset_id == dataset_id,
            teaches(),
            Segment.origin != "manual",
            SegmentState.verdict.in_(("keep", "reject")),
            Decision.kind != "import",
        )
    )


def images_to_describe(dataset_id: int) -> Select[int]:
    """Select the images that a dataset's model is learnt from whose features aren't stored."""
    teaching = judged_candidates(dataset_id).with_only_columns(Segment.image_id).order_by(None)
    return (
        select(Image.id)
        .outerjoin(ImageFeatures, ImageFeatures.image_id == Image.id)
        .where(Image.id.in_(teaching), has_no_features())
        .order_by(Image.id)
    )


def training_examples(session: Session, dataset_id: int) -> Examples:
    """Return the decisions that a dataset's model is learnt from, oldest image first."""
    rows = session.execute(judged_candidates(dataset_id)).all()
    kept_of: dict[int, dict[int, bool]] = {}
    for image_id, segment_id, verdict in rows:
        kept_of.setdefault(image_id, {})[segment_id] = verdict == "keep"
    chosen = _newest(session, kept_of)
    features = _features(session, chosen)
    parts = [
        (known.features[mask], [kept_of[image_id][key] for key in known.segment_ids[mask].tolist()])
        for image_id in chosen
        if (known := features.get(image_id)) is not None
        and (mask := np.isin(known.segment_ids, list(kept_of[image_id]))).any()
    ]
    if not parts:
        return Examples(np.zeros((0, len(FEATURES)), np.float32), np.zeros(0, bool), np.zeros(0, np.int64))
    return Examples(
        np.concatenate([part[0] for part in parts]),
        np.concatenate([np.array(part[1], bool) for part in parts]),
        np.repeat(np.arange(len(parts)), [len(part[1]) for part in parts]),
    )


def _newest(session: Session, kept_of: Mapping[int, Mapping[int, bool]]) -> list[int]:
    """Return the images finished last that fill what one model is learnt from, oldest first."""
    finished: list[tuple[datetime, int]] = []
    for batch in in_batches(sorted(kept_of)):
        query = select(Review.updated_at, Review.image_id).where(Review.image_id.in_(batch))
        finished += [(time, image_id) for time, image_id in session.execute(query)]
    chosen: list[int] = []
    left = MOST_EXAMPLES
    for _, image_id in sorted(finished, reverse=True):
        left -= len(kept_of[image_id])
        if left < 0 and chosen:
            break
        chosen.append(image_id)
    return chosen[::-1]


def _features(session: Session, image_ids: Collection[int]) -> dict[int, KnownFeatures]:
    found: dict[int, KnownFeatures] = {}
    for batch in in_batches(sorted(image_ids)):
        rows = session.execute(
            select(ImageFeatures.image_id, ImageFeatures.content).where(
                ImageFeatures.image_id.in_(batch), of_this_version()
            )
        )
        found.update({image_id: unpacked(content) for image_id, content in rows})
    return found
