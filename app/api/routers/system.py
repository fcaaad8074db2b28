"""Health, readiness and configuration."""

from __future__ import annotations

from typing import get_args

from fastapi import APIRouter, Request

from app import __version__
from app.api.deps import Reader, ServerDep, ViewerDep, get_server
from app.api.problems import answers
from app.api.schemas.system import Configuration, Health, Limits
from app.formats.exports import EXPORTS
from app.services.installation import instance_of
from app.vision.parameters import DetectionParameters, OperatingPoint

router = APIRouter(tags=["system"])


@router.get("/health")
async def health() -> Health:
    """Say that the server answers; neither database nor files are asked, nor a thread that may wait for them."""
    return Health(version=__version__)


@router.get("/ready", responses=answers(503))
async def ready(request: Request) -> Health:
    """Say that the server can work: the database answers in the form that is expected, and so does the blob store."""
    await get_server(request).readiness.require()  # a dependency would wait for a thread
    return Health(version=__version__)


@router.get("/configuration")
def configuration(server: ServerDep, viewer: ViewerDep, session: Reader) -> Configuration:
    """Return what a client must know before it shows anything."""
    settings = server.settings
    return Configuration(
        version=__version__,
        instance=instance_of(session),
        limits=Limits.model_validate(settings),
        grace_days=settings.grace_days,
        run_defaults={**DetectionParameters().as_dict(), "camera": "joint", "discard": False},
        operating_points=list(get_args(OperatingPoint)),
        export_formats=list(EXPORTS),
        local=settings.anonymous == "admin",
        person=viewer.name,
    )
