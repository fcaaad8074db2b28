"""What routes ask for, as annotated aliases."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING, Annotated

from fastapi import Depends, Query, Request
from sqlalchemy.orm import Session

from app.api.decoding import Decoding
from app.api.metrics import Metrics
from app.api.readiness import Readiness
from app.api.throttle import Throttle, client_address
from app.db.session import Database
from app.errors import Forbidden
from app.jobs.calibration_desk import CalibrationDesk
from app.jobs.dispatcher import Dispatcher
from app.jobs.feature_desk import FeatureDesk
from app.jobs.histories import Histories
from app.jobs.scoring_desk import ScoringDesk
from app.jobs.tracing import Tracer
from app.services.access import Viewer
from app.services.card_tables import CardTables
from app.services.events import Actor
from app.services.passwords import Passwords
from app.services.remembering import Remembered
from app.services.web_sessions import Browser
from app.services.work_logs import WorkLogs
from app.settings import Settings
from app.storage import BlobStore

if TYPE_CHECKING:  # its libraries are an extra
    from app.openid.sign_in import OpenIdSignIn


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
    throttle: Throttle
    started_at: datetime
    readiness: Readiness
    metrics: Metrics
    stopping: threading.Event
    openid: OpenIdSignIn | None
    decoding: Decoding = field(default_factory=Decoding)
    remembered: Remembered = field(default_factory=Remembered)
    passwords: Passwords = field(default_factory=Passwords)


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


def get_account_id(request: Request) -> int:
    """Return whose account asks; the gate lets nobody else to the addresses of accounts."""
    user_id = get_viewer(request).user_id
    if user_id is None:
        raise Forbidden("this needs an account")
    return user_id


def get_signed_in(request: Request) -> int:
    """Return whose account asks, in a browser: a token that is lost mustn't become another one, or a password.

    Raises:
        Forbidden: When a token asks.
    """
    user_id = get_account_id(request)
    if get_viewer(request).web_session_id is None:
        raise Forbidden("a token may not change its account", hint="sign in with a browser")
    return user_id


def get_actor(request: Request) -> Actor:
    """Return who asks, as the audit tells it."""
    return Actor(get_viewer(request).name, get_browser(request).address)


def get_browser(request: Request) -> Browser:
    """Return where somebody asks from, and with what."""
    return Browser(client_address(request.scope), request.headers.get("user-agent"))


def get_now(server: ServerDep) -> datetime:
    """Return the time of the request, UTC."""
    return server.clock()


Reader = Annotated[Session, Depends(get_reader, scope="function")]
Now = Annotated[datetime, Depends(get_now)]
ViewerDep = Annotated[Viewer, Depends(get_viewer)]
AccountId = Annotated[int, Depends(get_account_id)]
SignedIn = Annotated[int, Depends(get_signed_in)]
ActorDep = Annotated[Actor, Depends(get_actor)]
BrowserDep = Annotated[Browser, Depends(get_browser)]
Limit = Annotated[int, Query(ge=1, le=500, description="At most this many.")]
Cursor = Annotated[str | None, Query(max_length=2000, description="From ``next_cursor`` of the page before.")]
