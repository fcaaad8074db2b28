"""Who holds the dispatcher's lock, as another server sees it."""

from __future__ import annotations

from app.db.locks import lock_for
from app.db.session import Database
from app.jobs.holder import holder_of_lock


def test_the_database_tells_who_gives_work_out(database: Database) -> None:
    with database.read() as session:
        assert holder_of_lock(session) is None
    lock = lock_for(database, "dispatcher")
    assert lock.acquire()
    try:
        with database.read() as session:
            holder = holder_of_lock(session)
    finally:
        lock.release()
    if database.is_sqlite:  # its locks have no names on them
        assert holder is None
    else:
        assert holder is not None
        assert holder.since.tzinfo is not None
    with database.read() as session:
        assert holder_of_lock(session) is None
