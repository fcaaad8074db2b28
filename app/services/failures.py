"""The work that failed last and that nobody has done again since: for whoever looks after the server."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from app.db.models import (
    Calibration,
    Camera,
    Dataset,
    Image,
    Method,
    Run,
    RunImage,
    Score,
    Split,
    SplitVersion,
    Submission,
)
from app.services.webhook_deliveries import FAILED

LOOKED_AT = 500
"""Of each kind so many are looked at, the newest."""
UNTOLD = {"code": "error", "message": "it failed, and nobody noted why"}
ATTEMPT = "attempt "
"""How the line of a submission's log begins that says why an attempt failed."""


@dataclass(frozen=True)
class Failure:
    """A piece of work that failed.

    Attributes:
        kind: ``images``, ``submissions``, ``calibrations`` or ``webhooks``.
        id: Of its row.
        what: An image's, method's or camera's name.
        page: The page that shows it.
        at: When it failed; ``None`` where nobody noted it, as the process had died.
        error: Why: code, message, where, expected, hint.
    """

    kind: str
    id: int
    what: str
    page: str
    at: datetime | None
    error: dict[str, Any]


def latest_failures(session: Session) -> list[Failure]:
    """Return the latest failures of each kind, newest first."""
    found = [failure for of_kind in KINDS for failure in of_kind(session)]
    # those without a time are as old as anything may be
    return sorted(found, key=lambda failure: failure.at.timestamp() if failure.at else 0.0, reverse=True)


def _images(session: Session) -> list[Failure]:
    rows = session.execute(
        select(RunImage.id, RunImage.heartbeat_at, RunImage.error, Image.name, Run.id, Run.finished_at, Run.started_at)
        .join(Run, Run.id == RunImage.run_id)
        .join(Dataset, Dataset.id == Run.dataset_id)
        .join(Image, Image.id == RunImage.image_id)
        .where(RunImage.status == "failed", Run.deleted_at.is_(None), Dataset.deleted_at.is_(None))
        .order_by(RunImage.run_id.desc(), RunImage.id.desc())
        .limit(LOOKED_AT)
    ).all()
    return [
        Failure("images", row_id, name, f"/runs/{run_id}", beat or finished_at or started_at, error or UNTOLD)
        for row_id, beat, error, name, run_id, finished_at, started_at in rows
    ]


def _submissions(session: Session) -> list[Failure]:
    newest = select(Score.submission_id).where(Score.status == "failed").order_by(Score.id.desc()).limit(LOOKED_AT)
    rows = _of_living_splits(session, Submission.id.in_(newest.scalar_subquery()), Submission.error.is_not(None))
    return [
        Failure("submissions", row.id, what, f"/submissions/{row.id}", _time_of(row.log, ATTEMPT), row.error or UNTOLD)
        for row, what in rows
    ]


def _calibrations(session: Session) -> list[Failure]:
    rows = session.execute(
        select(Calibration.id, Calibration.finished_at, Calibration.error, Camera.id, Camera.name)
        .join(Camera, Camera.id == Calibration.camera_id)
        .join(Dataset, Dataset.id == Camera.dataset_id)
        .where(Calibration.status == "failed", Calibration.deleted_at.is_(None), Dataset.deleted_at.is_(None))
        .order_by(Calibration.id.desc())
        .limit(LOOKED_AT)
    ).all()
    return [
        Failure("calibrations", row_id, camera, f"/cameras/{camera_id}", finished_at, error or UNTOLD)
        for row_id, finished_at, error, camera_id, camera in rows
    ]


def _webhooks(session: Session) -> list[Failure]:
    newest = select(Submission.id).order_by(Submission.id.desc()).limit(LOOKED_AT)
    rows = _of_living_splits(session, Submission.id.in_(newest.scalar_subquery()), Submission.webhook_url.is_not(None))
    return [
        Failure(
            "webhooks",
            row.id,
            what,
            f"/submissions/{row.id}",
            at,
            {"code": "webhook-failed", "message": _text_of(row.log, FAILED)},
        )
        for row, what in rows
        if (at := _time_of(row.log, FAILED)) is not None
    ]


def _of_living_splits(session: Session, *conditions: ColumnElement[bool]) -> list[tuple[Submission, str]]:
    """Return submissions, each with what it is called."""
    rows = session.execute(
        select(Submission, Method.name, Split.slug)
        .join(Method, Method.id == Submission.method_id)
        .join(SplitVersion, SplitVersion.id == Submission.split_version_id)
        .join(Split, Split.id == SplitVersion.split_id)
        .where(Split.deleted_at.is_(None), *conditions)
    ).all()
    return [(row, f"{method} on {split}") for row, method, split in rows]


def _line(log: Sequence[dict[str, Any]] | None, beginning: str) -> dict[str, Any]:
    """Return the last line of a submission's log that begins so; empty when none does."""
    return next((line for line in reversed(log or ()) if str(line.get("text", "")).startswith(beginning)), {})


def _time_of(log: Sequence[dict[str, Any]] | None, beginning: str) -> datetime | None:
    line = _line(log, beginning)
    return datetime.fromisoformat(line["at"]) if line else None


def _text_of(log: Sequence[dict[str, Any]] | None, beginning: str) -> str:
    return str(_line(log, beginning).get("text", ""))


KINDS: tuple[Callable[[Session], list[Failure]], ...] = (_images, _submissions, _calibrations, _webhooks)
