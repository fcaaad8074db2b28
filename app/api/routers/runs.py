"""Pre-labelling runs: start, watch, retry, cancel, delete and restore."""

from __future__ import annotations

from fastapi import APIRouter, status
from sqlalchemy.orm import Session

from app.api.deps import Cursor, Limit, Now, Reader, Server, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId, WorkState
from app.api.schemas.datasets import Deleted
from app.api.schemas.runs import Retried, RunAnswer, RunGiven, RunImagePage
from app.services import run_progress, runs
from app.services.datasets import get_dataset

router = APIRouter(tags=["runs"], responses=answers(404))


@router.post("/datasets/{slug}/runs", status_code=status.HTTP_202_ACCEPTED, responses=answers(409))
def start_run(server: ServerDep, viewer: ViewerDep, now: Now, slug: str, given: RunGiven) -> RunAnswer:
    """Queue the pipeline for all images of a dataset, or for some; it begins at once."""
    parameters = given.model_dump(exclude={"image_ids"}, exclude_none=True)
    with server.database.write() as session:
        dataset = get_dataset(session, slug)
        run = runs.start_run(session, dataset, parameters, given.image_ids, now, person=viewer.name)
        answer = _answer(server, session, run.id, now)
    server.dispatcher.wake()
    return answer


@router.get("/datasets/{slug}/runs")
def list_runs(server: ServerDep, session: Reader, now: Now, slug: str, deleted: bool = False) -> list[RunAnswer]:
    """List the runs of a dataset, newest first; with ``deleted`` those that can still be restored."""
    dataset = get_dataset(session, slug)
    found = run_progress.list_runs(session, dataset, now, grace=server.settings.grace, deleted=deleted)
    return [RunAnswer.model_validate(run) for run in found]


@router.get("/runs/{run_id}")
def read_run(server: ServerDep, session: Reader, now: Now, run_id: RowId) -> RunAnswer:
    """Return a run and how far it is."""
    return _answer(server, session, run_id, now)


@router.get("/runs/{run_id}/images")
def list_run_images(
    session: Reader, run_id: RowId, status: WorkState | None = None, limit: Limit = 100, cursor: Cursor = None
) -> RunImagePage:
    """List the work of a run image by image, with what failed and why."""
    page = run_progress.run_images(session, run_id, status=status, limit=limit, cursor=cursor)
    return RunImagePage.model_validate(page)


@router.post("/runs/{run_id}/retry", responses=answers(409))
def retry_run(server: ServerDep, viewer: ViewerDep, now: Now, run_id: RowId) -> Retried:
    """Queue the images that failed once more."""
    with server.database.write() as session:
        queued = runs.retry_run(session, run_id, now, person=viewer.name)
    server.dispatcher.wake()
    return Retried(queued=queued)


@router.post("/runs/{run_id}/cancel", responses=answers(409))
def cancel_run(server: ServerDep, viewer: ViewerDep, now: Now, run_id: RowId) -> RunAnswer:
    """Stop a run; what it has finished stays."""
    with server.database.write() as session:
        runs.cancel_run(session, run_id, now, person=viewer.name)
        return _answer(server, session, run_id, now)


@router.delete("/runs/{run_id}")
def delete_run(server: ServerDep, viewer: ViewerDep, now: Now, run_id: RowId) -> Deleted:
    """Delete a run with its undecided candidates; what a person decided stays. It can be restored for a while."""
    settings = server.settings
    with server.database.write() as session:
        deleted = runs.delete_run(session, run_id, now, grace=settings.grace, person=viewer.name)
        return Deleted.model_validate(deleted)


@router.post("/runs/{run_id}/restore", responses=answers(409))
def restore_run(server: ServerDep, viewer: ViewerDep, now: Now, run_id: RowId) -> RunAnswer:
    """Bring a deleted run back."""
    with server.database.write() as session:
        runs.restore_run(session, run_id, now, person=viewer.name)
        return _answer(server, session, run_id, now)


def _answer(server: Server, session: Session, run_id: int, now: Now) -> RunAnswer:
    return RunAnswer.model_validate(run_progress.run_summary(session, run_id, now, grace=server.settings.grace))
