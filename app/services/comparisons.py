"""Two submissions on the same images: every metric's paired difference, and on how many images which one is better."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import ImageScore, Score, SplitImage, Submission
from app.errors import Conflict
from app.evaluation.bootstrap import DRAWS, clusters_of
from app.evaluation.comparison import Difference, compare
from app.evaluation.submission_totals import SEED, measure_of
from app.services.scoring_inputs import recorded_images

EQUAL = 1e-9
"""F1 that differ by less are equal."""


@dataclass(frozen=True)
class ImageVerdicts:
    """On how many images the second submission's F1 is higher, lower, equal."""

    better: int
    worse: int
    equal: int


@dataclass(frozen=True)
class Comparison:
    """Two submissions a and b; differences are b - a."""

    a: int
    b: int
    protocol: str
    draws: int
    metrics: dict[str, Difference]
    images: ImageVerdicts


def compare_submissions(session: Session, a: Submission, b: Submission) -> Comparison:
    """Compare two submissions by their newest scores on a common version of the split and the protocol.

    Raises:
        Conflict: When there is no such pair of scores.
    """
    first, second = _common_scores(session, a, b)
    ids, records_a = recorded_images(session, first.id)
    ids_b, records_b = recorded_images(session, second.id)
    if ids != ids_b:
        raise Conflict("the two were not scored on the same images")
    sequences = session.scalars(
        select(SplitImage.sequence).where(SplitImage.version_id == first.split_version_id).order_by(SplitImage.ordinal)
    ).all()
    metrics = compare(
        measure_of(records_a, first.protocol),
        measure_of(records_b, first.protocol),
        clusters_of(sequences),
        seed=SEED,
    )
    return Comparison(a.id, b.id, first.protocol, DRAWS, metrics, _verdicts(session, first, second))


def _common_scores(session: Session, a: Submission, b: Submission) -> tuple[Score, Score]:
    def key(score: Score) -> tuple[int, str, str]:
        return score.split_version_id, score.protocol, score.protocol_version

    rows = session.scalars(
        select(Score).where(Score.submission_id.in_([a.id, b.id]), Score.status == "done").order_by(Score.id.desc())
    ).all()
    of_b = {key(score): score for score in reversed(rows) if score.submission_id == b.id}
    for score in rows:
        if score.submission_id == a.id and key(score) in of_b:
            return score, of_b[key(score)]
    raise Conflict(
        "the two have no score under the same version of split and protocol",
        hint="have one of them scored anew",
    )


def _verdicts(session: Session, first: Score, second: Score) -> ImageVerdicts:
    def by_image(score: Score) -> dict[int, float]:
        rows = session.execute(select(ImageScore.split_image_id, ImageScore.f1).where(ImageScore.score_id == score.id))
        return {image: value or 0.0 for image, value in rows}

    values_a, values_b = by_image(first), by_image(second)
    rises = [values_b[image] - values_a[image] for image in values_a if image in values_b]
    better, worse = sum(rise > EQUAL for rise in rises), sum(rise < -EQUAL for rise in rises)
    return ImageVerdicts(better, worse, len(rises) - better - worse)
