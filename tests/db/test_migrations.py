"""The migrations and the models describe the same tables."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import inspect, select, text

from app.db.migrations import configuration, run_upgrade
from app.db.models import Base, Camera, Dataset
from app.db.session import Database, open_database, upgrade


def test_models_and_migrations_agree(database: Database) -> None:
    with database.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_server_default": True})
        assert compare_metadata(context, Base.metadata) == []


def test_foreign_keys_agree(database: Database) -> None:
    inspector = inspect(database.engine)
    for table in Base.metadata.sorted_tables:
        declared = {
            (tuple(key.column_keys), key.referred_table.name, key.ondelete) for key in table.foreign_key_constraints
        }
        stored = {
            (tuple(key["constrained_columns"]), key["referred_table"], key.get("options", {}).get("ondelete"))
            for key in inspector.get_foreign_keys(table.name)
        }
        assert stored == declared, table.name


def test_upgrade_again_changes_nothing(database: Database) -> None:
    before = inspect(database.engine).get_table_names()
    upgrade(database)
    assert inspect(database.engine).get_table_names() == before


def test_downgrade_removes_every_table(database: Database) -> None:
    config = configuration()
    options = {"sqlite_begin": "IMMEDIATE"} if database.is_sqlite else {}
    with database.engine.execution_options(**options).begin() as connection:
        config.attributes["connection"] = connection
        command.downgrade(config, "base")
    assert inspect(database.engine).get_table_names() == ["alembic_version"]


def test_rows_of_the_first_version_stay(tmp_path: Path) -> None:
    database = open_database(f"sqlite:///{tmp_path}/old.sqlite3")
    run_upgrade(database.engine, "0001")
    statements = (
        "INSERT INTO datasets (slug, name, created_at) VALUES ('street', 'Street', '2025-01-01')",
        "INSERT INTO cameras (dataset_id, name, width, height, created_at) VALUES (1, 'c', 4, 3, '2025-01-01')",
    )
    with database.engine.execution_options(sqlite_begin="IMMEDIATE").begin() as connection:
        for statement in statements:
            connection.execute(text(statement))
    upgrade(database)
    with database.read() as session:
        dataset = session.scalars(select(Dataset)).one()
        assert (dataset.slug, dataset.licence) == ("street", None)
        assert session.scalars(select(Camera.name)).all() == ["c"]
    database.close()


def test_upgrade_needs_no_working_directory(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    database = open_database(f"sqlite:///{tmp_path}/new/folder/data.sqlite3")
    upgrade(database)
    assert "segments" in inspect(database.engine).get_table_names()
    database.close()


def test_several_servers_that_start_at_once(tmp_path: Path) -> None:
    together = threading.Barrier(6)

    def start(_number: int) -> list[str]:
        together.wait()
        database = open_database(f"sqlite:///{tmp_path}/new.sqlite3")
        upgrade(database)
        names = inspect(database.engine).get_table_names()
        database.close()
        return names

    with ThreadPoolExecutor(6) as pool:
        assert {tuple(names) for names in pool.map(start, range(6))} == {
            tuple(sorted([*Base.metadata.tables, "alembic_version"]))
        }
