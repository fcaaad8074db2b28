"""Submissions as a viewer may see them: state, progress, and those numbers that the split's visibility allows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import ImageScore, Score, SplitVersion, Submission
from app.services.access import Viewer, can_maintain, can_see_details
from app.services.score_totals import merged_totals, shown_totals
from app.services.scoring_queue import IN_TURN, WAITING
from app.services.submission_access import is_mine, shown_person


@dataclass(frozen=True)
class SplitName:
    """Which split."""

    slug: str
    name: str
    visibility: str


@dataclass(frozen=True)
class MethodName:
    """Which method."""

    slug: str
    name: str
    kind: str


@dataclass(frozen=True)
class ScoreView:
    """The numbers of one score; ``totals`` has ``value``, ``low`` and ``high`` of each metric."""

    protocol: str
    protocol_version: str
    scorer_version: str
    split_version: int
    totals: dict[str, dict[str, float | None]]
    done_at: datetime | None


@dataclass(frozen=True)
class Abilities:
    """What the viewer can do with a submission."""

    withdraw: bool
    rescore: bool
    see_details: bool
    download: bool


@dataclass(frozen=True)
class SubmissionView:
    """A submission as a viewer may see it.

    Attributes:
        position: Its place among those that wait, from 1; ``None`` when it doesn't wait.
        progress: Share of its images that are scored.
        error: Why it is invalid or failed; for its author and maintainers, as is ``log``.
        images: Images that it has a file for.
        scores: The newest first.
        strata: Of the newest score; ``None`` where the viewer may not see them.
        error_types: Likewise.
    """

    id: int
    split: SplitName
    split_version: int
    method: MethodName
    label: str | None
    person: str | None
    mine: bool
    status: str
    position: int | None
    progress: float
    attempts: int
    error: dict[str, Any] | None
    log: list[dict[str, Any]]
    visibility: str
    images: int
    segments: int
    points: int
    has_scores: bool
    missing: list[str]
    created_at: datetime
    queued_at: datetime | None
    scored_at: datetime | None
    withdrawn_at: datetime | None
    truth_hash: str
    submission_hash: str | None
    scores: tuple[ScoreView, ...]
    strata: dict[str, Any] | None
    error_types: dict[str, int] | None
    cameras: list[dict[str, Any]] | None
    f1_grid: dict[str, Any] | None
    can: Abilities


def submission_view(session: Session, viewer: Viewer, submission: Submission) -> SubmissionView:
    """Return one submission as the viewer may see it."""
    return submission_views(session, viewer, [submission])[0]


def submission_views(session: Session, viewer: Viewer, submissions: Sequence[Submission]) -> list[SubmissionView]:
    """Return submissions as the viewer may see them, in their order.

    Args:
        session: Any session.
        viewer: Who asks; every submission must be one that they may see.
        submissions: With split version, split and method loaded.
    """
    ids = [submission.id for submission in submissions]
    scores: dict[int, list[tuple[Score, int]]] = {}
    rows = session.execute(
        select(Score, SplitVersion.number)
        .join(SplitVersion, SplitVersion.id == Score.split_version_id)
        .where(Score.submission_id.in_(ids))
        .order_by(Score.id.desc())
    )
    for score, number in rows:
        scores.setdefault(score.submission_id, []).append((score, number))
    return [_view(session, viewer, submission, scores.get(submission.id, [])) for submission in submissions]


def _view(
    session: Session, viewer: Viewer, submission: Submission, scores: Sequence[tuple[Score, int]]
) -> SubmissionView:
    version, method = submission.split_version, submission.method
    split = version.split
    mine, maintains = is_mine(viewer, submission.person), can_maintain(viewer)
    details = can_see_details(viewer, split.visibility)
    done = [(score, number) for score, number in scores if score.status == "done"]
    newest = (done[0][0].totals or {}) if done and details else {}
    inside = mine or maintains
    return SubmissionView(
        id=submission.id,
        split=SplitName(split.slug, split.name, split.visibility),
        split_version=version.number,
        method=MethodName(method.slug, method.name, method.kind),
        label=submission.label,
        person=shown_person(viewer, method, submission.person),
        mine=mine,
        status=submission.status,
        position=_position(session, submission),
        progress=_progress(session, submission, [score for score, _ in scores]),
        attempts=submission.attempts,
        error=submission.error if inside else None,
        log=list(submission.log or ()) if inside else [],
        visibility=submission.visibility,
        images=submission.n_images,
        segments=submission.n_segments,
        points=submission.n_points,
        has_scores=submission.has_scores,
        missing=list(submission.missing or ()),
        created_at=submission.created_at,
        queued_at=submission.queued_at,
        scored_at=submission.scored_at,
        withdrawn_at=submission.withdrawn_at,
        truth_hash=version.truth_hash,
        submission_hash=submission.submission_hash,
        scores=tuple(
            ScoreView(
                protocol=score.protocol,
                protocol_version=score.protocol_version,
                scorer_version=score.scorer_version,
                split_version=number,
                totals=shown_totals(merged_totals(score.totals), details=details),
                done_at=score.done_at,
            )
            for score, number in done
        ),
        strata=newest.get("strata"),
        error_types=newest.get("error_types"),
        cameras=newest.get("cameras"),
        f1_grid=newest.get("f1_grid"),
        can=Abilities(
            withdraw=inside and submission.status not in ("withdrawn", "invalid"),
            rescore=maintains and submission.status in ("scored", "failed"),
            see_details=details and bool(done),
            download=can_download(viewer, submission),
        ),
    )


def can_download(viewer: Viewer, submission: Submission) -> bool:
    """Whether the viewer may have the submission's segments."""
    inside = is_mine(viewer, submission.person) or can_maintain(viewer)
    is_open = submission.split_version.split.visibility == "open"
    return submission.segments_sha256 is not None and (inside or is_open)


def _position(session: Session, submission: Submission) -> int | None:
    """Return the place in the queue: one more than those that are asked for earlier and not done."""
    if submission.status not in ("received", "queued"):
        return None
    mine = submission.queued_at or submission.created_at
    first, _ = IN_TURN
    earlier = (first < mine) | ((first == mine) & (Submission.id < submission.id))
    query = select(func.count()).select_from(Submission).where(Submission.status.in_(WAITING), earlier)
    return (session.scalar(query) or 0) + 1


def _progress(session: Session, submission: Submission, scores: Sequence[Score]) -> float:
    if submission.status == "scored":
        return 1.0
    running = [score for score in scores if score.status == "running"]
    if submission.status != "scoring" or not running:
        return 0.0
    version = session.get_one(SplitVersion, running[-1].split_version_id)
    done = session.scalar(select(func.count()).where(ImageScore.score_id == running[-1].id)) or 0
    return done / max(version.n_images, 1)
