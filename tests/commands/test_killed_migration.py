"""A migration that is killed leaves nothing that could be taken for an installation."""

from __future__ import annotations

import sqlite3
import subprocess
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import psycopg
import pytest
from sqlalchemy import func, insert, inspect, select

from app.db.models import Camera, Dataset, Image, Segment
from app.db.models.datasets import Blob
from app.db.session import open_database, upgrade
from app.db.unfinished import UNFINISHED

SEGMENTS = 20_000
"""So many that they take a moment to copy."""

Start = Callable[..., subprocess.Popen[str]]


@pytest.fixture
def many_segments(sqlite_template: Path, tmp_path: Path, now: Any) -> None:
    """An installation in the folder ``data``, with segments that take a moment to copy."""
    (tmp_path / "data").mkdir()
    path = tmp_path / "data" / "clearlines.sqlite3"
    path.write_bytes(sqlite_template.read_bytes())
    database = open_database(f"sqlite:///{path}")
    named = {"name": "x", "created_at": now}
    size = {"width": 4, "height": 3}
    with database.write() as session:
        session.execute(insert(Dataset).values(id=1, slug="x", **named))
        session.execute(insert(Camera).values(id=1, dataset_id=1, **named, **size))
        session.execute(insert(Blob).values(sha256="a", size=1, media_type="x", created_at=now))
        session.execute(
            insert(Image).values(id=1, dataset_id=1, camera_id=1, sha256="a", file_name="x", bits=8, **named, **size)
        )
        ends = {"x0": 0.0, "y0": 0.0, "x1": 1.0, "y1": 1.0, "length": 1.0}
        segment = {"image_id": 1, "n_points": 30, "points": bytes(240), "origin": "pipeline", **ends}
        session.execute(insert(Segment), [{**segment, "ordinal": number} for number in range(SEGMENTS)])
    database.close()


def until(reached: Callable[[], bool], process: subprocess.Popen[str]) -> None:
    deadline = time.monotonic() + 60
    while not reached():
        assert process.poll() is None, process.communicate()[1]
        assert time.monotonic() < deadline
        time.sleep(0.001)


def segments_in(address: str) -> int | None:
    database = open_database(address)
    try:
        if not inspect(database.engine).has_table("segments"):
            return None
        with database.read() as session:
            return session.scalar(select(func.count()).select_from(Segment))
    finally:
        database.close()


@pytest.mark.usefixtures("many_segments")
def test_killed_while_it_writes_to_sqlite(start: Start, clearlines: Any, tmp_path: Path) -> None:
    place = tmp_path / "new.sqlite3"
    address = f"sqlite:///{place}"
    process = start("migrate", "--to", address)
    until(place.exists, process)
    with closing(sqlite3.connect(place, isolation_level=None, timeout=30)) as connection:

        def begun() -> bool:
            tables = connection.execute("SELECT name FROM sqlite_master").fetchall()
            return ("segments",) in tables and connection.execute("SELECT count(*) FROM segments").fetchone()[0] > 0

        until(begun, process)
        connection.execute("BEGIN IMMEDIATE")  # it waits for us in the middle
        process.kill()
        process.wait()
        connection.execute("ROLLBACK")
    assert 0 < (segments_in(address) or 0) < SEGMENTS
    require_refused_then_whole(clearlines, address)


@pytest.mark.usefixtures("many_segments")
def test_killed_while_it_writes_to_postgresql(start: Start, clearlines: Any, empty_postgres: Callable[[], str]) -> None:
    address = empty_postgres()
    process = start("migrate", "--to", address)
    with psycopg.connect(address, autocommit=True) as connection:
        copying = b"SELECT count(*) FROM pg_stat_progress_copy WHERE tuples_processed > 1000"
        until(lambda: connection.execute(copying).fetchone() != (0,), process)
        process.kill()
        process.wait()
        at_work = b"SELECT count(*) FROM pg_stat_activity WHERE query LIKE 'COPY%' AND state <> 'idle'"
        deadline = time.monotonic() + 60
        while connection.execute(at_work).fetchone() != (0,):
            assert time.monotonic() < deadline
            time.sleep(0.01)
        assert connection.execute(f"SELECT count(*) FROM {UNFINISHED}".encode()).fetchone() == (0,)
    assert not segments_in(address), "rows come all or none"
    require_refused_then_whole(clearlines, address)


def require_refused_then_whole(clearlines: Any, address: str) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CLEARLINES_DATABASE_URL", address)
        refused = clearlines("serve", "--no-browser", "--port", 0, status=2).stderr
        assert "a copy into this database was begun and hasn't ended" in refused
    clearlines("migrate", "--to", address)
    database = open_database(address)
    upgrade(database)
    database.close()
    assert segments_in(address) == SEGMENTS
