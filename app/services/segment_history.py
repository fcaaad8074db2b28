"""How a candidate was found: which detection to do over, and what to tell of it.

Histories aren't stored. A detection that is done over takes well under a second and gives the same points bit for bit;
a candidate whose points it doesn't give came from another version of the pipeline.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session, undefer

from app.db.models import Run, RunImage, Segment
from app.errors import InvalidInput, NoHistory, NotFound
from app.services.images import get_image
from app.services.run_parameters import RunParameters
from app.services.score_parts import ScorePart, score_parts
from app.vision.history import Round, SegmentHistory
from app.vision.scoring import INTERCEPT

Place = tuple[float, float]

_ORIGINS = {
    "manual": "a person drew this segment, so the pipeline has no history of it",
    "import": "this segment was imported, so the pipeline has no history of it",
}


@dataclass(frozen=True)
class Found:
    """A candidate and the detection that found it.

    Attributes:
        segment_id: The candidate.
        image_id: Its image.
        image_name: The image's name.
        sha256: Of the image's file.
        run_id: The run that found it.
        code_version: Version of ClearLines, and of its kernels, that the run was made by.
        parameters: Of the detection, as ``DetectionParameters.as_dict`` gives them.
        points: float32 little-endian ``(n, 2)`` as stored.
    """

    segment_id: int
    image_id: int
    image_name: str
    sha256: str
    run_id: int
    code_version: str
    parameters: dict[str, Any]
    points: bytes


@dataclass(frozen=True)
class Piece:
    """One of the arcs that a candidate was merged from; ends and chord in px."""

    start: Place
    end: Place
    length: float


@dataclass(frozen=True)
class Join:
    """A gap between two pieces that merging closed.

    Attributes:
        start: Where the gap begins, px.
        end: Where it ends, px.
        gap: Its length, px.
        cost: Its effective length, px: what it counted for, the evidence in the image considered.
        flipped: Whether the bright side changes there.
        round: In which round of merging it was closed.
    """

    start: Place
    end: Place
    gap: float
    cost: float
    flipped: bool
    round: Round


@dataclass(frozen=True)
class StageHistory:
    """How one candidate was found; see ``app.vision.history.SegmentHistory`` for the terms."""

    segment_id: int
    image_id: int
    run_id: int
    pieces: tuple[Piece, ...]
    joins: tuple[Join, ...]
    extended: tuple[float, float]
    trimmed: tuple[float, float]
    score: float
    score_parts: tuple[ScorePart, ...]
    intercept: float


def detection_behind(session: Session, segment_id: int) -> Found:
    """Return the detection that found a segment.

    Args:
        session: Any session.
        segment_id: A current segment, or one that a later run replaced.

    Raises:
        NotFound: When there is no such segment, or its image is deleted.
        NoHistory: When the pipeline didn't find it, or its run is gone.
    """
    segment = session.get(Segment, segment_id, options=[undefer(Segment.points)])
    if segment is None:
        raise NotFound(f"there is no segment {segment_id}")
    image = get_image(session, segment.image_id)
    if segment.origin != "pipeline":
        raise NoHistory(_ORIGINS[segment.origin], where=f"segment {segment_id}", expected="origin pipeline")
    run = session.scalar(
        select(Run).join(RunImage, RunImage.run_id == Run.id).where(RunImage.id == segment.run_image_id)
    )
    if run is None:
        raise NoHistory(
            "the run that found this candidate is deleted for good, and its parameters with it",
            where=f"segment {segment_id}",
            hint="pre-label the image again: the verdict goes over to the new candidate",
        )
    try:
        parameters = RunParameters.from_dict(run.parameters).detection
    except InvalidInput as error:  # a parameter that there was then
        raise _found_by_another_version(segment_id, run.id, run.code_version) from error
    return Found(
        segment_id=segment.id,
        image_id=image.id,
        image_name=image.name,
        sha256=image.sha256,
        run_id=run.id,
        code_version=run.code_version,
        parameters=parameters.as_dict(),
        points=segment.points,
    )


def tell(found: Found, history: SegmentHistory | None, typical: Mapping[str, float]) -> StageHistory:
    """Tell how a candidate was found.

    Args:
        found: The candidate.
        history: What doing its detection over gave; ``None`` if it didn't give a segment of the same points.
        typical: Mean of each feature over the image's candidates.

    Raises:
        NoHistory: Without a history.
    """
    if history is None:
        raise _found_by_another_version(found.segment_id, found.run_id, found.code_version)
    return StageHistory(
        segment_id=found.segment_id,
        image_id=found.image_id,
        run_id=found.run_id,
        pieces=tuple(Piece(*span) for span in _spans(history.pieces)),
        joins=tuple(
            Join(*span, cost, flipped, stage)
            for span, cost, flipped, stage in zip(
                _spans(history.gaps), history.costs.tolist(), history.flipped.tolist(), history.rounds, strict=True
            )
        ),
        extended=history.extended,
        trimmed=history.trimmed,
        score=history.score,
        score_parts=score_parts(history.features, typical),
        intercept=INTERCEPT,
    )


def _found_by_another_version(segment_id: int, run_id: int, code_version: str) -> NoHistory:
    return NoHistory(
        "the detector as it is now doesn't find this candidate: another version of it did",
        where=f"segment {segment_id}",
        expected=f"the version that run {run_id} was made by, {code_version}",
        hint="pre-label the image again: verdicts go over to the new candidates that match",
        details={"run_id": run_id, "code_version": code_version},
    )


def _spans(ends: NDArray[np.float64]) -> list[tuple[Place, Place, float]]:
    lengths = np.hypot(*(ends[:, 1] - ends[:, 0]).T).tolist()
    return [(tuple(start), tuple(end), length) for (start, end), length in zip(ends.tolist(), lengths, strict=True)]
