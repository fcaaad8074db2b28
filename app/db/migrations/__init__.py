"""The tables' history (Alembic), run from inside the package: no ini file, no working directory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from sqlalchemy import Engine, text

# any number that no other program locks in the same database
ADVISORY_LOCK = 7_316_540_021


def configuration() -> Config:
    """Return Alembic's configuration of these migrations."""
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    return config


def run_upgrade(engine: Engine, revision: str = "head") -> None:
    """Upgrade in one transaction, one process at a time."""
    config = configuration()
    options: dict[str, Any] = {}
    if engine.dialect.name == "sqlite":
        # SQLite alters a table by dropping and copying it, which with foreign keys on would delete what names its rows
        options = {"sqlite_begin": "IMMEDIATE", "sqlite_foreign_keys": "OFF"}
    with engine.execution_options(**options).begin() as connection:
        if engine.dialect.name == "postgresql":
            connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": ADVISORY_LOCK})
        config.attributes["connection"] = connection
        command.upgrade(config, revision)
