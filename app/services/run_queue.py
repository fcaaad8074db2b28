"""The work of runs as rows: claimed, kept alive, put back, failed. The rows are the only truth about work.

A claim is a row's id with its number of attempts. A result is stored only while the row still runs at that attempt, so
a result that comes twice, or after the work was taken back or cancelled, changes nothing.

Locks are taken in this order everywhere: run, images, run_images.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Select, func, or_, select, update
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Run, RunImage
from app.errors import ClearLinesError

UNFINISHED = ("queued", "running")


@dataclass(frozen=True)
class Claim:
    """One image that a dispatcher works on.

    Attributes:
        run_image_id: The row.
        attempts: How often the work has been begun, this time included.
        image_id: The image.
        image_name: Its name, for messages.
        sha256: Its bytes in the blob store.
        parameters: The run's parameters.
    """

    run_image_id: int
    attempts: int
    image_id: int
    image_name: str
    sha256: str
    parameters: dict[str, Any]


def claim_images(session: Session, limit: int, now: datetime) -> list[Claim]:
    """Take up to ``limit`` queued images, oldest run first; they count as running from here on."""
    claims: list[Claim] = []
    queued = _workable(RunImage.status == "queued").with_only_columns(RunImage.run_id).distinct()
    for run_id in session.scalars(queued.order_by(RunImage.run_id).limit(limit)).all():
        run = session.get_one(Run, run_id, with_for_update=True, populate_existing=True)
        if run.status not in UNFINISHED or len(claims) == limit:
            continue
        rows = session.execute(
            select(RunImage, Image.name, Image.sha256)
            .join(Image, Image.id == RunImage.image_id)
            .where(RunImage.run_id == run_id, RunImage.status == "queued")
            .order_by(RunImage.id)
            .limit(limit - len(claims))
            .with_for_update(of=RunImage)
        ).all()
        run.status = "running"
        run.started_at = run.started_at or now
        for row, name, sha256 in rows:
            row.status = "running"
            row.attempts += 1
            row.heartbeat_at = now
            row.error = None
            claims.append(Claim(row.id, row.attempts, row.image_id, name, sha256, run.parameters))
    return claims


def has_queued_images(session: Session) -> bool:
    """Whether any image waits to be claimed, or is claimed by a dispatcher."""
    return session.scalar(_workable(RunImage.status.in_(UNFINISHED)).limit(1)) is not None


def claimed_row(session: Session, claim: Claim) -> RunImage | None:
    """Return the claim's row, locked, if the claim still holds; ``None`` if it was cancelled, purged or taken back."""
    row = session.get(RunImage, claim.run_image_id, with_for_update=True)
    if row is None or row.status != "running" or row.attempts != claim.attempts:
        return None
    return row


def beat(session: Session, run_image_ids: Collection[int], now: datetime) -> None:
    """Say that this work is alive."""
    session.execute(
        update(RunImage)
        .where(RunImage.id.in_(run_image_ids), RunImage.status == "running")
        .values(heartbeat_at=now)
        .execution_options(synchronize_session=False)
    )


def charge_attempt(session: Session, claim: Claim, now: datetime) -> Claim | None:
    """Count a new attempt of work that killed its worker; ``None`` when the claim doesn't hold any more."""
    row = claimed_row(session, claim)
    if row is None:
        return None
    row.attempts += 1
    row.heartbeat_at = now
    return Claim(row.id, row.attempts, claim.image_id, claim.image_name, claim.sha256, claim.parameters)


def put_back(session: Session, claims: Sequence[Claim]) -> None:
    """Queue work again that was stopped on purpose; the attempt isn't counted."""
    for claim in claims:
        row = claimed_row(session, claim)
        if row is not None:
            row.status = "queued"
            row.attempts -= 1
            row.heartbeat_at = None


def release_lost(session: Session, max_attempts: int, *, silent_since: datetime | None = None) -> int:
    """Queue the work again that a dispatcher left behind when it died.

    Args:
        session: A writing session.
        max_attempts: Work that was lost so often fails instead: it may be what kills the server.
        silent_since: Only work without a heartbeat since then; all running work when left out, which is right for a
            dispatcher that just became the only one.

    Returns:
        How many images were taken back.
    """
    query = select(RunImage).where(RunImage.status == "running")
    if silent_since is not None:
        query = query.where(or_(RunImage.heartbeat_at.is_(None), RunImage.heartbeat_at < silent_since))
    rows = session.scalars(query.with_for_update(skip_locked=True)).all()
    for row in rows:
        row.heartbeat_at = None
        if row.attempts < max_attempts:
            row.status = "queued"
        else:
            row.status = "failed"
            row.error = killed_worker_error(row.attempts)
    return len(rows)


def fail_image(session: Session, claim: Claim, error: dict[str, Any], now: datetime) -> bool:
    """Let one image fail alone, with its reason; False when the claim doesn't hold any more."""
    row = claimed_row(session, claim)
    if row is None:
        return False
    row.status = "failed"
    row.error = error
    row.heartbeat_at = now
    return True


def killed_worker_error(attempts: int) -> dict[str, Any]:
    """Return the reason of an image whose work ended with the process that did it."""
    return ClearLinesError(
        f"the process that worked on it died, {attempts} {'time' if attempts == 1 else 'times'}",
        hint="the image may need more memory than there is; retry with fewer workers, or leave it out",
    ).as_dict() | {"code": "worker-died"}


def unsettled_runs(session: Session, limit: int = 20) -> Sequence[Run]:
    """Return runs whose images are all finished, but which aren't finished themselves, oldest first."""
    unfinished = select(RunImage.id).where(RunImage.run_id == Run.id, RunImage.status.in_(UNFINISHED)).exists()
    return session.scalars(
        select(Run)
        .join(Dataset, Dataset.id == Run.dataset_id)
        .where(Run.status.in_(UNFINISHED), Run.deleted_at.is_(None), Dataset.deleted_at.is_(None), ~unfinished)
        .order_by(Run.id)
        .limit(limit)
    ).all()


def count_states(session: Session, run_ids: Collection[int]) -> dict[int, dict[str, int]]:
    """Count the images of runs by state."""
    rows = session.execute(
        select(RunImage.run_id, RunImage.status, func.count())
        .where(RunImage.run_id.in_(run_ids))
        .group_by(RunImage.run_id, RunImage.status)
    )
    counts: dict[int, dict[str, int]] = {run_id: {} for run_id in run_ids}
    for run_id, status, number in rows:
        counts[run_id][status] = number
    return counts


def _workable(*conditions: ColumnElement[bool]) -> Select[int, int]:
    """Select id and run of work of runs that are neither deleted nor over."""
    return (
        select(RunImage.id, RunImage.run_id)
        .join(Run, Run.id == RunImage.run_id)
        .join(Dataset, Dataset.id == Run.dataset_id)
        .where(Run.status.in_(UNFINISHED), Run.deleted_at.is_(None), Dataset.deleted_at.is_(None), *conditions)
    )
