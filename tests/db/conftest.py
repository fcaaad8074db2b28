"""Databases at any released revision, with rows in every table that it has."""

from __future__ import annotations

import random
import re
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import psycopg
import pytest
from sqlalchemy import (
    JSON,
    Boolean,
    Column,
    Connection,
    DateTime,
    Float,
    Integer,
    LargeBinary,
    MetaData,
    Table,
    inspect,
    make_url,
    text,
)

from app.db.copying.digests import TableDigest, digest_of
from app.db.copying.tables import tables_of
from app.db.migrations import VERSION_TABLE, run_upgrade
from app.db.session import Database, open_database

ROWS = 7
GIVEN_AND_GONE = 5
"""How many ids each table has given away beyond those that its rows have."""

TEXTS = ("", "a", "é—漢字", "😀🏙", "tab\tline\nback\\slash \\N \\.", "'\";--", "\u2028\x01", "x" * 9000)
TIMES = (
    datetime(2025, 6, 1, 12, 0, tzinfo=UTC),
    datetime(1970, 1, 1, 0, 0, 0, 1, tzinfo=UTC),
    datetime(9999, 12, 31, 23, 59, 59, 999999, tzinfo=UTC),
    datetime(2024, 2, 29, 23, 59, 60 - 1, 500000, tzinfo=UTC),
)
FLOATS = (0.0, 0.1, -1.5, 1e308, 5e-324, 2.0**53 + 2, 1 / 3, float("inf"), float("-inf"))
INTEGERS = (0, 1, -1, 2**31 - 1, -(2**31))
JSONS = ({}, [], {"é": [1.5, None, True, "😀\u2028"], "n": {"big": 2**70, "small": 5e-324}}, [[]], ["\\N"])
BYTES = (b"", b"\x00", bytes(range(256)), b"\\x41")


def fill(connection: Connection, seed: int) -> None:
    """Put rows into every table, whatever tables there are: each column, key and constraint is read from the database.

    Row k of a table refers to row k of others, so that what must be unique is. Some references go in circles: those
    that may be empty are filled in afterwards.
    """
    stored = MetaData()
    stored.reflect(connection)
    tables = [table for name, table in stored.tables.items() if name not in (VERSION_TABLE, "installations")]
    with triggers_asleep(connection, tables):
        _fill(connection, tables, seed)


def _fill(connection: Connection, tables: list[Table], seed: int) -> None:
    for column in (column for table in tables for column in table.columns):
        if isinstance(column.type, JSON):
            column.type.none_as_null = True
    chance = random.Random(seed)
    keys: dict[str, list[Any]] = {}
    later: list[tuple[Table, Column[Any]]] = []
    while waiting := [table for table in tables if table.name not in keys]:
        table = next(each for each in waiting if all(key in keys for key in _needed(each)))
        columns = [column for column in table.columns if not _filled_later(column, keys)]
        later += [(table, column) for column in table.columns if _filled_later(column, keys)]
        allowed = _allowed(connection, table)
        keys[table.name] = [
            _insert(connection, table, columns, number, chance, allowed, keys) for number in range(ROWS)
        ]
    for table, column in later:
        (key,) = table.primary_key.columns
        (foreign,) = column.foreign_keys
        for number, value in enumerate(keys[table.name]):
            other = keys[foreign.column.table.name][number - 1]
            connection.execute(table.update().where(key == value).values({column.name: other}))
    for table in tables:
        _give_away(connection, table)


@contextmanager
def triggers_asleep(connection: Connection, tables: list[Table]) -> Iterator[None]:
    """Let nothing but the block write rows."""
    if connection.dialect.name == "sqlite":
        triggers = connection.execute(text("SELECT name, sql FROM sqlite_master WHERE type = 'trigger'")).all()
        before = [f"DROP TRIGGER {name}" for name, _ in triggers]
        after = [sql for _, sql in triggers]
    else:
        before = [f"ALTER TABLE {table.name} DISABLE TRIGGER USER" for table in tables]
        after = [f"ALTER TABLE {table.name} ENABLE TRIGGER USER" for table in tables]
    for statement in before:
        connection.exec_driver_sql(statement)
    yield
    for statement in after:
        connection.exec_driver_sql(statement)


def _needed(table: Table) -> Iterator[str]:
    for column in table.columns:
        for key in column.foreign_keys:
            if not column.nullable:
                yield key.column.table.name


def _filled_later(column: Column[Any], keys: dict[str, list[Any]]) -> bool:
    return any(column.nullable and key.column.table.name not in keys for key in column.foreign_keys)


def _allowed(connection: Connection, table: Table) -> dict[str, list[str]]:
    """What the columns may hold that may hold a few words only."""
    allowed = {}
    for check in inspect(connection).get_check_constraints(table.name):
        name = re.search(r"\w+", check["sqltext"])
        words = re.findall(r"'([^']*)'", check["sqltext"])
        if name and words:
            allowed[name[0]] = words
    return allowed


def _insert(
    connection: Connection,
    table: Table,
    columns: list[Column[Any]],
    number: int,
    chance: random.Random,
    allowed: dict[str, list[str]],
    keys: dict[str, list[Any]],
) -> Any:
    values: dict[str, Any] = {}
    for column in columns:
        foreign = next(iter(column.foreign_keys), None)
        numbered = column.primary_key and len(table.primary_key.columns) == 1 and isinstance(column.type, Integer)
        if foreign is not None:
            values[column.name] = keys[foreign.column.table.name][number]
        elif not numbered:
            left_out = column.nullable and chance.random() < 0.3
            words = allowed.get(column.name)
            values[column.name] = None if left_out else _value(connection, column, number, chance, words)
    key = connection.execute(table.insert(), values).inserted_primary_key
    return None if key is None else key[0]


def _value(
    connection: Connection, column: Column[Any], number: int, chance: random.Random, words: list[str] | None
) -> Any:
    if words is not None:
        return words[number % len(words)]
    kind = column.type
    if isinstance(kind, Boolean):
        return chance.random() < 0.5
    if isinstance(kind, Integer):
        # of those that must be unique, as a split's version's number, each has its own
        return INTEGERS[number % len(INTEGERS)] if column.nullable else number
    if isinstance(kind, Float):
        return chance.choice([*FLOATS, chance.uniform(-1e6, 1e6)])
    if isinstance(kind, JSON):
        return chance.choice(JSONS)
    if isinstance(kind, DateTime):
        time = chance.choice(TIMES)
        return time.replace(tzinfo=None) if connection.dialect.name == "sqlite" else time
    if isinstance(kind, LargeBinary):
        return chance.choice([*BYTES, chance.randbytes(300)])
    return (f"{number} " + TEXTS[number % len(TEXTS)])[: getattr(kind, "length", None) or 20_000]


def _give_away(connection: Connection, table: Table) -> None:
    """Let a table have given ids to rows that are gone."""
    keys = list(table.primary_key.columns)
    if connection.dialect.name == "sqlite":
        if len(keys) == 1 and connection.execute(text("SELECT count(*) FROM sqlite_sequence")).scalar():
            given = text("UPDATE sqlite_sequence SET seq = seq + :more WHERE name = :name")
            connection.execute(given, {"more": GIVEN_AND_GONE, "name": table.name})
        return
    named = {"table": table.name, "column": keys[0].name}
    sequence = connection.execute(text("SELECT pg_get_serial_sequence(:table, :column)"), named).scalar()
    if len(keys) == 1 and sequence is not None:
        for _ in range(GIVEN_AND_GONE):
            connection.execute(text("SELECT nextval(:sequence)"), {"sequence": sequence})


def digests(database: Database) -> dict[str, TableDigest]:
    """Return the digest of each table of a database."""
    with database.read() as session:
        connection = session.connection()
        return {table.name: digest_of(connection, table) for table in tables_of(connection)}


@contextmanager
def writing(database: Database) -> Iterator[Connection]:
    """Give a connection that writes."""
    options = {"sqlite_begin": "IMMEDIATE"} if database.is_sqlite else {}
    with database.engine.execution_options(**options).begin() as connection:
        yield connection


@pytest.fixture
def blank_postgres(empty_postgres: Callable[[], str]) -> str:
    """The address of a PostgreSQL database without tables, of this process."""
    address = empty_postgres()
    with psycopg.connect(address, autocommit=True) as connection:
        connection.execute("DROP SCHEMA public CASCADE")
        connection.execute("CREATE SCHEMA public")
    return address


@pytest.fixture
def other_postgres(postgres_server: str) -> Iterator[str]:
    """The address of a second one, without tables."""
    name = "clearlines_other"
    with psycopg.connect(postgres_server, autocommit=True) as connection:
        connection.execute(f"DROP DATABASE IF EXISTS {name} WITH (FORCE)".encode())
        connection.execute(f"CREATE DATABASE {name}".encode())
        yield make_url(postgres_server).set(database=name).render_as_string(hide_password=False)
        connection.execute(f"DROP DATABASE {name} WITH (FORCE)".encode())


@pytest.fixture(params=["sqlite", "postgresql"])
def blank_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The address of a database without tables."""
    if request.param == "postgresql":
        return request.getfixturevalue("blank_postgres")
    return f"sqlite:///{tmp_path}/blank.sqlite3"


@pytest.fixture
def opened() -> Iterator[Callable[[str], Database]]:
    """Open databases that are closed at the end."""
    databases: list[Database] = []

    def open_one(address: str) -> Database:
        databases.append(open_database(address))
        return databases[-1]

    yield open_one
    for database in databases:
        database.close()


@pytest.fixture
def filled(opened: Callable[[str], Database]) -> Callable[..., Database]:
    """Return what makes a database of a revision, with rows in every table."""

    def make(address: str, revision: str = "head", *, seed: int = 0) -> Database:
        database = opened(address)
        run_upgrade(database.engine, revision)
        with writing(database) as connection:
            fill(connection, seed)
        return database

    return make


@pytest.fixture(scope="session")
def full_sqlite_file(sqlite_template: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A SQLite file with rows in every table, to copy."""
    path = tmp_path_factory.mktemp("full") / "full.sqlite3"
    shutil.copy(sqlite_template, path)
    database = open_database(f"sqlite:///{path}")
    with writing(database) as connection:
        fill(connection, seed=1)
    database.close()
    return path


@pytest.fixture
def full_sqlite(full_sqlite_file: Path, opened: Callable[[str], Database], tmp_path: Path) -> Database:
    """A SQLite database of this version with rows in every table."""
    path = tmp_path / "full.sqlite3"
    shutil.copy(full_sqlite_file, path)
    return opened(f"sqlite:///{path}")


@pytest.fixture
def digests_of() -> Callable[[Database], dict[str, TableDigest]]:
    """Return what gives the digest of each table of a database."""
    return digests
