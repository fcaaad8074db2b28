"""The list of what a backup holds: ``manifest.json``, written last."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from app import __version__
from app.db.copying.copy import CopiedDatabase
from app.db.copying.digests import TableDigest
from app.errors import InvalidFile, NotFound
from app.services.blob_copying import CopiedBlobs

MANIFEST = "manifest.json"
DATABASE = "clearlines.sqlite3"
BLOBS = "blobs"
MAX_BYTES = 2**30


class TableEntry(BaseModel):
    """A table: how many rows, and the SHA-256 of their content in the order of its key."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    rows: int = Field(ge=0)
    sha256: str


class BlobsEntry(BaseModel):
    """The uploaded files; each is named by the SHA-256 of its content."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    count: int = Field(ge=0)
    bytes: int = Field(ge=0)
    missing: list[str]  # those that the installation itself had lost


class Manifest(BaseModel):
    """What a backup holds."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    format: Literal[1] = 1
    version: str  # of ClearLines
    revision: str  # of the tables
    instance: str  # which installation it is of
    created_at: datetime
    tables: dict[str, TableEntry]
    blobs: BlobsEntry


def manifest_of(rows: CopiedDatabase, blobs: CopiedBlobs, instance: str, now: datetime) -> Manifest:
    """Return the manifest of what was copied."""
    return Manifest(
        version=__version__,
        revision=rows.revision,
        instance=instance,
        created_at=now,
        tables={
            name: TableEntry(rows=digest.rows, sha256=digest.sha256) for name, digest in sorted(rows.tables.items())
        },
        blobs=BlobsEntry(count=blobs.count, bytes=blobs.bytes, missing=list(blobs.missing)),
    )


def read_manifest(folder: Path) -> Manifest:
    """Read the manifest of a backup.

    Raises:
        NotFound: When the folder has none: it is no backup, or one that wasn't finished.
        InvalidFile: When it can't be read, or is of a later version.
    """
    path = folder / MANIFEST
    if not path.is_file():
        raise NotFound(
            "this is no backup", where=str(folder), expected=f"a folder with {MANIFEST}, made by clearlines backup"
        )
    if path.stat().st_size > MAX_BYTES:
        raise InvalidFile("the list of the backup's content is too long", where=str(path))
    try:
        return Manifest.model_validate_json(path.read_bytes())
    except ValidationError as error:
        first = error.errors()[0]
        raise InvalidFile(
            f"the list of the backup's content can't be read: {first['msg']}",
            where=f"{path}, {'.'.join(map(str, first['loc']))}",
            hint="a later version may have made it",
        ) from error


def require_as_listed(manifest: Manifest, rows: CopiedDatabase) -> None:
    """Compare rows that were read from a backup with its manifest.

    Raises:
        InvalidFile: When they differ, naming the first table that does.
    """
    listed = {name: TableDigest(entry.rows, entry.sha256) for name, entry in manifest.tables.items()}
    for name in sorted({*listed, *rows.tables}):
        if listed.get(name) != rows.tables.get(name):
            raise InvalidFile(
                "the backup is damaged: the rows aren't those that were saved",
                where=name,
                hint="take another backup; what was restored isn't used",
            )
