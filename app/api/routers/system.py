"""Health and configuration."""

from __future__ import annotations

from typing import get_args

from fastapi import APIRouter

from app import __version__
from app.api.deps import Reader, ServerDep, ViewerDep
from app.api.schemas.system import Configuration, Health, Limits
from app.formats.exports import EXPORTS
from app.services.installation import instance_of
from app.vision.parameters import DetectionParameters, OperatingPoint

router = APIRouter(tags=["system"])


@router.get("/health")
def health() -> Health:
    """Say that the server answers."""
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
        local=settings.anonymous_role == "owner",
        person=viewer.name,
    )
