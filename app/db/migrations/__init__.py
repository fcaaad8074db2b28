"""The tables' history (Alembic), run from inside the package: no ini file, no working directory."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine, column, inspect, select, table, text

# any number that no other program locks in the same database
ADVISORY_LOCK = 7_316_540_021
VERSION_TABLE = "alembic_version"


def configuration() -> Config:
    """Return Alembic's configuration of these migrations."""
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    return config


def revisions() -> tuple[str, ...]:
    """Return the names of all forms that the tables ever had, the first one first."""
    scripts = ScriptDirectory.from_config(configuration()).walk_revisions()
    return tuple(script.revision for script in scripts)[::-1]


def stored_revision(connection: Connection) -> str | None:
    """Return the form that a database's tables have; None when it has no tables of ours."""
    if not inspect(connection).has_table(VERSION_TABLE):
        return None
    return connection.execute(select(column("version_num")).select_from(table(VERSION_TABLE))).scalar()


def run_upgrade(
    engine: Engine, revision: str = "head", *, saved: Callable[[str], AbstractContextManager[object]] | None = None
) -> None:
    """Upgrade in one transaction, one process at a time.

    Args:
        engine: Of the database.
        revision: The form to bring the tables to.
        saved: Called with the form that they have, not where there are none yet; they are changed inside what it gives.
    """
    options: dict[str, Any] = {}
    if engine.dialect.name == "sqlite":
        # SQLite alters a table by dropping and copying it, which with foreign keys on would delete what names its rows
        options = {"sqlite_begin": "IMMEDIATE", "sqlite_foreign_keys": "OFF"}
    with engine.execution_options(**options).begin() as connection:
        if engine.dialect.name == "postgresql":
            connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": ADVISORY_LOCK})
        stored = stored_revision(connection)
        known = revisions()
        if revision == "head" and stored == known[-1]:
            return
        with saved(stored) if saved is not None and stored in known else nullcontext():
            upgrade_within(connection, revision)


def upgrade_within(connection: Connection, revision: str) -> None:
    """Upgrade in the transaction of a connection; see ``run_upgrade`` for what it needs on SQLite."""
    config = configuration()
    config.attributes["connection"] = connection
    command.upgrade(config, revision)
