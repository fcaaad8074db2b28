"""What is saved before an upgrade stays when the upgrade went well, and goes when it failed."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from app.db.migrations import run_upgrade
from app.db.session import Database, open_database, upgrade
from app.errors import Unavailable


@pytest.fixture
def old(tmp_path: Path) -> Database:
    """A database without accounts."""
    database = open_database(f"sqlite:///{tmp_path}/old.sqlite3")
    run_upgrade(database.engine, "0004")
    return database


def test_an_upgrade_leaves_one_file_behind(old: Database, tmp_path: Path, now: datetime) -> None:
    backups = tmp_path / "backups"
    for number in range(2):
        upgrade(old, backups=backups, now=now + timedelta(seconds=number))
    old.close()
    (file,) = backups.iterdir()
    with closing(sqlite3.connect(file)) as saved:
        assert saved.execute("SELECT version_num FROM alembic_version").fetchall() == [("0004",)]


def test_one_that_fails_leaves_none_however_often_it_is_tried(old: Database, tmp_path: Path, now: datetime) -> None:
    backups = tmp_path / "backups"
    with old.engine.execution_options(sqlite_begin="IMMEDIATE").begin() as connection:
        connection.exec_driver_sql("CREATE TABLE users (in_the_way INTEGER)")
    for number in range(2):
        with pytest.raises(Unavailable, match="users"):
            upgrade(old, backups=backups, now=now + timedelta(seconds=number))
    old.close()
    assert list(backups.iterdir()) == []
