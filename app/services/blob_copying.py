"""Copying the blobs that rows name from one store to another; what is there already is left as it is."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

from app.db.copying.reading import read_rows
from app.db.copying.tables import tables_of
from app.db.models import Blob
from app.db.session import Database
from app.errors import NotFound, Unavailable
from app.services.batches import in_batches
from app.storage import BlobStore

AT_ONCE = 8  # a remote store takes its time for each
BATCH = 256
Outcome = Literal["copied", "linked", "missing"]


@dataclass(frozen=True, slots=True)
class NamedBlob:
    """A blob that a row names.

    Attributes:
        sha256: Of its content.
        size: Bytes.
    """

    sha256: str
    size: int


@dataclass(frozen=True)
class CopiedBlobs:
    """What became of the blobs.

    Attributes:
        count: How many rows name.
        bytes: Of all of them.
        copied: How many came from the source's store.
        linked: How many are further names of files on the same disk.
        missing: Those that the source hasn't got.
    """

    count: int
    bytes: int
    copied: int
    linked: int
    missing: tuple[str, ...]


def named_blobs(database: Database) -> list[NamedBlob]:
    """Return all blobs that the rows of a database name, in the order of their names; at any revision."""
    with database.read() as session:
        connection = session.connection()
        table = next(each for each in tables_of(connection) if each.name == Blob.__tablename__)
        places = {each.name: place for place, each in enumerate(table.columns)}
        sha256, size = places[Blob.sha256.key], places[Blob.size.key]
        return [NamedBlob(row[sha256], row[size]) for batch in read_rows(connection, table) for row in batch.rows]


def copy_blobs(
    blobs: Sequence[NamedBlob],
    source: BlobStore,
    target: BlobStore,
    *,
    link: bool = False,
    earlier: BlobStore | None = None,
    report: Callable[[int, int], None] | None = None,
) -> CopiedBlobs:
    """Copy blobs; each that is copied is hashed again on its way.

    Args:
        blobs: From `named_blobs`.
        source: Where they are.
        target: Where they are to be.
        link: Whether files on one disk may be the same file under two names.
        earlier: A store that may have some of them already, which can be linked to.
        report: Is told how many are done, and their total.

    Raises:
        Unavailable: When a store can't be reached, or a blob isn't what its name says.
        OSError: When the disk is full.
    """
    linked_to = [store for store in (source, earlier) if link and store is not None]

    def bring(blob: NamedBlob) -> Outcome:
        if any(_link(blob, store, target) for store in linked_to):
            return "linked"
        return _copy(blob, source, target)

    counts: dict[Outcome, int] = {"copied": 0, "linked": 0, "missing": 0}
    missing: list[str] = []
    new = list(_not_there(blobs, target))
    done = len(blobs) - len(new)
    with ThreadPoolExecutor(AT_ONCE, thread_name_prefix="blobs") as pool:
        for batch in in_batches(new, BATCH):
            for blob, outcome in zip(batch, pool.map(bring, batch), strict=True):
                counts[outcome] += 1
                if outcome == "missing":
                    missing.append(blob.sha256)
            done += len(batch)
            if report is not None:
                report(done, len(blobs))
    size = sum(blob.size for blob in blobs)
    return CopiedBlobs(len(blobs), size, counts["copied"], counts["linked"], tuple(missing))


def _not_there(blobs: Iterable[NamedBlob], target: BlobStore) -> Iterator[NamedBlob]:
    """Yield those that a store hasn't got, with one listing instead of a question for each."""
    listing = target.iterate()
    there = next(listing, None)
    for blob in blobs:
        while there is not None and there.sha256 < blob.sha256:
            there = next(listing, None)
        if there is None or there.sha256 != blob.sha256:
            yield blob


def _link(blob: NamedBlob, source: BlobStore, target: BlobStore) -> bool:
    here, there = source.local_path(blob.sha256), target.local_path(blob.sha256)
    if here is None or there is None:
        return False
    try:
        if here.stat().st_size != blob.size:
            return False
        there.parent.mkdir(parents=True, exist_ok=True)
        os.link(here, there)
    except OSError:  # another disk, or a file system without links
        return False
    return True


def _copy(blob: NamedBlob, source: BlobStore, target: BlobStore) -> Outcome:
    try:
        with source.open(blob.sha256) as stream:
            arrived = target.put(stream)
    except NotFound:
        return "missing"
    if arrived != blob.sha256:
        target.delete(arrived)
        raise Unavailable(
            "the content of a stored file isn't what its name says", where=blob.sha256, hint="is a disk failing?"
        )
    return "copied"
