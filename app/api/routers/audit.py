"""The audit: who did what."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

from fastapi import APIRouter, Query

from app.api.deps import Cursor, Limit, Reader
from app.api.problems import answers
from app.api.schemas.audit import AuditLines
from app.services.audit import AuditFilter, read_audit

router = APIRouter(tags=["audit"])


@router.get("/audit", responses=answers(404))
def audit(
    session: Reader,
    person: Annotated[str | None, Query(max_length=200, description="Who did it.")] = None,
    kind: Annotated[
        str | None, Query(max_length=60, description="How the kind begins: `user.`, `session.failed`.")
    ] = None,
    dataset: Annotated[str | None, Query(max_length=500, description="Slug of the dataset that it concerns.")] = None,
    since: Annotated[datetime | None, Query(description="From this time on; with its zone.")] = None,
    until: Annotated[datetime | None, Query(description="Before this time; with its zone.")] = None,
    limit: Limit = 100,
    cursor: Cursor = None,
) -> AuditLines:
    """Return who did what, newest first. Verdicts are in their images' histories, not here."""
    wanted = AuditFilter(person or None, kind or None, dataset or None, since, until)
    return AuditLines.model_validate(read_audit(session, wanted, limit=limit, cursor=cursor))
