"""Stores of every kind, each empty and of its test alone."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fsspec import AbstractFileSystem
from fsspec.implementations.local import LocalFileSystem
from fsspec.implementations.memory import MemoryFileSystem

from app.storage import BlobStore, LocalBlobs, RemoteBlobs
from app.storage.addresses import close_connections, file_system


@pytest.fixture(scope="session")
def buckets(object_server) -> Iterator[AbstractFileSystem]:
    """A file system of the S3-compatible server; to make one takes longer than most tests."""
    files, _ = file_system("s3://any", object_server.options)
    yield files
    close_connections(files)


@pytest.fixture
def make_store(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[[str], BlobStore]:
    """Return what makes an empty store of a kind: a folder, or a remote one on a file system of fsspec."""

    def make(kind: str) -> BlobStore:
        folder = tmp_path / uuid.uuid4().hex
        if kind == "folder":
            return LocalBlobs(folder)
        if kind == "memory":
            files = MemoryFileSystem(global_store=False, skip_instance_cache=True)
            return RemoteBlobs(files, "/blobs", address="memory", spool=folder)
        if kind == "files":
            files = LocalFileSystem(skip_instance_cache=True)
            return RemoteBlobs(files, str(folder / "there"), address="there", spool=folder / "here")
        files = request.getfixturevalue("buckets")
        bucket = request.getfixturevalue("object_server").make_bucket()
        return RemoteBlobs(files, f"{bucket}/some/where", address=f"s3://{bucket}", spool=folder)

    return make


@pytest.fixture(params=["folder", "memory", "files", "s3"])
def store(request: pytest.FixtureRequest, make_store: Callable[[str], BlobStore]) -> BlobStore:
    """A store of each kind."""
    return make_store(request.param)
