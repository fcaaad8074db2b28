"""Copying all rows of one database into another."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass

from sqlalchemy import Connection, delete, text

from app.db.copying.digests import Digesting, TableDigest, require_same
from app.db.copying.keys import keys_aside
from app.db.copying.numbering import go_on_after, largest_given
from app.db.copying.reading import Batch, count_rows, read_rows
from app.db.copying.tables import CopiedTable, tables_of
from app.db.copying.targets import Target
from app.db.copying.writing import write_rows
from app.db.migrations import revisions, stored_revision, upgrade_within
from app.db.session import Database
from app.db.unfinished import require_finished
from app.errors import ClearLinesError, Conflict, NotFound, Unavailable

Report = Callable[[str, int, int], None]
"""Is told what is done, as a table's name, how much of it is, and how much it is in all."""


@dataclass(frozen=True)
class CopiedDatabase:
    """What was copied.

    Attributes:
        revision: Form of the tables, by the name of the last migration.
        tables: Rows and content of each, by its name.
    """

    revision: str
    tables: Mapping[str, TableDigest]

    @property
    def rows(self) -> int:
        """Of all tables."""
        return sum(table.rows for table in self.tables.values())


def copy_rows(source: Database, target: Target, *, report: Report | None = None) -> CopiedDatabase:
    """Copy all tables from one snapshot, in the form that they have there, and compare what arrived with what was read.

    Args:
        source: Where they are; nothing is changed there, and others may write.
        target: From `app.db.copying.targets.filling`.
        report: Is told how far it is.

    Raises:
        NotFound: When the source has no tables.
        Conflict: When the source was made by a newer version.
        InvalidInput: On a row that the target can't hold, or whose keys contradict others.
        Unavailable: When a database can't be reached any more, or what arrived differs.
    """
    try:
        with source.read() as session, target.in_one() as filled:
            return _copy(session.connection(), filled, report or (lambda *_: None))
    except ClearLinesError:
        raise
    except (source.engine.dialect.loaded_dbapi.Error, target.database.engine.dialect.loaded_dbapi.Error) as error:
        raise Unavailable(f"a database can't answer: {error}", hint="begin again; the source is as it was") from error


def _copy(origin: Connection, target: Target, report: Report) -> CopiedDatabase:
    revision = known_revision(origin)
    with target.transaction() as connection:
        theirs = {table.name for table in tables_of(connection)}
        upgrade_within(connection, revision)
        ours = {table.name for table in tables_of(connection)} - theirs
    tables = tuple(table for table in tables_of(origin) if table.name in ours)
    digests: dict[str, TableDigest] = {}
    with keys_aside(target, tables):
        with target.transaction() as connection:
            for table in tables:  # what the migrations put in comes from the source too
                connection.execute(delete(table.clause))
        for table in tables:
            digests[table.name] = _copy_table(origin, target, table, report)
    with target.transaction() as connection:
        for number, table in enumerate(tables):
            report("comparing tables", number, len(tables))
            require_same(origin, connection, table, digests[table.name])
            go_on_after(connection, table, largest_given(origin, table))
        report("comparing tables", len(tables), len(tables))
        if not target.is_sqlite:
            connection.execute(text("ANALYZE"))
    return CopiedDatabase(revision, digests)


def known_revision(connection: Connection) -> str:
    """Return the form of an installation's tables.

    Raises:
        NotFound: When there are none.
        Conflict: When a newer version made them.
        Unavailable: When they aren't whole.
    """
    where = connection.engine.url.render_as_string(hide_password=True)
    require_finished(connection)
    revision = stored_revision(connection)
    if revision is None:
        raise NotFound("there is no installation in this database", where=where, hint="is it the right address?")
    if revision not in revisions():
        raise Conflict(
            f"a newer version of ClearLines made these tables (revision {revision})",
            where=where,
            hint="use that version",
        )
    return revision


def _copy_table(origin: Connection, target: Target, table: CopiedTable, report: Report) -> TableDigest:
    total = count_rows(origin, table)
    with closing(read_rows(origin, table)) as batches:
        digesting = Digesting(batches)

        def counted() -> Iterator[Batch]:
            for batch in digesting:
                yield batch
                report(table.name, digesting.rows, total)

        report(table.name, 0, total)
        write_rows(target, table, counted())
        return digesting.digest
