"""What ``migrate``, ``backup`` and ``restore`` share: the installation that is read, and what they tell of it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import URL, make_url

from app.db.copying.copy import CopiedDatabase
from app.db.session import Database, checked_address, open_database
from app.errors import Conflict, NotFound
from app.services.blob_copying import CopiedBlobs


@dataclass(frozen=True)
class MovedInstallation:
    """What was copied.

    Attributes:
        database: The rows.
        blobs: The uploaded files; None where they stay where they are.
    """

    database: CopiedDatabase
    blobs: CopiedBlobs | None

    @property
    def told(self) -> str:
        """How much it was, for people."""
        said = f"{self.database.rows:,} rows of {len(self.database.tables)} tables"
        if self.blobs is None:
            return said
        return f"{said} and {self.blobs.count:,} files ({_in_megabytes(self.blobs.bytes)})"


@contextmanager
def opened_source(address: str | URL) -> Iterator[Database]:
    """Open a database that is to be read; unlike elsewhere, none is made where there is none, and none is upgraded.

    Raises:
        NotFound: When there is no file.
        InvalidInput: When the address can't be read.
    """
    place = checked_address(address)
    if place.get_backend_name() == "sqlite" and not Path(place.database or "").is_file():
        raise NotFound("there is no installation here", where=shown_address(address), hint="is --data right?")
    with opened_database(address) as database:
        yield database


@contextmanager
def opened_database(address: str | URL) -> Iterator[Database]:
    """Open a database, and close it at the end; errors as `app.db.session.open_database`."""
    database = open_database(address)
    try:
        yield database
    finally:
        database.close()


def require_another(source: Database, target: Database) -> None:
    """Refuse to copy an installation onto itself, which an empty one would be cleared for.

    Raises:
        Conflict: When both are one database.
    """
    here, there = source.engine.url, target.engine.url
    same_file = (
        source.is_sqlite
        and target.is_sqlite
        and Path(str(here.database)).resolve() == Path(str(there.database)).resolve()
    )
    if here == there or same_file:
        raise Conflict("this is the installation itself", where=shown_address(there), hint="give another address")


def shown_address(address: str | URL) -> str:
    """Return a database's address without its password."""
    return make_url(address).render_as_string(hide_password=True)


def _in_megabytes(size: int) -> str:
    return f"{size / 2**20:,.1f} MiB"
