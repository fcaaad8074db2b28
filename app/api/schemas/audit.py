"""The audit."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from pydantic import Field

from app.api.schemas.base import Answer


class AuditLine(Answer):
    """Something that was done."""

    id: int
    created_at: datetime
    kind: str = Field(description="`user.created`, `session.failed`, `dataset.renamed`...")
    person: str | None = Field(description="Who did it; null where nobody has said it, and for the server itself.")
    address: str | None = Field(description="Where they asked from, on what concerns accounts.")
    dataset: str | None = Field(description="Slug of the dataset that it concerns.")
    details: dict[str, Any]


class AuditLines(Answer):
    """A page of the audit, newest first."""

    items: list[AuditLine]
    next_cursor: str | None
