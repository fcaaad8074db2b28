"""Pre-labelling runs: start, retry, cancel, delete and restore them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, Select, delete, exists, insert, literal, select, update
from sqlalchemy.orm import Session, aliased

from app.db.models import CameraEstimate, Dataset, Image, Run, RunImage
from app.errors import Conflict, NotFound
from app.services.batches import in_batches
from app.services.candidates import refresh_counts
from app.services.datasets import Deleted
from app.services.events import record_event
from app.services.run_parameters import RunParameters
from app.services.run_queue import UNFINISHED, hold_images
from app.services.run_scope import refuse_busy_images, wanted_images
from app.vision.code_version import code_version


def start_run(
    session: Session,
    dataset: Dataset,
    parameters: Mapping[str, Any],
    image_ids: Sequence[int] | None,
    now: datetime,
    *,
    person: str | None = None,
) -> Run:
    """Queue a run over a dataset's images; a dispatcher works it off.

    Args:
        session: A writing session.
        dataset: The dataset.
        parameters: Fields of ``RunParameters``; those left out, or ``None``, keep their default.
        image_ids: Only these images; all of them when left out.
        now: Time of the start.
        person: Who starts it.

    Raises:
        InvalidInput: On parameters that can't be, or ids that are no images of the dataset.
        Conflict: When there are no images, or another run is at work on some of them.
        BrokenInstallation: When the detector isn't there.
    """
    chosen = RunParameters.from_dict(parameters)
    session.refresh(
        dataset, with_for_update={"key_share": True}
    )  # of two that start at once, the second sees the first one's run
    wanted = wanted_images(session, dataset, image_ids)
    refuse_busy_images(session, dataset, set(wanted))
    run = Run(
        dataset_id=dataset.id, parameters=chosen.as_dict(), code_version=code_version(), status="queued", created_at=now
    )
    session.add(run)
    session.flush()
    rows = [{"run_id": run.id, "image_id": image_id, "status": "queued", "attempts": 0} for image_id in wanted]
    hold_images(session, wanted)
    for batch in in_batches(rows):
        session.execute(insert(RunImage), list(batch))
    _record(session, "run.started", run, now, person, images=len(wanted), parameters=run.parameters)
    return run


def get_run(session: Session, run_id: int, *, deleted: bool = False, lock: bool = False) -> Run:
    """Return a run of a dataset that isn't deleted.

    Args:
        session: Any session.
        run_id: Its id.
        deleted: Whether to take a deleted one too.
        lock: Whether to hold its row; needs a writing session.

    Raises:
        NotFound: When there is none.
    """
    run = session.get(Run, run_id, with_for_update=lock or None)
    dataset = None if run is None else session.get(Dataset, run.dataset_id)
    if run is None or dataset is None or dataset.deleted_at is not None:
        raise NotFound(f"there is no run {run_id}")
    if run.deleted_at is not None and not deleted:
        raise NotFound(f"run {run_id} is deleted", hint="restore it first", details={"run": run_id})
    return run


def retry_run(session: Session, run_id: int, now: datetime, *, person: str | None = None) -> int:
    """Queue a run's failed and cancelled images again; return how many.

    Images that a later run has taken over are left alone. The lenses that the images take part in are estimated anew.

    Raises:
        NotFound: When there is no such run.
        Conflict: When there is nothing to do again.
    """
    run = get_run(session, run_id, lock=True)
    later, later_run = aliased(RunImage), aliased(Run)
    taken_over = exists().where(
        later.image_id == RunImage.image_id,
        later.run_id == later_run.id,
        later_run.id > run.id,
        later_run.deleted_at.is_(None),
        later.status.in_([*UNFINISHED, "done"]),
    )
    rows = session.execute(
        select(RunImage.id, RunImage.image_id, Image.camera_id)
        .join(Image, Image.id == RunImage.image_id)
        .where(
            RunImage.run_id == run.id,
            RunImage.status.in_(["failed", "cancelled"]),
            Image.deleted_at.is_(None),
            ~taken_over,
        )
    ).all()
    if not rows:
        raise Conflict(
            "nothing of this run can be done again",
            hint="no image failed or was cancelled, or a later run has done them; start a new run instead",
        )
    hold_images(session, {row.image_id for row in rows})
    for batch in in_batches([row.id for row in rows]):
        session.execute(
            update(RunImage)
            .where(RunImage.id.in_(batch))
            .values(status="queued", attempts=0, error=None, heartbeat_at=None)
            .execution_options(synchronize_session=False)
        )
    cameras = {row.camera_id for row in rows}
    session.execute(
        delete(CameraEstimate).where(CameraEstimate.run_id == run.id, CameraEstimate.camera_id.in_(cameras))
    )
    run.status = "queued" if run.started_at is None else "running"
    run.finished_at = None
    run.error = None
    _record(session, "run.retried", run, now, person, images=len(rows))
    return len(rows)


def cancel_run(session: Session, run_id: int, now: datetime, *, person: str | None = None) -> Run:
    """Stop a run; what it has finished stays.

    Raises:
        NotFound: When there is no such run.
        Conflict: When it is over already.
    """
    run = get_run(session, run_id, lock=True)
    if run.status not in UNFINISHED:
        raise Conflict(f"the run is over already: {run.status}")
    _cancel(session, run, now)
    _record(session, "run.cancelled", run, now, person)
    return run


def delete_run(session: Session, run_id: int, now: datetime, *, grace: timedelta, person: str | None = None) -> Deleted:
    """Hide a run with its undecided candidates; what was decided on stays. One at work is cancelled first."""
    run = get_run(session, run_id, lock=True)
    _images_where(session, _is_of(run))  # all of them, in their order, before some
    touched = _images_where(session, Image.current_run_image_id.in_(_work_of(run)))
    _set_current(session, touched, None)
    if run.status in UNFINISHED:
        _cancel(session, run, now)
    run.deleted_at = now
    _refresh(session, touched)
    _record(session, "run.deleted", run, now, person)
    return Deleted(1, now, now + grace)


def restore_run(session: Session, run_id: int, now: datetime, *, person: str | None = None) -> Run:
    """Bring a deleted run back, with those of its candidates that no later run replaced.

    Raises:
        NotFound: When there is no such run any more.
        Conflict: When it isn't deleted.
    """
    run = get_run(session, run_id, deleted=True, lock=True)
    if run.deleted_at is None:
        raise Conflict(f"run {run_id} isn't deleted")
    _images_where(session, _is_of(run))
    run.deleted_at = None
    later, later_run = aliased(RunImage), aliased(Run)
    replaced = exists().where(
        later.image_id == Image.id,
        later.run_id == later_run.id,
        later_run.id > run.id,
        later.status == "done",
    )
    done = select(RunImage.image_id).where(RunImage.run_id == run.id, RunImage.status == "done")
    touched = _images_where(session, Image.id.in_(done), Image.current_run_image_id.is_(None), ~replaced)
    _set_current(session, touched, run)
    _refresh(session, touched)
    _record(session, "run.restored", run, now, person)
    return run


def _cancel(session: Session, run: Run, now: datetime) -> None:
    _images_where(session, _is_of(run, RunImage.status.in_(UNFINISHED)))
    session.execute(
        update(RunImage)
        .where(RunImage.run_id == run.id, RunImage.status.in_(UNFINISHED))
        .values(status="cancelled", heartbeat_at=now)
    )
    run.status = "cancelled"
    run.finished_at = now


def _work_of(run: Run) -> Select[int]:
    return select(RunImage.id).where(RunImage.run_id == run.id)


def _is_of(run: Run, *conditions: ColumnElement[bool]) -> ColumnElement[bool]:
    """Return the condition on ``Image`` that the run has work on it that is so."""
    return Image.id.in_(select(RunImage.image_id).where(RunImage.run_id == run.id, *conditions))


def _images_where(session: Session, *conditions: ColumnElement[bool]) -> Sequence[int]:
    return session.scalars(select(Image.id).where(*conditions).order_by(Image.id).with_for_update()).all()


def _set_current(session: Session, image_ids: Sequence[int], run: Run | None) -> None:
    work = (
        literal(None)
        if run is None
        else select(RunImage.id).where(RunImage.run_id == run.id, RunImage.image_id == Image.id).scalar_subquery()
    )
    for batch in in_batches(image_ids):
        session.execute(
            update(Image)
            .where(Image.id.in_(batch))
            .values(current_run_image_id=work, revision=Image.revision + 1)
            .execution_options(synchronize_session=False)
        )
    session.flush()
    session.expire_all()


def _refresh(session: Session, image_ids: Sequence[int]) -> None:
    for batch in in_batches(image_ids):
        refresh_counts(session, batch)


def _record(session: Session, kind: str, run: Run, now: datetime, person: str | None, **details: Any) -> None:
    record_event(session, kind, now, dataset_id=run.dataset_id, person=person, details={"run": run.id, **details})
