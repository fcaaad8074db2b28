"""One dispatcher at a time for one database, whatever number of processes serve it.

The lock ends with the process that holds it, however that ends. So whoever gets it knows that all work which the rows
call running was left behind, and needs not wait for heartbeats to grow old.
"""

from __future__ import annotations

from app.db import locks
from app.db.session import Database

DispatcherLock = locks.Lock


def lock_for(database: Database) -> DispatcherLock:
    """Return the dispatcher's lock of a database; nothing is locked yet."""
    return locks.lock_for(database, "dispatcher")
