"""The work of runs as rows: claimed, kept alive, put back, failed. The rows are the only truth about work.

A claim is a row's id with its number of attempts. A result is stored only while the row still runs at that attempt, so
a result that comes twice, or after the work was taken back or cancelled, changes nothing.

Locks are taken in this order everywhere: run, images (by id), run_images. Triggers write the state of an image's newest
work into the image's row, so whoever changes states holds the images first.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Select, exists, or_, select, update
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Run, RunImage
from app.errors import ClearLinesError
from app.services.batches import in_batches

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
    waiting = exists().where(RunImage.run_id == Run.id, RunImage.status == "queued").correlate(Run)
    queued = _workable_runs().where(waiting).order_by(Run.id)
    for run_id in session.scalars(queued.limit(limit)).all():
        run = session.get_one(Run, run_id, with_for_update=True, populate_existing=True)
        if run.status not in UNFINISHED or len(claims) == limit:
            continue
        waiting_here = (RunImage.run_id == run_id, RunImage.status == "queued")
        next_ones = select(RunImage.id, RunImage.image_id).where(*waiting_here).order_by(RunImage.id)
        found = session.execute(next_ones.limit(limit - len(claims))).all()
        hold_images(session, [image_id for _, image_id in found])
        rows = session.execute(
            select(RunImage, Image.name, Image.sha256)
            .join(Image, Image.id == RunImage.image_id)
            .where(RunImage.id.in_([row_id for row_id, _ in found]), *waiting_here)
            .order_by(RunImage.id)
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
    left = exists().where(RunImage.run_id == Run.id, RunImage.status.in_(UNFINISHED)).correlate(Run)
    return session.scalar(_workable_runs().where(left).limit(1)) is not None


def hold_images(session: Session, image_ids: Collection[int]) -> None:
    """Hold images before the state of work on them changes; see the order of locks above."""
    for batch in in_batches(sorted(image_ids)):
        session.execute(select(Image.id).where(Image.id.in_(batch)).order_by(Image.id).with_for_update(key_share=True))


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
    hold_images(session, {claim.image_id for claim in claims})
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
    lost = [RunImage.status == "running"]
    if silent_since is not None:
        lost.append(or_(RunImage.heartbeat_at.is_(None), RunImage.heartbeat_at < silent_since))
    hold_images(session, set(session.scalars(select(RunImage.image_id).where(*lost))))
    rows = session.scalars(select(RunImage).where(*lost).with_for_update(skip_locked=True)).all()
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
    hold_images(session, [claim.image_id])
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


def _workable_runs() -> Select[int]:
    """Select the runs that are neither deleted nor over; there are few of them, whatever they have to do."""
    return (
        select(Run.id)
        .join(Dataset, Dataset.id == Run.dataset_id)
        .where(Run.status.in_(UNFINISHED), Run.deleted_at.is_(None), Dataset.deleted_at.is_(None))
    )
