"""How many bytes a row of each large table takes: in the table, beside it, and in each index."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import psycopg

TABLES = (
    "segments",
    "decisions",
    "segment_states",
    "images",
    "image_features",
    "run_images",
    "reviews",
    "blobs",
    "events",
)
LARGE = 0.5
"""Bytes per row from which on an index is listed by itself."""

SIZES = """
SELECT pg_relation_size(oid), coalesce(pg_total_relation_size(nullif(reltoastrelid, 0)), 0), greatest(reltuples, 1)
FROM pg_class WHERE oid = %s::regclass
"""
INDEXES = """
SELECT indexrelid::regclass::text, pg_relation_size(indexrelid) FROM pg_index WHERE indrelid = %s::regclass
ORDER BY 2 DESC
"""


@dataclass(frozen=True)
class TableSize:
    """Bytes per row of a table.

    Attributes:
        rows: How many there are, as the database estimates.
        heap: The rows themselves.
        toast: What is too long for them.
        indexes: By name, the largest first.
    """

    name: str
    rows: int
    heap: float
    toast: float
    indexes: dict[str, float]

    @property
    def total(self) -> float:
        """All of it."""
        return self.heap + self.toast + sum(self.indexes.values())


def table_sizes(address: str) -> list[TableSize]:
    """Return the sizes of the large tables of a database."""
    with psycopg.connect(address) as connection:
        return [_size(connection, table) for table in TABLES]


def size_rows(sizes: Sequence[TableSize]) -> list[list[str]]:
    """Return lines of a table: one per table, then its indexes."""
    rows = []
    for size in sizes:
        rest = sum(size.indexes.values())
        numbers = (size.heap, size.toast, rest, size.total)
        rows.append([size.name, f"{size.rows:,}", *(f"{number:.0f}" for number in numbers)])
        listed = [(name, number) for name, number in size.indexes.items() if number >= LARGE]
        rows += [[f"  {name}", "", "", "", f"{number:.0f}", ""] for name, number in listed]
    return rows


def _size(connection: psycopg.Connection, table: str) -> TableSize:
    heap, toast, rows = connection.execute(SIZES, [table]).fetchone() or (0, 0, 1)
    indexes = connection.execute(INDEXES, [table]).fetchall()
    return TableSize(table, int(rows), heap / rows, toast / rows, {name: size / rows for name, size in indexes})
