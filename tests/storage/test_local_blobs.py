"""What holds for a folder of blobs alone."""

import hashlib
import os
import time
from pathlib import Path

import pytest

from app.errors import Unavailable
from app.storage import LocalBlobs, StoredBlob

CONTENT = b"content" * 1000
SHA256 = hashlib.sha256(CONTENT).hexdigest()


def files(root: Path) -> list[Path]:
    return [path for path in root.rglob("*") if path.is_file()]


def test_a_blob_is_a_file(tmp_path):
    store = LocalBlobs(tmp_path / "blobs")
    store.put(CONTENT)
    path = tmp_path / "blobs" / SHA256[:2] / SHA256[2:4] / SHA256
    assert store.local_path(SHA256) == path
    assert files(store.root) == [path]
    assert path.read_bytes() == CONTENT
    assert path.stat().st_mode & 0o777 == 0o644


def test_equal_content_is_left_alone(tmp_path):
    store = LocalBlobs(tmp_path)
    store.put(CONTENT)
    before = store.local_path(SHA256).stat()
    assert LocalBlobs(tmp_path).put(CONTENT) == SHA256
    after = store.local_path(SHA256).stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)
    assert list(store.iterate()) == [StoredBlob(SHA256, len(CONTENT), before.st_mtime)]


def test_a_writer_that_fails_leaves_no_file(tmp_path):
    def broken():
        yield b"some"
        raise ConnectionError("the upload stopped")

    with pytest.raises(ConnectionError):
        LocalBlobs(tmp_path).put(broken())
    assert files(tmp_path) == []


def test_no_part_of_a_blob_is_ever_visible(tmp_path):
    store = LocalBlobs(tmp_path)

    def pieces():
        for number in range(4):
            assert not store.exists(SHA256)
            yield CONTENT[number * 1750 : (number + 1) * 1750]

    store.put(pieces())
    assert store.exists(SHA256)


def test_a_blob_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    store = LocalBlobs(tmp_path)
    steps = []
    sync, replace = os.fsync, Path.replace
    monkeypatch.setattr(os, "fsync", lambda handle: steps.append("sync") or sync(handle))
    monkeypatch.setattr(Path, "replace", lambda path, target: steps.append("rename") or replace(path, target))
    store.put(CONTENT)
    assert steps[:2] == ["sync", "rename"]


def test_a_reader_keeps_what_is_deleted(tmp_path):
    store = LocalBlobs(tmp_path)
    store.put(CONTENT)
    with store.open(SHA256) as stream:
        assert store.delete(SHA256)
        assert stream.read() == CONTENT


def test_leftovers_of_killed_writers_are_removed(tmp_path):
    store = LocalBlobs(tmp_path)
    store.put(CONTENT)
    old, young = (tmp_path / "incoming" / name for name in ("old", "young"))
    for path in (old, young):
        path.write_bytes(b"part")
    now = time.time()
    os.utime(old, (now - 1000, now - 1000))
    assert store.discard_incoming(before=now - 500) == 1
    assert not old.exists()
    assert young.exists()
    assert store.exists(SHA256)


def test_other_files_are_no_blobs(tmp_path):
    store = LocalBlobs(tmp_path)
    store.put(CONTENT)
    for other in ("ab/cd/notes.txt", f"lost+found/{SHA256}", f"ab/cd/{SHA256}"):
        path = tmp_path / other
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    assert [blob.sha256 for blob in store.iterate()] == [SHA256]


def test_a_folder_that_is_gone_is_told(tmp_path):
    store = LocalBlobs(tmp_path / "blobs")
    store.check()
    assert files(tmp_path) == []
    (tmp_path / "blobs" / "incoming").rmdir()
    with pytest.raises(Unavailable, match="can't be written to"):
        store.check()


def test_the_disk_tells_how_full_it_is(tmp_path):
    usage = LocalBlobs(tmp_path).usage()
    assert (usage.used or 0) > 0
    assert (usage.free or 0) > 0
