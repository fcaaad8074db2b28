"""The state of the server, for admins."""

from __future__ import annotations

from fastapi import APIRouter, Response

from app import __version__
from app.api.deps import Now, Reader, ServerDep
from app.api.disks import disks_of
from app.api.metrics import MEDIA_TYPE
from app.api.problems import answers
from app.api.schemas.status import (
    CrewStatus,
    DatabaseStatus,
    DispatcherStatus,
    FailureInfo,
    QueueStanding,
    Status,
)
from app.jobs.holder import holder_of_lock
from app.services.database_status import database_status
from app.services.failures import latest_failures
from app.services.queue_status import queue_standings

router = APIRouter(tags=["system"])

FAILURES = 20


@router.get("/status", responses=answers(503))
def status(server: ServerDep, session: Reader, now: Now) -> Status:
    """Return what waits and what failed, who works, and what room is left."""
    failures = latest_failures(session)
    dispatcher = server.dispatcher.status()
    holder = holder_of_lock(session)
    return Status(
        version=__version__,
        started_at=server.started_at,
        now=now,
        hosted=server.settings.hosted,
        queue=[QueueStanding.model_validate(standing) for standing in queue_standings(session, failures, now)],
        crew=CrewStatus.model_validate(dispatcher.crew),
        dispatcher=DispatcherStatus(
            here=dispatcher.holds_lock,
            held=True if dispatcher.holds_lock else None if server.database.is_sqlite else holder is not None,
            holder=None if holder is None else holder.address,
            since=None if holder is None else holder.since,
            running=dispatcher.running,
            in_hand=dispatcher.waiting,
        ),
        disks=disks_of(server),
        database=DatabaseStatus.model_validate(database_status(server.database, session)),
        failures=[FailureInfo.model_validate(failure) for failure in failures[:FAILURES]],
    )


@router.get("/metrics", response_class=Response, responses={200: {"content": {"text/plain": {}}}})
def metrics(server: ServerDep) -> Response:
    """Return what Prometheus reads; also at `/metrics`, and for the bearer token of the settings."""
    return Response(server.metrics.text(), media_type=MEDIA_TYPE)
