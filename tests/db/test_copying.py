"""A copy of a database, on either kind, is the same database."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from typing import Any

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import Table, insert, inspect, select, text, update

from app.db.copying.copy import CopiedDatabase, copy_rows
from app.db.copying.targets import filling
from app.db.locks import held
from app.db.models import Base, Blob, Dataset, Image
from app.db.session import Database, upgrade
from app.errors import Conflict, InvalidInput, NotFound, Unavailable

Open = Callable[[str], Database]


def copied(source: Database, target: Database) -> CopiedDatabase:
    with filling(target) as filled:
        return copy_rows(source, filled)


def stopped_halfway(source: Database, target: Database) -> None:
    with filling(target) as filled:
        copy_rows(source, filled)
        raise KeyboardInterrupt


def everything(database: Database) -> dict[str, list[tuple[Any, ...]]]:
    """Read all tables as the models do, which the copier doesn't."""
    with database.read() as session:
        return {
            name: [tuple(row) for row in session.execute(select(table).order_by(*table.primary_key.columns))]
            for name, table in Base.metadata.tables.items()
        }


def test_sqlite_to_postgresql_to_another_and_back(
    full_sqlite: Database, opened: Open, tmp_path: Any, blank_postgres: str, other_postgres: str
) -> None:
    before = everything(full_sqlite)
    assert all(before.values())
    addresses = (blank_postgres, other_postgres, f"sqlite:///{tmp_path}/back.sqlite3")
    first, second, back = (opened(address) for address in addresses)
    digests = [copied(full_sqlite, first), copied(first, second), copied(second, back)]
    assert digests[0] == digests[1] == digests[2]
    for database in (first, back):
        assert everything(database) == before
        assert_form(database)
        assert next_ids(database) == {name: given + 1 for name, given in largest_given(full_sqlite).items()}
        assert_triggers_at_work(database)


def assert_form(database: Database) -> None:
    """Indexes and keys are those of the models."""
    with database.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_server_default": True})
        assert compare_metadata(context, Base.metadata) == []
    inspector = inspect(database.engine)
    for table in Base.metadata.sorted_tables:
        stored = inspector.get_foreign_keys(table.name)
        declared = {(tuple(key.column_keys), key.referred_table.name) for key in table.foreign_key_constraints}
        assert {(tuple(key["constrained_columns"]), key["referred_table"]) for key in stored} == declared, table.name


def never_reused() -> list[Table]:
    return [table for table in Base.metadata.sorted_tables if table.dialect_options["sqlite"]["autoincrement"]]


def largest_given(source: Database) -> dict[str, int]:
    with source.read() as session:
        given = {row.name: row.seq for row in session.execute(text("SELECT name, seq FROM sqlite_sequence"))}
    return {table.name: given[table.name] for table in never_reused()}


def next_ids(database: Database) -> dict[str, int]:
    """Return the id that each table would give next."""
    found = {}
    with database.read() as session:
        for table in never_reused():
            if database.is_sqlite:
                statement = text("SELECT seq + 1 FROM sqlite_sequence WHERE name = :name").bindparams(name=table.name)
            else:
                sequence = session.scalar(text(f"SELECT pg_get_serial_sequence('{table.name}', 'id')"))
                statement = text(f"SELECT last_value + 1 FROM {sequence} WHERE is_called")
            found[table.name] = session.scalar(statement)
    return found


def assert_triggers_at_work(database: Database) -> None:
    """Counts beside images change with them."""
    with database.write() as session:
        before = session.scalar(text("SELECT sum(images) FROM image_tallies"))
        session.execute(text("DELETE FROM images WHERE id = (SELECT max(id) FROM images)"))
        assert session.scalar(text("SELECT sum(images) FROM image_tallies")) == before - 1
        session.rollback()


def test_a_target_with_rows_is_refused_and_stays_as_it_is(database: Database, now: datetime) -> None:
    with database.write() as session:
        session.execute(insert(Blob).values(sha256="a", size=1, media_type="x", created_at=now))
    with pytest.raises(Conflict, match="isn't empty: it has 1 rows in blobs"), filling(database):
        raise AssertionError
    upgrade(database)
    with database.read() as session:
        assert session.scalars(select(Blob.sha256)).all() == ["a"]


@pytest.mark.parametrize(("purpose", "reason"), [("copy", "another process"), ("dispatcher", "a server works with")])
def test_a_target_that_somebody_works_with_is_refused(blank_url: str, opened: Open, purpose: Any, reason: str) -> None:
    target = opened(blank_url)
    with held(target, purpose) as ours:
        assert ours
        with pytest.raises(Conflict, match=reason), filling(opened(blank_url)):
            raise AssertionError
    with filling(target):
        pass


def test_what_was_left_unfinished_is_refused_and_begun_again(
    full_sqlite: Database, opened: Open, blank_url: str, tmp_path: Any
) -> None:
    target = opened(blank_url)
    with pytest.raises(KeyboardInterrupt):
        stopped_halfway(full_sqlite, target)
    with pytest.raises(Unavailable, match="hasn't ended"):
        upgrade(target)
    with pytest.raises(Unavailable, match="hasn't ended"):
        copied(target, opened(f"sqlite:///{tmp_path}/third.sqlite3"))
    copied(full_sqlite, target)
    upgrade(target)
    assert everything(target) == everything(full_sqlite)


def test_no_installation_and_one_of_a_newer_version_are_told(
    sqlite_database: Database, opened: Open, tmp_path: Any
) -> None:
    target = opened(f"sqlite:///{tmp_path}/target.sqlite3")
    with pytest.raises(NotFound, match="no installation"):
        copied(opened(f"sqlite:///{tmp_path}/nothing.sqlite3"), target)
    with sqlite_database.write() as session:
        session.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(Conflict, match="newer version"):
        copied(sqlite_database, target)


def test_on_postgresql_all_rows_come_or_none(full_sqlite: Database, opened: Open, blank_postgres: str) -> None:
    with full_sqlite.write() as session:
        session.execute(update(Dataset).where(Dataset.id == 3).values(description="a\0b"))
    target = opened(blank_postgres)
    with pytest.raises(InvalidInput, match="NUL") as caught:
        copied(full_sqlite, target)
    assert caught.value.where == "datasets, id 3"
    assert inspect(target.engine).get_table_names() == ["unfinished_copy"]


def test_a_row_that_names_none_is_told(full_sqlite: Database, opened: Open, blank_url: str) -> None:
    engine = full_sqlite.engine.execution_options(sqlite_begin="IMMEDIATE", sqlite_foreign_keys="OFF")
    with engine.begin() as connection:
        connection.execute(update(Image).where(Image.id == 3).values(camera_id=99))
    with pytest.raises(InvalidInput, match="cameras"):
        copied(full_sqlite, opened(blank_url))


def test_other_programs_tables_stay(sqlite_database: Database, opened: Open, blank_postgres: str) -> None:
    target = opened(blank_postgres)
    with target.engine.begin() as connection:
        connection.execute(text("CREATE TABLE theirs (id integer primary key)"))
        connection.execute(text("INSERT INTO theirs VALUES (1)"))
    assert "theirs" not in copied(sqlite_database, target).tables
    with target.engine.begin() as connection:
        assert connection.scalar(text("SELECT count(*) FROM theirs")) == 1
