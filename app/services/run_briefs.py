"""Runs at a glance, for lists of datasets and images: any number of them in two queries."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Run
from app.services.tallies import states_of_runs


@dataclass(frozen=True)
class WorkCounts:
    """Images of a run by state."""

    queued: int = 0
    running: int = 0
    done: int = 0
    failed: int = 0
    cancelled: int = 0


@dataclass(frozen=True)
class RunBrief:
    """A run at a glance."""

    id: int
    status: str
    counts: WorkCounts
    total: int
    created_at: datetime
    finished_at: datetime | None


def run_briefs(session: Session, run_ids: Collection[int]) -> dict[int, RunBrief]:
    """Return the runs that exist, by id."""
    if not run_ids:
        return {}
    counts = states_of_runs(session, run_ids)
    runs = select(Run.id, Run.status, Run.created_at, Run.finished_at).where(Run.id.in_(run_ids))
    return {
        run_id: RunBrief(
            id=run_id,
            status=status,
            counts=WorkCounts(**counts.get(run_id, {})),
            total=sum(counts.get(run_id, {}).values()),
            created_at=created_at,
            finished_at=finished_at,
        )
        for run_id, status, created_at, finished_at in session.execute(runs)
    }
