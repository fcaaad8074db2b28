"""The migrations and the models describe the same tables."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from pathlib import Path

from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import inspect, select, text

from app.db.migrations import configuration, run_upgrade
from app.db.models import Base, Camera, Dataset, Decision, SegmentState
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


def test_verdicts_of_the_second_version_stay(tmp_path: Path) -> None:
    database = open_database(f"sqlite:///{tmp_path}/old.sqlite3")
    run_upgrade(database.engine, "0002")
    at = "'2025-01-01'"
    decision = (
        "INSERT INTO decisions (id, image_id, segment_id, verdict, previous, kind, client_id, group_id, created_at)"
    )
    statements = (
        f"INSERT INTO datasets (slug, name, created_at) VALUES ('street', 'Street', {at})",
        f"INSERT INTO cameras (dataset_id, name, width, height, created_at) VALUES (1, 'c', 4, 3, {at})",
        f"INSERT INTO blobs (sha256, size, media_type, created_at) VALUES ('a', 1, 'image/png', {at})",
        "INSERT INTO images (dataset_id, name, file_name, sha256, width, height, bits, camera_id, revision,"
        " n_candidates, n_keep, n_reject, n_ambiguous, created_at)"
        f" VALUES (1, 'i', 'i.png', 'a', 4, 3, 8, 1, 0, 1, 1, 0, 0, {at})",
        "INSERT INTO segments (image_id, ordinal, n_points, points, x0, y0, x1, y1, length, origin)"
        " VALUES (1, 0, 0, '', 0, 0, 1, 1, 1, 'import')",
        f"{decision} VALUES (1, 1, 1, 'keep', 'undecided', 'judge', 'c1', 'g1', {at})",
        f"{decision} VALUES (7, 1, 1, 'reject', 'keep', 'judge', 'c7', 'g7', {at})",
        "INSERT INTO segment_states (segment_id, verdict, decision_id) VALUES (1, 'keep', 1)",
        "DELETE FROM decisions WHERE id = 7",
    )
    with database.engine.execution_options(sqlite_begin="IMMEDIATE").begin() as connection:
        for statement in statements:
            connection.execute(text(statement))
    upgrade(database)
    with database.write() as session:
        assert session.scalars(select(Decision.client_id)).all() == ["c1"]
        state = session.scalars(select(SegmentState)).one()
        assert (state.verdict, state.decision_id, state.reason) == ("keep", 1, None)
        values = {
            "image_id": 1,
            "segment_id": 1,
            "verdict": "reject",
            "previous": "keep",
            "client_id": "c",
            "group_id": "g",
        }
        session.add(Decision(**values, kind="accept", suggestion=0.1, created_at=datetime(2025, 1, 2, tzinfo=UTC)))
        session.flush()
        assert session.scalars(select(Decision.id)).all() == [1, 8], "ids given away once were given away again"
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
