"""What goes wrong around work: a database that can't answer for a while, and reasons that are stored with the work."""

from __future__ import annotations

from typing import Any

from sqlalchemy.exc import DisconnectionError, InterfaceError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeout

from app.errors import ClearLinesError, Unavailable

DATABASE_TROUBLE = (OperationalError, InterfaceError, DisconnectionError, PoolTimeout, Unavailable)
"""Errors of a database that will answer again: work that met one is kept and stored later."""


def reason_of(error: BaseException) -> dict[str, Any]:
    """Return an error as the JSON-serialisable reason that is stored with what failed."""
    if isinstance(error, ClearLinesError):
        return error.as_dict()
    return ClearLinesError(f"{type(error).__name__}: {error}").as_dict()
