"""Wait for what a worker does, without holding a thread, nor asking the database all the time."""

from __future__ import annotations

import asyncio
import time

from sqlalchemy import select
from starlette.concurrency import run_in_threadpool

from app.api.deps import Server
from app.db.models import Submission

PAUSE = 0.05  # s
IN_VALIDATION = ("received", "validating")


async def wait_for_validation(server: Server, submission_id: int) -> None:
    """Return once a submission's upload was validated, its sender has waited long enough, or the server is to end."""
    deadline = time.monotonic() + server.settings.validation_seconds
    while _may_wait(server, deadline) and await run_in_threadpool(_is_in_validation, server, submission_id):
        await asyncio.sleep(PAUSE)


def _may_wait(server: Server, deadline: float) -> bool:
    return time.monotonic() < deadline and not server.stopping.is_set()


def _is_in_validation(server: Server, submission_id: int) -> bool:
    with server.database.read() as session:
        status = session.scalar(select(Submission.status).where(Submission.id == submission_id))
    return status in IN_VALIDATION
