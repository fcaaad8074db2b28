"""Which server's dispatcher works, as the database tells."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime

from sqlalchemy import text
from sqlalchemy.orm import Session

from app.db.locks import ADVISORY_LOCKS

HOLDER = text(
    "SELECT host(activity.client_addr), activity.backend_start"
    " FROM pg_locks AS locks JOIN pg_stat_activity AS activity ON activity.pid = locks.pid"
    " WHERE locks.locktype = 'advisory' AND locks.granted AND locks.objsubid = 1"
    " AND (locks.classid::bigint << 32 | locks.objid::bigint) = :key"
    " AND locks.database = (SELECT oid FROM pg_database WHERE datname = current_database())"
)


@dataclass(frozen=True)
class Holder:
    """Whose dispatcher holds the lock.

    Attributes:
        address: From where it is connected to the database; ``None`` on the database's own machine.
        since: When it connected.
    """

    address: str | None
    since: datetime


def holder_of_lock(session: Session) -> Holder | None:
    """Return who holds the lock; ``None`` when nobody does, and on SQLite, which can't tell.

    Args:
        session: A reading session.
    """
    if session.get_bind().dialect.name == "sqlite":
        return None
    row = session.execute(HOLDER, {"key": ADVISORY_LOCKS["dispatcher"]}).first()
    return None if row is None else Holder(row[0], row[1].astimezone(UTC))
