"""What waits, what is worked on and what failed lately, by kind of work: for whoever looks after the server.

Each number comes from an index and is counted no further than to a bound, so that asking costs the same in a large
database.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session

from app.db.models import Calibration, Camera, Dataset, Run, RunImage, Split, SplitVersion, Submission
from app.services.failures import Failure
from app.services.webhook_deliveries import deliveries_due

COUNTED = 1_000_000
"""Counts go no further."""
LATELY = timedelta(days=1)
UNFINISHED = ("queued", "running")


@dataclass(frozen=True)
class QueueStanding:
    """One kind of work.

    Attributes:
        kind: ``images`` of runs, ``submissions``, ``calibrations``, ``webhooks``.
        waiting: How many pieces wait for a worker.
        running: How many are worked on.
        failed: How many of the failures that were given are of the last day.
        oldest_wait: How long the oldest one has been waiting, in s; ``None`` where none is.
    """

    kind: str
    waiting: int
    running: int
    failed: int
    oldest_wait: float | None


def queue_standings(session: Session, failures: Sequence[Failure], now: datetime) -> list[QueueStanding]:
    """Return how each kind of work stands.

    Args:
        session: A reading session.
        failures: From `app.services.failures.latest_failures`.
        now: When.
    """
    failed = Counter(failure.kind for failure in failures if failure.at is not None and failure.at >= now - LATELY)
    standings = {
        "images": _images(session),
        "submissions": _submissions(session),
        "calibrations": _calibrations(session),
        "webhooks": (len(deliveries_due(session, since=now - LATELY)), 0, None),
    }
    return [
        QueueStanding(kind, waiting, running, failed[kind], _age(oldest, now))
        for kind, (waiting, running, oldest) in standings.items()
    ]


Numbers = tuple[int, int, datetime | None]
"""How many wait, how many are worked on, and since when the oldest waits."""


def _images(session: Session) -> Numbers:
    waits = select(RunImage.id).where(RunImage.status == "queued", RunImage.run_id == Run.id).exists()
    runs = session.execute(
        select(Run.id, Run.created_at, waits)
        .join(Dataset, Dataset.id == Run.dataset_id)
        .where(Run.status.in_(UNFINISHED), Run.deleted_at.is_(None), Dataset.deleted_at.is_(None))
    ).all()
    ids = [run_id for run_id, _, _ in runs]
    waiting, running = (
        session.scalar(
            select(func.count()).select_from(
                select(RunImage.id).where(RunImage.status == status, RunImage.run_id.in_(ids)).limit(COUNTED).subquery()
            )
        )
        or 0
        for status in UNFINISHED
    )
    return waiting, running, min((created_at for _, created_at, has_queued in runs if has_queued), default=None)


def _submissions(session: Session) -> Numbers:
    since = func.min(func.coalesce(Submission.queued_at, Submission.created_at))
    states = (
        select(Submission.status, func.count(), since)
        .join(SplitVersion, SplitVersion.id == Submission.split_version_id)
        .join(Split, Split.id == SplitVersion.split_id)
        .where(Split.deleted_at.is_(None), Submission.status.in_(("received", "queued", "validating", "scoring")))
        .group_by(Submission.status)
    )
    return _numbers(session, states, waiting=("received", "queued"))


def _calibrations(session: Session) -> Numbers:
    states = (
        select(Calibration.status, func.count(), func.min(Calibration.created_at))
        .join(Camera, Camera.id == Calibration.camera_id)
        .join(Dataset, Dataset.id == Camera.dataset_id)
        .where(Calibration.deleted_at.is_(None), Dataset.deleted_at.is_(None), Calibration.status.in_(UNFINISHED))
        .group_by(Calibration.status)
    )
    return _numbers(session, states, waiting=("queued",))


def _numbers(session: Session, states: Select[str, int, datetime], *, waiting: Sequence[str]) -> Numbers:
    found = session.execute(states).all()
    return (
        sum(number for status, number, _ in found if status in waiting),
        sum(number for status, number, _ in found if status not in waiting),
        min((since for status, _, since in found if status in waiting), default=None),
    )


def _age(time: datetime | None, now: datetime) -> float | None:
    return None if time is None else max(0.0, (now - time).total_seconds())
