"""Sessions: reading sessions can't write, writing sessions commit or roll back, and many at once don't fail."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime
from pathlib import Path

import pytest
from sqlalchemy import select, text
from sqlalchemy.exc import DBAPIError

from app.db.models import Dataset
from app.db.session import Database, open_database, upgrade
from app.errors import Conflict, InvalidInput, Unavailable


def add(database: Database, name: str, now: datetime) -> None:
    with database.write() as session:
        session.add(Dataset(slug=name, name=name, created_at=now))


def names(database: Database) -> list[str]:
    with database.read() as session:
        return list(session.scalars(select(Dataset.name).order_by(Dataset.name)))


def test_write_commits(database: Database, now: datetime) -> None:
    add(database, "one", now)
    assert names(database) == ["one"]


def test_write_rolls_back_on_an_error(database: Database, now: datetime) -> None:
    def fail_after_writing() -> None:
        with database.write() as session:
            session.add(Dataset(slug="one", name="one", created_at=now))
            session.flush()
            raise KeyError

    with pytest.raises(KeyError):
        fail_after_writing()
    assert names(database) == []


def test_read_sees_one_snapshot(database: Database, now: datetime) -> None:
    with database.read() as session:
        assert session.scalars(select(Dataset.name)).all() == []
        add(database, "one", now)
        assert session.scalars(select(Dataset.name)).all() == []
    assert names(database) == ["one"]


def test_read_can_not_write(database: Database, now: datetime) -> None:
    with database.read() as session:
        session.add(Dataset(slug="one", name="one", created_at=now))
        with pytest.raises(DBAPIError):
            session.flush()
    add(database, "two", now)  # a connection that was used for reading writes again
    assert names(database) == ["two"]


def test_the_same_name_at_the_same_time_is_a_conflict(database: Database, now: datetime) -> None:
    add(database, "one", now)
    with pytest.raises(Conflict):
        add(database, "one", now)


def test_a_missing_value_is_our_mistake_and_no_conflict(database: Database) -> None:
    with pytest.raises(DBAPIError), database.write() as session:
        session.execute(text("INSERT INTO datasets (slug) VALUES ('x')"))


def test_times_keep_their_zone(database: Database, now: datetime) -> None:
    add(database, "one", now)
    with database.read() as session:
        stored = session.scalars(select(Dataset.created_at)).one()
    assert stored == now
    assert stored.tzinfo is not None


def test_sqlite_settings(sqlite_database: Database) -> None:
    with sqlite_database.read() as session:
        values = [
            session.execute(text(f"PRAGMA {name}")).scalar()
            for name in ("journal_mode", "synchronous", "foreign_keys", "busy_timeout")
        ]
    assert values == ["wal", 1, 1, 30000]


def test_eight_threads_read_then_write(database: Database, now: datetime) -> None:
    """Each transaction reads a number and stores the next: a lost update or a locked database shows at once."""
    add(database, "0", now)
    threads, rounds = 8, 25
    together = threading.Barrier(threads)

    def count_up(_thread: int) -> None:
        together.wait()
        for _ in range(rounds):
            with database.write() as session:
                row = session.scalars(select(Dataset).with_for_update()).one()
                row.name = str(int(row.name) + 1)

    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(count_up, range(threads)))
    assert names(database) == [str(threads * rounds)]


def test_deferred_begin_would_fail(sqlite_database: Database, now: datetime) -> None:
    """Why writing sessions begin IMMEDIATE: with the default, what is read first can't be written afterwards."""
    add(sqlite_database, "0", now)
    with sqlite_database.engine.connect() as connection:
        connection.execute(select(Dataset.name)).all()
        add(sqlite_database, "1", now)
        connection.exec_driver_sql("PRAGMA query_only = OFF")
        with pytest.raises(DBAPIError, match="database is locked"):
            connection.execute(text("UPDATE datasets SET name = 'x'"))


def test_a_writer_in_the_way_is_told_as_unavailable(sqlite_database: Database, now: datetime) -> None:
    impatient = open_database(sqlite_database.engine.url, busy_timeout=0.01)
    with sqlite_database.write() as first:
        first.execute(select(Dataset)).all()
        with pytest.raises(Unavailable), impatient.write() as second:
            second.execute(select(Dataset)).all()
    add(impatient, "one", now)
    impatient.close()


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("nonsense", "can't be read"),
        ("mysql://localhost/x", "mysql"),
        ("sqlite://", "in memory"),
        ("sqlite:///:memory:", "in memory"),
    ],
)
def test_addresses_that_can_not_be_used(address: str, words: str) -> None:
    with pytest.raises(InvalidInput, match=words):
        open_database(address)


def test_a_database_out_of_reach_is_unavailable_to_whoever_reads_writes_or_upgrades() -> None:
    database = open_database("postgresql://nobody@127.0.0.1:1/nothing")
    with pytest.raises(Unavailable, match="can't answer"), database.read() as session:
        session.scalar(select(Dataset.id))
    with pytest.raises(Unavailable, match="can't answer"), database.write() as session:
        session.scalar(select(Dataset.id))
    with pytest.raises(Unavailable, match="can't answer"):
        upgrade(database)


def test_a_file_that_is_no_database_is_told(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_bytes(b"no database at all" * 100)
    with pytest.raises(InvalidInput, match="no SQLite database"):
        upgrade(open_database(f"sqlite:///{path}"))
