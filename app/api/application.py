"""The web application: one process serves the API, the browser tool and works off pre-labelling runs."""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from pathlib import Path

from fastapi import APIRouter, FastAPI, Request
from fastapi.responses import RedirectResponse
from starlette.exceptions import HTTPException
from starlette.middleware.gzip import DEFAULT_EXCLUDED_CONTENT_TYPES, GZipMiddleware
from starlette.routing import BaseRoute, Match

from app import __version__
from app.api.built_files import BuiltFiles
from app.api.deps import Server
from app.api.gate import Gate
from app.api.guard import Guard
from app.api.head import HeadAsGet
from app.api.opening import Opening
from app.api.problems import answers, install_problem_handlers
from app.api.routers import (
    agreement,
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
    labelling,
    methods,
    people,
    runs,
    second_reviews,
    segments,
    session,
    splits,
    submissions,
    suggestions,
    system,
    uploads,
)
from app.clock import utc_now
from app.db.session import open_database, upgrade
from app.jobs.calibration_desk import CalibrationDesk
from app.jobs.dispatcher import Dispatcher
from app.jobs.feature_desk import FeatureDesk
from app.jobs.histories import Histories
from app.jobs.housekeeping import Housekeeper
from app.jobs.scoring_desk import scoring_desk
from app.jobs.tracing import Tracer
from app.services.card_tables import CardTables
from app.services.work_logs import WorkLogs
from app.settings import Settings
from app.storage import BlobStore

METHODS = ["GET", "POST", "PUT", "PATCH", "DELETE"]
ROUTERS = (
    system,
    session,
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
    """Return the application; the database is opened, and the work taken up, when it starts."""

    @asynccontextmanager
    async def lifespan(application: FastAPI) -> AsyncIterator[None]:
        database = open_database(settings.database_address)
        upgrade(database)
        blobs = BlobStore(settings.blob_dir)
        dispatcher = Dispatcher(database, blobs, settings, utc_now)
        histories = Histories(blobs, settings.max_image_pixels)
        features = FeatureDesk(database, blobs, settings.max_image_pixels, utc_now)
        tables = CardTables(database)
        desk = scoring_desk(settings, blobs)
        tracer = Tracer(blobs, settings.max_image_pixels)
        calibration_desk = CalibrationDesk()
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
        )
        housekeeper = Housekeeper(database, blobs, grace=settings.grace, clock=utc_now)
        dispatcher.start()
        housekeeper.start()
        try:
            yield
        finally:
            housekeeper.stop()
            dispatcher.stop()
            histories.stop()
            features.stop()
            desk.stop()
            tracer.stop()
            calibration_desk.stop()
            database.close()

    application = FastAPI(
        title="ClearLines",
        version=__version__,
        description=DESCRIPTION,
        lifespan=lifespan,
        openapi_url="/api/openapi.json",
        docs_url=None,
        redoc_url=None,
        responses=answers(401, 403, 422),
    )
    install_problem_handlers(application)
    for router in ROUTERS:
        application.include_router(router.router, prefix="/api")
    application.include_router(_unknown_addresses(list(application.routes)))
    if (STATIC / "index.html").is_file():
        application.frontend("/", directory=str(STATIC))
        application.add_middleware(Opening, static=STATIC)
        application.add_middleware(BuiltFiles, static=STATIC)
    application.add_middleware(Gate)
    application.add_middleware(
        GZipMiddleware,
        minimum_size=2000,
        compresslevel=5,
        exclude_content_types=(*DEFAULT_EXCLUDED_CONTENT_TYPES, "application/octet-stream"),
    )
    application.add_middleware(HeadAsGet)
    application.add_middleware(Guard, max_body_bytes=settings.max_upload_bytes)
    return application


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
