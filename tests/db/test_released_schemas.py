"""Databases of every released schema are saved, then brought to this version's, and nothing is lost on the way."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import inspect, text

from app.db.copying.copy import copy_rows
from app.db.copying.targets import filling
from app.db.migrations import revisions, stored_revision
from app.db.session import Database, upgrade
from app.db.sqlite_files import open_saved
from app.errors import Unavailable

Make = Callable[..., Database]


@pytest.mark.parametrize("revision", revisions()[:-1])
def test_an_older_database_is_saved_and_brought_up_to_date(
    revision: str, blank_url: str, filled: Make, opened: Any, digests_of: Any, tmp_path: Path, now: datetime
) -> None:
    database = filled(blank_url, revision)
    before = digests_of(database)
    assert all(digest.rows for digest in before.values())

    upgrade(database, backups=tmp_path / "backups", now=now)
    after = digests_of(database)
    assert {name: after[name].rows for name in before} == {name: digest.rows for name, digest in before.items()}

    (file,) = (tmp_path / "backups").iterdir()
    assert file.name == f"before-{revision}-20250601T120000Z.sqlite3"
    saved = open_saved(file)
    assert digests_of(saved) == before
    saved.close()
    again = opened(f"sqlite:///{shutil.copy(file, tmp_path / 'again.sqlite3')}")
    with again.read() as session:
        assert stored_revision(session.connection()) == revision
    upgrade(again)
    restored = digests_of(again)
    assert {name: restored[name] for name in before} == {name: after[name] for name in before}


def test_an_old_database_comes_back_into_postgresql(
    filled: Make, opened: Any, digests_of: Any, blank_postgres: str, tmp_path: Path
) -> None:
    old = filled(f"sqlite:///{tmp_path}/old.sqlite3", "0002")
    target = opened(blank_postgres)
    with filling(target) as empty:
        assert copy_rows(old, empty).tables == digests_of(old)
    with target.read() as session:
        assert stored_revision(session.connection()) == "0002"
    assert digests_of(target) == digests_of(old)
    upgrade(target)


def test_nothing_is_saved_of_a_new_database_and_of_one_that_is_up_to_date(
    sqlite_database: Database, opened: Any, count_queries: Any, tmp_path: Path, now: datetime
) -> None:
    new = opened(f"sqlite:///{tmp_path}/new.sqlite3")
    upgrade(new, backups=tmp_path / "backups", now=now)
    assert "segments" in inspect(new.engine).get_table_names()
    with count_queries(sqlite_database) as statements:
        upgrade(sqlite_database, backups=tmp_path / "backups", now=now)
    assert len(statements) <= 4, "a start asks for the tables' form and nothing else"
    assert not (tmp_path / "backups").exists()


def test_an_upgrade_that_can_not_be_saved_does_not_begin(filled: Make, tmp_path: Path, now: datetime) -> None:
    database = filled(f"sqlite:///{tmp_path}/old.sqlite3", "0001")
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        upgrade(database, backups=tmp_path / "file" / "backups", now=now)
    with database.read() as session:
        assert stored_revision(session.connection()) == "0001"


def test_a_database_of_a_newer_version_is_not_saved(sqlite_database: Database, tmp_path: Path, now: datetime) -> None:
    with sqlite_database.write() as session:
        session.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(Unavailable, match="9999"):
        upgrade(sqlite_database, backups=tmp_path / "backups", now=now)
    assert not (tmp_path / "backups").exists()
