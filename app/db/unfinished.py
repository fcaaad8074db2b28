"""The mark of a database that is being filled from another one, and isn't whole yet."""

from __future__ import annotations

from sqlalchemy import Connection, inspect

from app.errors import Unavailable

UNFINISHED = "unfinished_copy"
"""Name of a table that is there as long as the rest isn't whole."""


def is_unfinished(connection: Connection) -> bool:
    """Whether a copy into the database was begun and hasn't ended."""
    return inspect(connection).has_table(UNFINISHED)


def require_finished(connection: Connection) -> None:
    """Refuse a database into which a copy hasn't ended.

    Raises:
        Unavailable: When it is so.
    """
    if is_unfinished(connection):
        raise Unavailable(
            "a copy into this database was begun and hasn't ended: it isn't whole",
            where=connection.engine.url.render_as_string(hide_password=True),
            hint="wait for clearlines migrate or restore if it is at work, else give the same command again",
        )
