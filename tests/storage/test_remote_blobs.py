"""What holds for remote stores alone: whole uploads, honest reads, leftovers, and copies of what was read."""

import hashlib
import os
import time
from pathlib import Path

import pytest
from fsspec.implementations.local import LocalFileSystem

from app.errors import NotFound, Unavailable
from app.storage import RemoteBlobs
from app.storage.caching import ReadCache

CONTENT = b"content" * 1000
SHA256 = hashlib.sha256(CONTENT).hexdigest()


@pytest.fixture
def remote(make_store):
    return make_store("s3")


@pytest.fixture
def key(remote, buckets):
    """Return where the server keeps a blob."""
    bucket = remote.address.removeprefix("s3://")
    return lambda sha256: f"{bucket}/some/where/{sha256[:2]}/{sha256[2:4]}/{sha256}"


def test_a_blob_is_an_object_under_its_prefix(remote, buckets, key):
    remote.put(CONTENT)
    assert buckets.cat_file(key(SHA256)) == CONTENT
    assert remote.local_path(SHA256) is None
    assert (remote.usage().used, remote.usage().free) == (None, None)


def test_an_object_that_is_there_is_not_sent_again(remote, buckets, key, monkeypatch):
    remote.put(CONTENT)
    monkeypatch.setattr(buckets, "pipe_file", None)
    monkeypatch.setattr(buckets, "put_file", None)
    assert remote.put(CONTENT) == remote.put([CONTENT]) == SHA256


def test_an_object_that_is_cut_short_is_told_and_mended(remote, buckets, key):
    buckets.pipe_file(key(SHA256), CONTENT[:100])
    with pytest.raises(Unavailable, match="other bytes than it was given"):
        remote.read(SHA256)
    remote.put(CONTENT)
    assert remote.read(SHA256) == CONTENT


def test_other_objects_are_no_blobs(remote, buckets, key):
    remote.put(CONTENT)
    for other in ("notes.txt", "ab/notes.txt", f"lost/{SHA256}", f"ab/cd/{SHA256}", f"ab/{SHA256}"):
        buckets.pipe_file(f"{key('')[:-2]}{other}", b"")
    assert [blob.sha256 for blob in remote.iterate()] == [SHA256]


def test_where_files_grow_in_sight_they_get_their_name_when_they_are_whole(tmp_path: Path, monkeypatch):
    files = LocalFileSystem(skip_instance_cache=True)
    store = RemoteBlobs(files, str(tmp_path / "there"), address="there", spool=tmp_path / "here")
    sent: list[str] = []
    pipe = files.pipe_file

    def break_off(path: str, content: bytes) -> None:
        sent.append(path)
        pipe(path, content[:100])
        raise ConnectionResetError("the line is dead")

    monkeypatch.setattr(files, "pipe_file", break_off)
    with pytest.raises(Unavailable, match="can't be reached"):
        store.put(CONTENT)
    assert Path(sent[0]).parent.name == "incoming"
    assert not store.exists(SHA256)
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


def test_leftovers_of_killed_writers_are_removed_here_and_there(make_store, tmp_path: Path):
    files = LocalFileSystem(skip_instance_cache=True)
    store = RemoteBlobs(files, str(tmp_path / "there"), address="there", spool=tmp_path / "here")
    store.put(CONTENT)
    now = time.time()
    for folder in (tmp_path / "here", tmp_path / "there" / "incoming"):
        for name, age in (("old", 1000), ("young", 0)):
            (folder / name).write_bytes(b"part")
            os.utime(folder / name, (now - age, now - age))
    assert store.discard_incoming(before=now - 500) == 2
    assert sorted(path.name for path in tmp_path.rglob("*") if path.is_file()) == sorted(["young", "young", SHA256])


def test_what_was_read_is_read_again_from_here(remote, buckets, key, tmp_path: Path):
    cached = RemoteBlobs(
        buckets,
        key("").partition("/")[0] + "/some/where",
        address=remote.address,
        spool=tmp_path / "spool",
        cache=ReadCache(tmp_path / "cache", 10**6),
    )
    remote.put(CONTENT)
    assert cached.read(SHA256) == CONTENT
    buckets.rm_file(key(SHA256))  # behind its back
    assert cached.read(SHA256) == CONTENT
    with cached.open(SHA256) as stream:
        assert stream.read() == CONTENT
    assert not cached.exists(SHA256)
    (tmp_path / "cache" / SHA256).write_bytes(CONTENT[:-1])  # as a crash leaves it
    with pytest.raises(NotFound):
        cached.read(SHA256)
    remote.put(CONTENT)
    assert cached.read(SHA256) == CONTENT
    assert cached.delete(SHA256)
    assert list((tmp_path / "cache").iterdir()) == []
