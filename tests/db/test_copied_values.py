"""Values of every kind that a column can have are the same on both kinds of databases, or are refused by name."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from sqlalchemy import JSON, Boolean, Column, Float, Integer, LargeBinary, MetaData, Table, Text, delete, select

from app.db.copying.digests import Digesting, digest_of, require_same
from app.db.copying.reading import read_rows
from app.db.copying.tables import CopiedTable, tables_of
from app.db.copying.targets import Target
from app.db.copying.writing import write_rows
from app.db.models import UtcDateTime
from app.db.session import Database, open_database
from app.errors import InvalidInput, Unavailable

ODD = Table(
    "odd",
    MetaData(),
    Column("name", Text, primary_key=True),
    Column("number", Integer, nullable=False),
    Column("real", Float, nullable=False),
    Column("maybe", Float),
    Column("content", LargeBinary),
    Column("document", JSON(none_as_null=True)),
    Column("flag", Boolean),
    Column("time", UtcDateTime()),
)

TEXTS = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=20)
FLOATS = st.floats(allow_nan=False)
DOCUMENTS = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=6,
).filter(lambda document: isinstance(document, list | dict))
ROWS = st.lists(
    st.fixed_dictionaries(
        {
            "name": TEXTS,
            "number": st.integers(-(2**31), 2**31 - 1),
            "real": FLOATS,
            "maybe": st.none() | FLOATS,
            "content": st.none() | st.binary(max_size=40),
            "document": st.none() | DOCUMENTS,
            "flag": st.none() | st.booleans(),
            "time": st.none() | st.datetimes(timezones=st.just(UTC)),
        }
    ),
    max_size=8,
    unique_by=lambda row: str(row["name"]),
)


@pytest.fixture(scope="module")
def pair(
    empty_postgres: Callable[[], str], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[Database, Database]]:
    """A PostgreSQL and an SQLite database with the table, empty."""
    databases = (
        open_database(empty_postgres()),
        open_database(f"sqlite:///{tmp_path_factory.mktemp('odd')}/odd.sqlite3"),
    )
    for database in databases:
        with Target(database).transaction() as connection:
            ODD.create(connection)
    yield databases
    for database in databases:
        with Target(database).transaction() as connection:
            ODD.drop(connection)
        database.close()


def odd_of(database: Database) -> CopiedTable:
    with database.read() as session:
        return next(table for table in tables_of(session.connection()) if table.name == "odd")


def put(database: Database, rows: list[dict[str, Any]]) -> None:
    with Target(database).transaction() as connection:
        connection.execute(delete(ODD))
        if rows:
            connection.execute(ODD.insert(), rows)


def stored(database: Database) -> list[tuple[Any, ...]]:
    with database.read() as session:
        return sorted(
            tuple(row) for row in session.execute(select(ODD.c.name, *(c for c in ODD.c if c.name != "document")))
        )


def move(source: Database, target: Database) -> None:
    put(target, [])
    table = odd_of(source)
    with source.read() as session:
        with closing(read_rows(session.connection(), table)) as batches, Target(target).in_one() as filled:
            digesting = Digesting(batches)
            write_rows(filled, table, digesting)
        with target.read() as other:
            require_same(session.connection(), other.connection(), table, digesting.digest)


@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(rows=ROWS, to_postgres=st.booleans())
@example(rows=[], to_postgres=True)
def test_values_arrive_as_they_were(pair: tuple[Database, Database], rows: list[Any], to_postgres: bool) -> None:
    postgres, sqlite = pair
    source, target = (sqlite, postgres) if to_postgres else pair
    put(source, rows)
    move(source, target)
    assert stored(target) == stored(source)
    documents = {row["name"]: row["document"] for row in rows}
    with target.read() as session:
        found = {row.name: row.document for row in session.execute(select(ODD.c.name, ODD.c.document))}
    assert json.dumps(found, sort_keys=True) == json.dumps(documents, sort_keys=True)


ROW: dict[str, Any] = {
    "name": "row",
    "number": 1,
    "real": 0.5,
    "maybe": None,
    "content": b"",
    "document": {},
    "flag": True,
    "time": datetime(2025, 6, 1, tzinfo=UTC),
}


@pytest.mark.parametrize(
    ("column", "value", "where", "reason"),
    [
        ("number", 2**40, "odd, name row, number", "out of range"),
        ("document", {"NaN": float("nan")}, "odd, name row, document", "invalid input syntax for type json"),
        ("name", "a\0b", "odd, name a\0b", "NUL"),
    ],
)
def test_what_postgresql_can_not_hold_is_named(
    pair: tuple[Database, Database], column: str, value: Any, where: str, reason: str
) -> None:
    postgres, sqlite = pair
    others = [{**ROW, "name": f"{number}"} for number in range(100)]
    put(sqlite, [*others, {**ROW, column: value}])
    with pytest.raises(InvalidInput, match=f"can't hold it: .*{reason}") as caught:
        move(sqlite, postgres)
    assert caught.value.where == where


@pytest.mark.parametrize("column", ["real", "maybe"])
def test_what_sqlite_can_not_hold_is_named(pair: tuple[Database, Database], column: str) -> None:
    postgres, sqlite = pair
    put(postgres, [{**ROW, "name": "before"}, {**ROW, column: float("nan")}])
    with pytest.raises(InvalidInput, match="NaN") as caught:
        move(postgres, sqlite)
    assert caught.value.where == f"odd, name row, {column}"


def test_a_zero_has_no_sign(pair: tuple[Database, Database]) -> None:
    postgres, sqlite = pair
    put(postgres, [{**ROW, "real": -0.0}])
    move(postgres, sqlite)


def test_times_that_sql_wrote_shorter_are_the_same_times(pair: tuple[Database, Database]) -> None:
    postgres, sqlite = pair
    put(sqlite, [ROW, {**ROW, "name": "day"}])
    with Target(sqlite).transaction() as connection:
        connection.exec_driver_sql("UPDATE odd SET time = '2025-06-01 00:00:00' WHERE name = 'row'")
        connection.exec_driver_sql("UPDATE odd SET time = '2025-06-01' WHERE name = 'day'")
    move(sqlite, postgres)
    assert {row[-1] for row in stored(postgres)} == {ROW["time"]}


def test_batches_of_any_size_have_one_digest(pair: tuple[Database, Database], monkeypatch: pytest.MonkeyPatch) -> None:
    _, sqlite = pair
    put(sqlite, [{**ROW, "name": f"{number:04}", "content": bytes(number)} for number in range(300)])
    table = odd_of(sqlite)
    with sqlite.read() as session:
        whole = digest_of(session.connection(), table)
        monkeypatch.setattr("app.db.copying.reading.BATCH_BYTES", 2000)
        sizes = [len(batch.rows) for batch in read_rows(session.connection(), table)]
        assert digest_of(session.connection(), table) == whole
    assert whole.rows == sum(sizes) == 300
    assert max(sizes[1:]) < 30, "rows that are long come in batches of few"


def test_the_first_row_that_differs_is_named(pair: tuple[Database, Database]) -> None:
    postgres, sqlite = pair
    put(sqlite, [{**ROW, "name": f"{number:04}"} for number in range(300)])
    move(sqlite, postgres)
    table = odd_of(sqlite)

    def difference() -> str | None:
        with sqlite.read() as one, postgres.read() as other:
            expected = digest_of(one.connection(), table)
            with pytest.raises(Unavailable) as caught:
                require_same(one.connection(), other.connection(), table, expected)
        return caught.value.where

    with Target(postgres).transaction() as connection:
        connection.execute(ODD.update().where(ODD.c.name == "0250").values(real=0.25))
    assert difference() == "odd, name 0250, real"
    with Target(postgres).transaction() as connection:
        connection.execute(delete(ODD).where(ODD.c.name == "0123"))
    assert difference() == "odd, name 0123"


def test_a_key_of_several_columns_is_told_whole(pair: tuple[Database, Database]) -> None:
    table = odd_of(pair[1])
    double = replace(table, key=table.columns[2:4])
    assert double.numbering is None
    assert double.key_of(tuple(range(8))) == f"{table.columns[2].name} 2, {table.columns[3].name} 3"
