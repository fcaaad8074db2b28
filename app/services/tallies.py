"""Counts of images and of runs' work, read from what triggers keep of them, whatever the size of the tables.

A total is the sum of rows: one for each combination of what images are chosen by, and one for each change since they
were merged last. Whoever reads sees the totals of their own snapshot, exact as counting would be.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, Delete, Select, Table, delete, func, insert, literal, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from app.db.models import Dataset, ImageTally, RunTally

LOOSE = 200
"""Changes since the last merging from which on the rows of a dataset, or of a run, are merged again."""


@dataclass(frozen=True)
class Tallied:
    """A table of sums.

    Attributes:
        table: It.
        owner: What its rows are read by.
        keys: Columns that tell its sums apart.
        sums: The others.
    """

    table: Table
    owner: ColumnElement[int]
    keys: tuple[str, ...]
    sums: tuple[str, ...]


def _tallied(model: type[ImageTally] | type[RunTally], owner: str, keys: Sequence[str]) -> Tallied:
    table: Any = model.__table__
    sums = tuple(column.name for column in table.columns if column.name not in {"id", "merged", *keys})
    return Tallied(table, table.c[owner], tuple(keys), sums)


IMAGES = _tallied(
    ImageTally,
    "dataset_id",
    ("dataset_id", "camera_id", "source", "sequence", "assignee", "review_status", "prelabel", "deleted"),
)
RUNS = _tallied(RunTally, "run_id", ("run_id", "status"))


def summed(column: InstrumentedAttribute[int]) -> ColumnElement[int]:
    """Return the sum of a count, 0 where there are no rows."""
    return func.coalesce(func.sum(column), 0)


def of_dataset(dataset: Dataset) -> ColumnElement[bool]:
    """Return the condition on ``ImageTally`` that it counts images of a dataset that aren't deleted."""
    return (ImageTally.dataset_id == dataset.id) & ImageTally.deleted.is_(False)


def image_count(session: Session, *conditions: ColumnElement[bool]) -> int:
    """Return the number of images that are so, from conditions on ``ImageTally``."""
    return session.scalar(select(summed(ImageTally.images)).where(*conditions)) or 0


def counts_by(
    session: Session, column: InstrumentedAttribute[Any], *conditions: ColumnElement[bool]
) -> Mapping[Any, int]:
    """Return the number of images by a value, from conditions on ``ImageTally``; values without any are left out."""
    images = summed(ImageTally.images)
    query: Select[Any, int] = select(column, images).where(*conditions).group_by(column).having(images != 0)
    return dict(session.execute(query).all())


def states_of_runs(session: Session, run_ids: Collection[int]) -> dict[int, dict[str, int]]:
    """Return the number of images of runs by state."""
    images = summed(RunTally.images)
    rows = session.execute(
        select(RunTally.run_id, RunTally.status, images)
        .where(RunTally.run_id.in_(run_ids))
        .group_by(RunTally.run_id, RunTally.status)
        .having(images != 0)
    )
    counts: dict[int, dict[str, int]] = {run_id: {} for run_id in run_ids}
    for run_id, status, number in rows:
        counts[run_id][status] = number
    return counts


def owners_to_merge(session: Session, tallied: Tallied) -> Sequence[int]:
    """Return the datasets, or runs, whose rows are worth merging."""
    loose = tallied.table.c.merged.is_(False)
    query = select(tallied.owner).where(loose).group_by(tallied.owner).having(func.count() >= LOOSE)
    return session.scalars(query.order_by(tallied.owner)).all()


def merge_tallies(session: Session, tallied: Tallied, owner: int) -> None:
    """Add up the rows of one dataset, or of one run; what they add up to stays the same at each moment.

    Args:
        session: A writing session.
        tallied: Which table.
        owner: Of which dataset or run.
    """
    table = tallied.table
    keys = [table.c[name] for name in tallied.keys]
    gone: Delete[Any] = delete(table).where(tallied.owner == owner)
    if session.get_bind().dialect.name == "sqlite":  # which has one writer, and no statement that does both
        rows = [
            dict(row) for row in session.execute(_merged(tallied, table, keys).where(tallied.owner == owner)).mappings()
        ]
        session.execute(gone)
        if rows:
            session.execute(insert(table), rows)
        return
    # one statement, so one snapshot: a row that is added meanwhile is neither counted nor removed
    removed = gone.returning(*table.c).cte("removed")
    columns = [*tallied.keys, *tallied.sums, "merged"]
    session.execute(
        insert(table).from_select(columns, _merged(tallied, removed, [removed.c[name] for name in tallied.keys]))
    )


def _merged(tallied: Tallied, rows: Any, keys: Sequence[ColumnElement[Any]]) -> Select[Any]:
    sums = [func.sum(rows.c[name]).label(name) for name in tallied.sums]
    anything = sum((func.abs(func.sum(rows.c[name])) for name in tallied.sums), literal(0))
    return select(*keys, *sums, literal(True).label("merged")).group_by(*keys).having(anything != 0)
