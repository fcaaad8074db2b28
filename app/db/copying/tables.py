"""What tables a database has, as far as copying them needs to know; read from the database itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

from sqlalchemy import Connection, TableClause, column, inspect, table, types
from sqlalchemy.engine.interfaces import ReflectedColumn

from app.db.migrations import VERSION_TABLE
from app.db.unfinished import UNFINISHED
from app.errors import BrokenInstallation

Kind = Literal["integer", "float", "text", "bytes", "time", "boolean", "json"]

# the first that fits: JSON of PostgreSQL is no text to SQLAlchemy, and a boolean is no integer
KINDS: tuple[tuple[type[types.TypeEngine[Any]], Kind], ...] = (
    (types.Boolean, "boolean"),
    (types.Integer, "integer"),
    (types.Float, "float"),
    (types.JSON, "json"),
    (types.DateTime, "time"),
    (types.LargeBinary, "bytes"),
    (types.String, "text"),
)


@dataclass(frozen=True)
class CopiedColumn:
    """A column, with what kind of values it holds on both kinds of databases."""

    name: str
    kind: Kind


@dataclass(frozen=True)
class CopiedTable:
    """A table.

    Attributes:
        name: Its name.
        columns: By name; their order in the table depends on how it came to its form.
        key: Its primary key, by which rows are ordered.
    """

    name: str
    columns: tuple[CopiedColumn, ...]
    key: tuple[CopiedColumn, ...]

    @property
    def clause(self) -> TableClause:
        """The table as statements name it."""
        return table(self.name, *(column(each.name) for each in self.columns))

    @property
    def numbering(self) -> str | None:
        """The column that the database numbers by itself: a key of one integer. None if there is no such column."""
        return self.key[0].name if len(self.key) == 1 and self.key[0].kind == "integer" else None

    def key_of(self, row: tuple[Any, ...]) -> str:
        """Return a row's key for people: ``id 5``."""
        places = {each.name: place for place, each in enumerate(self.columns)}
        return ", ".join(f"{each.name} {row[places[each.name]]}" for each in self.key)


def tables_of(connection: Connection) -> tuple[CopiedTable, ...]:
    """Return the tables of a database by name; those of the migrations and of a copy's mark aren't among them.

    Raises:
        BrokenInstallation: On a column whose type neither kind of database is known to hold.
    """
    inspector = inspect(connection)
    # all tables at once: PostgreSQL answers that in the time of one
    keys = {name: key["constrained_columns"] for (_, name), key in inspector.get_multi_pk_constraint().items()}
    found = {name: columns for (_, name), columns in inspector.get_multi_columns().items()}
    return tuple(_table(name, found[name], keys[name]) for name in sorted(set(found) - {VERSION_TABLE, UNFINISHED}))


def _table(name: str, found: Sequence[ReflectedColumn], key: Sequence[str]) -> CopiedTable:
    columns = {
        column["name"]: CopiedColumn(column["name"], _kind(f"{name}.{column['name']}", column["type"]))
        for column in found
    }
    in_order = tuple(columns[each] for each in sorted(columns))
    return CopiedTable(name, in_order, tuple(columns[each] for each in key) or in_order)


def _kind(where: str, stored: types.TypeEngine[Any]) -> Kind:
    for known, kind in KINDS:
        if isinstance(stored, known):
            return kind
    raise BrokenInstallation(f"columns of the type {stored} can't be copied", where=where)
