"""Which submissions stand on a board: of each method its best, of a hidden split the one that the Ladder shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session, contains_eager

from app.db.models import ImageScore, Score, SplitImage, SplitVersion, Submission
from app.evaluation.bootstrap import DRAWS, clusters_of, weight_blocks
from app.evaluation.ladder import ladder
from app.evaluation.metrics import f1
from app.evaluation.submission_totals import SEED
from app.services.score_totals import DIGITS


@dataclass(frozen=True, eq=False)
class Entry:
    """A scored submission with what ranks it.

    Attributes:
        value: F1 over the images.
        drawn: float64 ``(B,)``, F1 of each draw of the images; the same draws for all entries of a split version.
    """

    submission: Submission
    score: Score
    value: float
    drawn: NDArray[np.float64]


def scored_entries(session: Session, version: SplitVersion, protocol: str, protocol_version: str) -> list[Entry]:
    """Return the scored public submissions of a split version, in the order in which they were handed in.

    Args:
        session: Any session.
        version: Of the split.
        protocol: The rank protocol.
        protocol_version: Its version.
    """
    scores = session.scalars(
        select(Score)
        .join(Score.submission)
        .join(Submission.method)
        .where(
            Score.split_version_id == version.id,
            Score.protocol == protocol,
            Score.protocol_version == protocol_version,
            Score.status == "done",
            Submission.status == "scored",
            Submission.visibility == "public",
        )
        .options(contains_eager(Score.submission).contains_eager(Submission.method))
        .order_by(Submission.created_at, Submission.id)
    ).all()
    if not scores:
        return []
    clusters = clusters_in(session, version)
    counts = _counts(session, scores, len(clusters))
    values = f1(*counts.sum(axis=1).T)
    drawn = np.concatenate([_drawn(weights, counts) for weights in weight_blocks(clusters, DRAWS, seed=SEED)], axis=1)
    return [
        Entry(score.submission, score, float(value), draws)
        for score, value, draws in zip(scores, values, drawn, strict=True)
    ]


def clusters_in(session: Session, version: SplitVersion) -> NDArray[np.int64]:
    """Return the cluster of each image of a split version, int64 ``(I,)``, in its order."""
    query = select(SplitImage.sequence).where(SplitImage.version_id == version.id).order_by(SplitImage.ordinal)
    return clusters_of(session.scalars(query).all())


def best_entries(entries: Sequence[Entry], *, hidden: bool) -> list[Entry]:
    """Return one entry per method, the best first.

    Args:
        entries: In the order in which they were handed in.
        hidden: Whether a new best is shown only beyond its noise.
    """
    by_method: dict[int, list[Entry]] = {}
    for entry in entries:
        by_method.setdefault(entry.submission.method_id, []).append(entry)
    best = [_shown(group) if hidden else max(group, key=lambda entry: entry.value) for group in by_method.values()]
    # the order of a hidden split's rows tells no more than its rounded numbers do
    digits = DIGITS if hidden else 15
    return sorted(best, key=lambda entry: (-round(entry.value, digits), entry.submission.created_at, entry.score.id))


def _shown(group: Sequence[Entry]) -> Entry:
    values = np.array([entry.value for entry in group])
    return group[int(ladder(values, np.array([entry.drawn for entry in group]))[-1])]


def _counts(session: Session, scores: Sequence[Score], images: int) -> NDArray[np.float64]:
    """Return true positives, false positives and false negatives, float64 ``(R, I, 3)``, in the split's order."""
    places = {score.id: place for place, score in enumerate(scores)}
    rows = session.execute(
        select(ImageScore.score_id, SplitImage.ordinal, ImageScore.tp, ImageScore.fp, ImageScore.fn)
        .join(SplitImage, SplitImage.id == ImageScore.split_image_id)
        .where(ImageScore.score_id.in_(places))
    ).all()
    table = np.array([tuple(row) for row in rows], dtype=np.int64).reshape(-1, 5)
    row_of = np.array([places[score] for score in table[:, 0].tolist()], dtype=np.int64)
    ordinals, column = np.unique(table[:, 1], return_inverse=True)
    counts = np.zeros((len(scores), max(images, len(ordinals)), 3))
    counts[row_of, column] = table[:, 2:]
    return counts


def _drawn(weights: NDArray[np.float64], counts: NDArray[np.float64]) -> NDArray[np.float64]:
    tp, fp, fn = (counts[:, :, part] @ weights.T for part in range(3))
    return f1(tp, fp, fn)
