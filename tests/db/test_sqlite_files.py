"""Databases saved as one file."""

from __future__ import annotations

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import select, text

from app.db.copying.copy import copy_rows
from app.db.models import Dataset
from app.db.session import Database
from app.db.sqlite_files import copy_file, filled_file, open_saved
from app.errors import Conflict, NotFound, Unavailable


def names(database: Database) -> list[str]:
    with database.read() as session:
        return list(session.scalars(select(Dataset.name)))


def test_what_was_written_a_moment_ago_is_in_the_copy(full_sqlite: Database, tmp_path: Path) -> None:
    with full_sqlite.write() as session:
        session.execute(text("UPDATE datasets SET name = 'new' WHERE id = 1"))
    assert full_sqlite.engine.url.database
    copy_file(Path(full_sqlite.engine.url.database), tmp_path / "copy.sqlite3")
    saved = open_saved(tmp_path / "copy.sqlite3")
    assert "new" in names(saved)
    saved.close()


@pytest.mark.parametrize("well", [True, False])
def test_a_file_is_whole_or_not_there_and_nothing_lies_beside_it(
    full_sqlite: Database, tmp_path: Path, well: bool
) -> None:
    place = tmp_path / "saved"
    place.mkdir()

    def save() -> None:
        with filled_file(place / "a.sqlite3") as target:
            copy_rows(full_sqlite, target)
            if not well:
                raise KeyboardInterrupt

    if not well:
        with pytest.raises(KeyboardInterrupt):
            save()
        assert not list(place.iterdir())
        return
    save()
    assert [path.name for path in place.iterdir()] == ["a.sqlite3"]
    place.chmod(0o555)
    saved = open_saved(place / "a.sqlite3")
    assert names(saved) == names(full_sqlite)
    saved.close()
    place.chmod(0o755)
    assert [path.name for path in place.iterdir()] == ["a.sqlite3"], "reading leaves no trace"


def test_a_database_in_use_is_no_saved_one(full_sqlite: Database, tmp_path: Path) -> None:
    with pytest.raises(NotFound, match="no such file"):
        open_saved(tmp_path / "none")
    with full_sqlite.write() as session:
        session.execute(text("UPDATE datasets SET name = 'new' WHERE id = 1"))
    with pytest.raises(Conflict, match="write-ahead log"):
        open_saved(Path(str(full_sqlite.engine.url.database)))


def test_no_room_is_told(full_sqlite: Database, tmp_path: Path) -> None:
    source = tmp_path / "source.sqlite3"
    shutil.copy(str(full_sqlite.engine.url.database), source)
    with closing(sqlite3.connect(source)) as connection:
        connection.execute("PRAGMA journal_mode = DELETE")
    source.write_bytes(source.read_bytes()[:5000])
    with pytest.raises(Unavailable, match="can't be saved"):
        copy_file(source, tmp_path / "copy.sqlite3")
    assert not (tmp_path / "copy.sqlite3").exists()
