"""The web application: one process serves the API, the browser tool and works off pre-labelling runs."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path

from fastapi import APIRouter, FastAPI, Request
from fastapi.responses import RedirectResponse
from starlette.exceptions import HTTPException
from starlette.routing import BaseRoute, Match

from app import __version__
from app.api.deps import Server
from app.api.layers import add_layers
from app.api.metrics import Metrics
from app.api.openid_setup import configured_sign_in
from app.api.problems import answers, install_problem_handlers
from app.api.readiness import Readiness
from app.api.routers import (
    account,
    agreement,
    audit,
    board,
    calibration_files,
    calibrations,
    cameras,
    candidates,
    cards,
    datasets,
    edits,
    exports,
    images,
    invitations,
    labelling,
    methods,
    openid,
    people,
    runs,
    second_reviews,
    segments,
    session,
    splits,
    status,
    submissions,
    suggestions,
    system,
    uploads,
    users,
)
from app.api.scraping import StateCollector
from app.api.throttle import Throttle
from app.clock import utc_now
from app.db.session import open_database, upgrade
from app.jobs.calibration_desk import CalibrationDesk
from app.jobs.dispatcher import Dispatcher
from app.jobs.feature_desk import FeatureDesk
from app.jobs.histories import Histories
from app.jobs.housekeeping import Housekeeper
from app.jobs.scoring_desk import scoring_desk
from app.jobs.tracing import Tracer
from app.services.card_tables import SHOWN_IMAGES, CardTables
from app.services.work_logs import WorkLogs
from app.settings import Settings
from app.storage import open_blobs

METHODS = ["GET", "POST", "PUT", "PATCH", "DELETE"]
FROM_ANY_ROUTE = (400, 401, 403, 408, 413, 422, 429, 503, 507)
"""Statuses that come from before a route: its body, who asks, how often; and from a database or a disk that can't."""
ROUTERS = (
    system,
    status,
    session,
    openid,
    account,
    users,
    invitations,
    audit,
    datasets,
    cards,
    uploads,
    images,
    labelling,
    people,
    second_reviews,
    agreement,
    candidates,
    edits,
    segments,
    suggestions,
    runs,
    cameras,
    calibrations,
    calibration_files,
    exports,
    splits,
    submissions,
    methods,
    board,
)
STATIC = Path(__file__).resolve().parent.parent / "static"
DESCRIPTION = """
Turn street images into ground truth for straight edge-segments: upload, pre-label, keep or reject, export.

Coordinates: x right, y down, in px, pixel centre at integers. Errors are problem documents (RFC 9457).
"""


def create_application(settings: Settings) -> FastAPI:
    """Return the application; the database is opened, and the work taken up, when it starts.

    Its ``state.stopping`` is set when it is to end: answers that would go on for long end then.
    """
    metrics = Metrics()
    stopping = threading.Event()

    @asynccontextmanager
    async def lifespan(application: FastAPI) -> AsyncIterator[None]:
        stopping.clear()
        database = open_database(settings.database_address)
        upgrade(database, backups=settings.backups, now=utc_now())
        blobs = open_blobs(settings)
        dispatcher = Dispatcher(database, blobs, settings, utc_now, on_work=metrics.work_ended)
        histories = Histories(blobs, settings.max_image_pixels)
        features = FeatureDesk(database, blobs, settings.max_image_pixels, utc_now)
        tables = CardTables(database, most=SHOWN_IMAGES)
        desk = scoring_desk(settings, blobs)
        tracer = Tracer(blobs, settings.max_image_pixels)
        calibration_desk = CalibrationDesk()
        sign_in = configured_sign_in(settings)
        application.state.server = Server(
            settings,
            database,
            blobs,
            dispatcher,
            histories,
            features,
            tables,
            WorkLogs(database),
            utc_now,
            desk,
            tracer,
            calibration_desk,
            Throttle(settings, on_failure=metrics.sign_in_failed),
            utc_now(),
            Readiness(database, blobs),
            metrics,
            stopping,
            sign_in,
        )
        state = StateCollector(application.state.server)
        metrics.registry.register(state)
        housekeeper = Housekeeper(database, blobs, grace=settings.grace, clock=utc_now)
        dispatcher.start()
        housekeeper.start()
        try:
            yield
        finally:
            stopping.set()
            metrics.registry.unregister(state)
            housekeeper.stop()
            dispatcher.stop()
            histories.stop()
            features.stop()
            desk.stop()
            tracer.stop()
            calibration_desk.stop()
            if sign_in is not None:
                sign_in.close()
            blobs.close()
            database.close()

    application = FastAPI(
        title="ClearLines",
        version=__version__,
        description=DESCRIPTION,
        lifespan=lifespan,
        openapi_url="/api/openapi.json",
        docs_url=None,
        redoc_url=None,
    )
    application.state.stopping = stopping
    install_problem_handlers(application)
    application.routes.extend(_api_routes())
    application.include_router(_unknown_addresses(tuple(application.routes)))
    has_pages = (STATIC / "index.html").is_file()
    if has_pages:
        application.frontend("/", directory=str(STATIC))
    add_layers(application, settings, metrics, STATIC if has_pages else None)
    return application


@cache
def _api_routes() -> Sequence[BaseRoute]:
    """Return the routes of the API: they know no settings, and building them takes longer than all else here."""
    router = APIRouter(responses=answers(*FROM_ANY_ROUTE))
    for each in ROUTERS:
        router.include_router(each.router, prefix="/api")
    return tuple(router.routes)


def _unknown_addresses(known: Sequence[BaseRoute]) -> APIRouter:
    """Return the routes that keep the browser tool from answering for the API.

    Args:
        known: The API's own routes; an address of theirs that is asked with another method gets 405.
    """
    router = APIRouter(include_in_schema=False)

    @router.get("/api/docs")
    def documentation() -> RedirectResponse:
        return RedirectResponse("/docs/api")

    @router.api_route("/api", methods=METHODS)
    @router.api_route("/api/{path:path}", methods=METHODS)
    def unknown(request: Request) -> None:
        scope = request.scope
        allowed = [
            method
            for method in METHODS
            if any(route.matches({**scope, "method": method})[0] == Match.FULL for route in known)
        ]
        if allowed:
            raise HTTPException(405, headers={"Allow": ", ".join(allowed)})
        raise HTTPException(404)

    return router
