"""The state of the server, for whoever looks after it."""

from __future__ import annotations

from datetime import datetime
from typing import Literal

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, ErrorInfo

WorkKind = Literal["images", "submissions", "calibrations", "webhooks"]


class QueueStanding(Answer):
    """One kind of work."""

    kind: WorkKind = Field(description="`images`: those of runs.")
    waiting: int = Field(description="Pieces that wait for a worker; counted to a million.")
    running: int
    failed: int = Field(description="Failures of the last 24 hours that nobody has mended; counted to 500.")
    oldest_wait: float | None = Field(description="How long the oldest one has been waiting, in s.")


class WorkerStatus(Answer):
    """One worker process."""

    name: str
    address: str = Field(description="Its process id on this machine, or its address in the cluster.")
    accepted: bool = Field(description="Whether it is given work.")
    reason: str | None = Field(description="Why it isn't: it runs another version, say.")
    megabytes: float | None = Field(description="Memory that it held when last seen, in MiB.")
    busy: bool


class CrewStatus(Answer):
    """All workers."""

    kind: Literal["pool", "cluster"] = Field(description="Processes on this machine, or those of a Dask cluster.")
    address: str | None = Field(description="The cluster's scheduler.")
    reachable: bool = Field(description="Whether work can be sent.")
    problem: str | None = Field(description="What is wrong, in words.")
    workers: list[WorkerStatus] = Field(description="A pool starts its workers when there is work.")


class DispatcherStatus(Answer):
    """Who gives work out. Of several servers on one database one does."""

    here: bool = Field(description="Whether the server that answers does it.")
    held: bool | None = Field(description="Whether any does; null where it isn't known, on SQLite.")
    holder: str | None = Field(description="From which address that one is connected to the database.")
    since: datetime | None = Field(description="When it took it up, or connected.")
    running: int = Field(description="Work that workers have now, of this server.")
    in_hand: int = Field(description="Work that is next, beside that.")


class DiskStatus(Answer):
    """A disk, or a store of files."""

    name: Literal["data", "blobs"]
    address: str = Field(description="The folder, or the store's address.")
    used: int | None = Field(description="Bytes; null where nobody can tell.")
    free: int | None = Field(description="Bytes; null where nobody can tell.")
    problem: str | None = Field(description="Why it can't be reached.")


class DatabaseStatus(Answer):
    """The database."""

    kind: Literal["SQLite", "PostgreSQL"]
    version: str
    address: str = Field(description="Without the password.")
    bytes: int
    revision: str | None = Field(description="Form of its tables, by the name of the last migration.")
    connections: int = Field(description="That this server has open.")
    connections_used: int


class FailureInfo(Answer):
    """A piece of work that failed."""

    kind: WorkKind
    id: int
    what: str = Field(description="Which image, method or camera.")
    page: str = Field(description="Where the browser tool shows it.")
    at: datetime | None
    error: ErrorInfo


class Status(Answer):
    """The state of the server."""

    model_config = ConfigDict(json_schema_extra={"description": "What is to be known to look after the server."})

    version: str
    started_at: datetime
    now: datetime
    hosted: bool = Field(description="Whether others can reach it, so that accounts are required.")
    queue: list[QueueStanding]
    crew: CrewStatus
    dispatcher: DispatcherStatus
    disks: list[DiskStatus]
    database: DatabaseStatus
    failures: list[FailureInfo] = Field(description="The latest 20, newest first.")
