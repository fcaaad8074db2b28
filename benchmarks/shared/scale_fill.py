"""Fill a database with a large installation: by COPY, without foreign keys and indexes, which come afterwards.

The rows are those of the schema before counters were kept of them, so that the upgrade to the present one is measured.
"""

from __future__ import annotations

import time
from collections.abc import Iterable

import psycopg
from psycopg import sql
from shared.binary_copy import END, SIGNATURE, encoded_rows
from shared.scale_server import database_address, execute_alone, has_database
from shared.scale_tables import Columns, decisions, features, segments, small_tables
from shared.scale_world import World

from app.db.migrations import run_upgrade
from app.db.session import open_database, upgrade

FILLED_AS = "0005"
"""Revision of the schema that the generators know."""
WITHOUT_INDEXES = ("segments", "decisions", "segment_states")


def fill(server: str, name: str, world: World, seed: int) -> dict[str, float]:
    """Make and fill a database; return how long it took, in s.

    Args:
        server: Address of the administration database; its user is a superuser.
        name: Of the database; it is made anew.
        world: What it is to hold.
        seed: Of the generators.
    """
    address = database_address(server, name)
    execute_alone(server, f"DROP DATABASE IF EXISTS {name} WITH (FORCE)", f"CREATE DATABASE {name}")
    database = open_database(address)
    run_upgrade(database.engine, FILLED_AS)
    begun = time.perf_counter()
    with psycopg.connect(address) as connection:
        connection.execute("SET session_replication_role = replica")  # the rows fit one another as they are made
        definitions = _drop_indexes(connection)
        for table, columns in small_tables(world, seed):
            _copy(connection, table, [columns])
        _copy(connection, "segments", segments(world, seed))
        for of_decisions, of_states in decisions(world, seed):
            _copy(connection, "decisions", [of_decisions])
            _copy(connection, "segment_states", [of_states])
        _copy(connection, "image_features", features(world, seed))
        connection.commit()
        copied = time.perf_counter()
        seconds = {"copy": copied - begun}
        for index, definition in definitions:
            start = time.perf_counter()
            connection.execute(definition.encode())
            seconds[f"index {index}"] = time.perf_counter() - start
        connection.commit()
        _set_sequences(connection)
    execute_alone(address, "VACUUM (ANALYZE)")
    start = time.perf_counter()
    upgrade(database)
    seconds["upgrade"] = time.perf_counter() - start
    execute_alone(address, "VACUUM (ANALYZE)", "CHECKPOINT")
    database.close()
    return seconds


def is_filled(server: str, name: str, world: World) -> bool:
    """Whether a database of this name holds the images and segments of the world; later ones don't count."""
    if not has_database(server, name):
        return False
    with psycopg.connect(database_address(server, name)) as connection:
        try:
            images, segment = connection.execute(
                "SELECT (SELECT count(*) FROM images WHERE id <= %s), (SELECT max(id) FROM segments WHERE id <= %s)",
                [world.images, world.segments],
            ).fetchone() or (0, 0)
        except psycopg.errors.UndefinedTable:
            return False
    return images == world.images and segment == world.segments


def _copy(connection: psycopg.Connection, table: str, parts: Iterable[Columns]) -> None:
    with connection.cursor() as cursor:
        for columns in parts:
            names = sql.SQL(", ").join(map(sql.Identifier, columns))
            query = sql.SQL("COPY {} ({}) FROM STDIN (FORMAT BINARY)").format(sql.Identifier(table), names)
            with cursor.copy(query) as copy:
                copy.write(SIGNATURE)
                copy.write(encoded_rows(list(columns.values())))
                copy.write(END)


def _drop_indexes(connection: psycopg.Connection) -> list[tuple[str, str]]:
    rows = connection.execute(
        "SELECT indexname, indexdef FROM pg_indexes WHERE tablename = ANY(%s) AND indexname LIKE 'ix_%%'",
        [list(WITHOUT_INDEXES)],
    ).fetchall()
    for name, _ in rows:
        connection.execute(sql.SQL("DROP INDEX {}").format(sql.Identifier(name)))
    return rows


def _set_sequences(connection: psycopg.Connection) -> None:
    tables = connection.execute(
        "SELECT table_name FROM information_schema.columns WHERE table_schema = 'public' AND column_name = 'id'"
        " AND column_default LIKE 'nextval%'"
    ).fetchall()
    for (table,) in tables:
        connection.execute(
            sql.SQL("SELECT setval(pg_get_serial_sequence({}, 'id'), coalesce(max(id), 0) + 1, false) FROM {}").format(
                sql.Literal(table), sql.Identifier(table)
            )
        )
    connection.commit()
