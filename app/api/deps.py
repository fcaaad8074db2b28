"""What routes ask for, as annotated aliases."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import datetime
from typing import Annotated

from fastapi import Depends, Query, Request
from sqlalchemy.orm import Session

from app.api.decoding import Decoding
from app.db.session import Database
from app.jobs.calibration_desk import CalibrationDesk
from app.jobs.dispatcher import Dispatcher
from app.jobs.feature_desk import FeatureDesk
from app.jobs.histories import Histories
from app.jobs.scoring_desk import ScoringDesk
from app.jobs.tracing import Tracer
from app.services.access import Viewer
from app.services.card_tables import CardTables
from app.services.work_logs import WorkLogs
from app.settings import Settings
from app.storage import BlobStore


@dataclass(frozen=True)
class Server:
    """What one running server holds: made at its start, closed at its end."""

    settings: Settings
    database: Database
    blobs: BlobStore
    dispatcher: Dispatcher
    histories: Histories
    features: FeatureDesk
    card_tables: CardTables
    work_logs: WorkLogs
    clock: Callable[[], datetime]
    desk: ScoringDesk
    tracer: Tracer
    calibrations: CalibrationDesk
    decoding: Decoding = field(default_factory=Decoding)


def get_server(request: Request) -> Server:
    """Return the server that answers this request."""
    server: Server = request.app.state.server
    return server


ServerDep = Annotated[Server, Depends(get_server)]


def get_reader(server: ServerDep) -> Iterator[Session]:
    """Give a session that only reads, for the time of one request."""
    with server.database.read() as session:
        yield session


def get_viewer(request: Request) -> Viewer:
    """Return who asks, as the gate has found them."""
    viewer: Viewer = request.state.viewer
    return viewer


def get_now(server: ServerDep) -> datetime:
    """Return the time of the request, UTC."""
    return server.clock()


Reader = Annotated[Session, Depends(get_reader, scope="function")]
Now = Annotated[datetime, Depends(get_now)]
ViewerDep = Annotated[Viewer, Depends(get_viewer)]
Limit = Annotated[int, Query(ge=1, le=500, description="At most this many.")]
Cursor = Annotated[str | None, Query(max_length=2000, description="From ``next_cursor`` of the page before.")]
