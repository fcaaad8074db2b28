"""Submissions: hand in, check, watch, withdraw, score anew."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated, Any

from fastapi import APIRouter, Body, Depends, File, Form, Query, Response, UploadFile, status
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.concurrency import run_in_threadpool

from app.api.deps import Cursor, Limit, Now, Reader, Server, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.routers import submission_images
from app.api.schemas.base import RowId
from app.api.schemas.submissions import (
    Rescore,
    Rescored,
    SubmissionAnswer,
    SubmissionChange,
    SubmissionPage,
    SubmissionState,
    SubmissionVisibility,
    Validation,
)
from app.api.waiting import wait_for_validation
from app.db.models import FINAL_STATES
from app.errors import NotFound
from app.services import submission_lists, submission_receiving, submissions
from app.services.access import Viewer
from app.services.methods import MethodGiven
from app.services.split_images import expected_images
from app.services.splits import current_version, get_split
from app.services.submission_access import get_submission
from app.services.submission_files import SubmissionFile, submission_file
from app.services.submission_intake import one_upload
from app.services.submission_limits import submission_limits
from app.services.submission_views import submission_view
from app.services.uploads import UploadedFile

router = APIRouter(tags=["submissions"], responses=answers(404))
EVENTS_PAUSE = 0.25  # s
Files = Annotated[
    list[UploadFile],
    File(description="One .zip or .tar.gz of a file per image, one .npz or .json for all, or a file per image."),
]
Words = Annotated[str | None, Form(max_length=20_000)]
Address = Annotated[str | None, Form(max_length=2_000)]


@router.post("/splits/{split}/submissions/validate", responses=answers(413, 503))
def validate_submission(server: ServerDep, split: str, files: Files) -> Validation:
    """Check files without handing them in; nothing is stored, and it counts for no limit.

    422 with everything that is wrong: `details.errors` has `file`, `segment`, `point`, `message`, `expected`, `hint`.
    """
    with server.database.read() as session:
        images = expected_images(session, current_version(session, get_split(session, split)).id)
    with one_upload(_given(files), submission_limits(server.settings)) as upload:
        found = server.desk.validations.validate(upload.stream.read(), upload.name, images)
    return Validation.model_validate(
        {
            "images": found.images,
            "segments": found.segments,
            "points": found.points,
            "has_scores": found.has_scores,
            "missing": list(found.missing),
            "left_out": [{"file": file, "reason": reason} for file, reason in found.left_out],
            "warnings": list(found.warnings),
        }
    )


@router.post("/splits/{split}/submissions", status_code=status.HTTP_202_ACCEPTED, responses=answers(409, 413, 429))
async def hand_in(
    server: ServerDep,
    viewer: ViewerDep,
    now: Now,
    split: str,
    files: Files,
    method: Annotated[str, Form(min_length=1, max_length=200, description="Name of the method; made if new.")],
    label: Annotated[str | None, Form(max_length=200, description="Your word for this version of it.")] = None,
    description: Words = None,
    code_url: Address = None,
    paper_url: Address = None,
    visibility: Annotated[SubmissionVisibility, Form()] = "public",
    anonymous: Annotated[bool, Form(description="Don't show whose a new method is until it is revealed.")] = False,
    webhook_url: Address = None,
) -> SubmissionAnswer:
    """Hand in results. The answer comes when they are validated; scoring goes on behind it.

    422 with everything that is wrong, as `validate` says it, and nothing is left behind.
    """
    given = submission_receiving.SubmissionGiven(
        MethodGiven(method, description, code_url, paper_url, anonymous), label, visibility, webhook_url
    )
    limits = submission_limits(server.settings)
    submission_id = await run_in_threadpool(
        submission_receiving.receive, server.database, server.blobs, viewer, split, _given(files), given, now, limits
    )
    server.dispatcher.wake()
    await wait_for_validation(server, submission_id)
    refused = await run_in_threadpool(submission_receiving.take_refused, server.database, server.blobs, submission_id)
    if refused is not None:
        raise refused
    return await run_in_threadpool(_read, server, viewer, submission_id)


@router.get("/splits/{split}/submissions")
def list_submissions(
    session: Reader,
    viewer: ViewerDep,
    split: str,
    mine: bool = False,
    status: SubmissionState | None = None,
    limit: Limit = 100,
    cursor: Cursor = None,
) -> SubmissionPage:
    """List a split's submissions, newest first: public ones that are scored, and all of one's own."""
    found = get_split(session, split)
    page = submission_lists.list_submissions(
        session, viewer, found, mine=mine, status=status, limit=limit, cursor=cursor
    )
    return SubmissionPage.model_validate(page)


@router.get("/submissions/{submission_id}")
def read_submission(server: ServerDep, viewer: ViewerDep, submission_id: RowId) -> SubmissionAnswer:
    """Return a submission: its state, its place in the queue or its progress, its numbers."""
    return _read(server, viewer, submission_id)


def _shown(server: ServerDep, viewer: ViewerDep, submission_id: RowId) -> int:
    # before the stream begins: afterwards there is no answering 404
    _read(server, viewer, submission_id)
    return submission_id


@router.get("/submissions/{submission_id}/events", response_class=EventSourceResponse)
async def watch_submission(
    server: ServerDep, viewer: ViewerDep, submission: Annotated[int, Depends(_shown)]
) -> AsyncIterator[ServerSentEvent]:
    """Send the submission as an event of the kind `submission` whenever it changes, until it is in a final state.

    A server that is to end ends the stream too; browsers ask again by themselves.
    """
    last = ""
    while not server.stopping.is_set():
        try:
            answer = await run_in_threadpool(_read, server, viewer, submission)
        except NotFound:
            return
        content = answer.model_dump_json()
        if content != last:
            last = content
            yield ServerSentEvent(event="submission", raw_data=content)
        if answer.status in FINAL_STATES:
            return
        await asyncio.sleep(EVENTS_PAUSE)


@router.patch("/submissions/{submission_id}")
def change_submission(
    server: ServerDep, viewer: ViewerDep, now: Now, submission_id: RowId, given: SubmissionChange
) -> SubmissionAnswer:
    """Change who sees a submission, or its label."""
    named = {name: getattr(given, name) for name in given.model_fields_set}
    changes: dict[str, Any] = {name: value for name, value in named.items() if value is not None or name == "label"}
    with server.database.write() as session:
        submissions.change_submission(session, viewer, submission_id, now, **changes)
    return _read(server, viewer, submission_id)


@router.post("/submissions/{submission_id}/withdraw", responses=answers(409))
def withdraw(server: ServerDep, viewer: ViewerDep, now: Now, submission_id: RowId) -> SubmissionAnswer:
    """Take a submission off the board; `restore` brings it back."""
    with server.database.write() as session:
        submissions.withdraw(session, viewer, submission_id, now)
    return _read(server, viewer, submission_id)


@router.post("/submissions/{submission_id}/restore", responses=answers(409))
def restore(server: ServerDep, viewer: ViewerDep, now: Now, submission_id: RowId) -> SubmissionAnswer:
    """Bring a withdrawn submission back."""
    with server.database.write() as session:
        submissions.restore(session, viewer, submission_id, now)
    server.dispatcher.wake()
    return _read(server, viewer, submission_id)


@router.post("/submissions/{submission_id}/rescore", status_code=status.HTTP_202_ACCEPTED, responses=answers(409))
def rescore(
    server: ServerDep,
    viewer: ViewerDep,
    now: Now,
    submission_id: RowId,
    given: Annotated[Rescore, Body(default_factory=Rescore)],
) -> SubmissionAnswer:
    """Score a submission anew, under the current version of the protocol or another version of the split.

    Old numbers stay. A failed one is tried again.
    """
    with server.database.write() as session:
        submissions.rescore(session, viewer, submission_id, given.split_version, now)
    server.dispatcher.wake()
    return _read(server, viewer, submission_id)


@router.post("/splits/{split}/rescore", status_code=status.HTTP_202_ACCEPTED)
def rescore_all(
    server: ServerDep, viewer: ViewerDep, now: Now, split: str, given: Annotated[Rescore, Body(default_factory=Rescore)]
) -> Rescored:
    """Score all scored submissions of a split anew, but for those that have the very score already."""
    with server.database.write() as session:
        queued = submissions.rescore_all(session, viewer, split, given.split_version, now)
    server.dispatcher.wake()
    return Rescored(queued=queued)


@router.get("/submissions/{submission_id}/file", response_class=Response, responses={**submission_images.BINARY})
def read_file(
    server: ServerDep,
    session: Reader,
    viewer: ViewerDep,
    submission_id: RowId,
    form: Annotated[SubmissionFile, Query(description="npz: as it is scored; upload: as it came.")] = "npz",
) -> Response:
    """Return the segments of a submission in one file for all images, or the upload itself to its author."""
    found = submission_file(get_submission(session, viewer, submission_id), viewer, form)
    headers = {"Content-Disposition": f'attachment; filename="{found.name}"'}
    return Response(server.blobs.read(found.sha256), media_type="application/octet-stream", headers=headers)


router.include_router(submission_images.router)


def _given(files: list[UploadFile]) -> list[UploadedFile]:
    return [UploadedFile(file.filename or "", file.file) for file in files]


def _read(server: Server, viewer: Viewer, submission_id: int) -> SubmissionAnswer:
    with server.database.read() as session:
        submission = get_submission(session, viewer, submission_id)
        return SubmissionAnswer.model_validate(submission_view(session, viewer, submission))
