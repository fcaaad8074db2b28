"""One dispatcher at a time for one database."""

from __future__ import annotations

from sqlalchemy import text

from app.db.locks import lock_for
from app.db.session import open_database


def test_only_one_holds_the_lock(database, database_url: str) -> None:
    other_database = open_database(database_url)
    first, second = lock_for(database, "dispatcher"), lock_for(other_database, "dispatcher")
    assert first.acquire()
    assert first.acquire()
    assert not second.acquire()
    first.release()
    first.release()
    assert second.acquire()
    assert not first.acquire()
    second.release()
    other_database.close()


def test_a_lock_whose_connection_broke_is_free_for_another(database, eventually) -> None:
    if database.is_sqlite:
        return  # a file lock has no connection that could break
    lock, other = lock_for(database, "dispatcher"), lock_for(database, "dispatcher")
    assert lock.acquire()
    with database.engine.connect() as connection:
        connection.execute(
            text("SELECT pg_terminate_backend(pid) FROM pg_locks WHERE locktype = 'advisory' AND objsubid = 1")
        )
    # the server ends a connection after it said that it would
    eventually(other.acquire, "the lock was free")
    assert not lock.acquire()
    other.release()
    assert lock.acquire()
    lock.release()
