"""Health and what the browser tool must know about the server."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from app.api.schemas.base import Answer


class Health(Answer):
    """The server answers."""

    status: Literal["ok"] = "ok"
    version: str


class Limits(Answer):
    """Bounds on what is uploaded."""

    max_image_pixels: int
    max_upload_bytes: int
    max_archive_members: int
    max_archive_bytes: int


class Configuration(Answer):
    """What the browser tool must know before it shows anything."""

    version: str
    instance: str = Field(description="Tells this database from every other one, whatever address it is served at.")
    limits: Limits
    grace_days: int
    run_defaults: dict[str, Any]
    operating_points: list[str]
    export_formats: list[str]
    local: bool = Field(description="Whether who asks without a token is the owner.")
    person: str | None = Field(description="Under which name is stored what the viewer does.")
