"""Compiled SQL that all databases of a kind share.

SQLAlchemy keeps what it compiled with the database that it opened. A server opens one; here each test opens its own,
and compiling took as long as all else that the services do.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from sqlalchemy import Dialect, Engine, create_engine
from sqlalchemy.dialects.postgresql.psycopg import PGDialect_psycopg
from sqlalchemy.dialects.sqlite.pysqlite import SQLiteDialect_pysqlite
from sqlalchemy.util import LRUCache

import app.db.session

STATEMENTS = 5000
"""More than the tests have; what is used least is forgotten first."""


def _same_kind(one: Dialect, other: object) -> bool:
    return type(one) is type(other)


def _by_kind(dialect: Dialect) -> int:
    return hash(type(dialect))


@contextmanager
def shared_statements() -> Iterator[None]:
    """Have ``open_database`` look for a statement among those that any database of the kind had compiled."""
    compiled: LRUCache[Any, Any] = LRUCache(STATEMENTS)

    def create(*arguments: Any, **options: Any) -> Engine:
        engine = create_engine(*arguments, **options)
        engine.update_execution_options(compiled_cache=compiled)
        return engine

    with pytest.MonkeyPatch.context() as patch:
        for dialect in (PGDialect_psycopg, SQLiteDialect_pysqlite):  # the key of a statement names its dialect
            patch.setattr(dialect, "__eq__", _same_kind)
            patch.setattr(dialect, "__hash__", _by_kind)
        patch.setattr(app.db.session, "create_engine", create)
        yield
