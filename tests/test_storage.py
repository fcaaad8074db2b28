import hashlib
import io
import os
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from app.errors import InvalidInput, NotFound, TooLarge
from app.storage import BlobStore

CONTENT = b"content" * 1000
SHA256 = hashlib.sha256(CONTENT).hexdigest()


def files(root: Path) -> list[Path]:
    return [path for path in root.rglob("*") if path.is_file()]


@pytest.mark.parametrize("content", [CONTENT, io.BytesIO(CONTENT), [CONTENT[:10], b"", CONTENT[10:]]])
def test_content_is_stored_under_its_hash(tmp_path, content):
    store = BlobStore(tmp_path / "blobs")
    assert store.put(content) == SHA256
    assert store.path(SHA256) == tmp_path / "blobs" / SHA256[:2] / SHA256[2:4] / SHA256
    assert store.exists(SHA256)
    assert store.read(SHA256) == CONTENT
    assert store.size(SHA256) == len(CONTENT)
    with store.open(SHA256) as stream:
        assert stream.read(7) == b"content"
    assert files(store.root) == [store.path(SHA256)]


def test_empty_content(tmp_path):
    store = BlobStore(tmp_path)
    assert store.read(store.put(b"")) == b""


def test_equal_content_is_stored_once_and_left_alone(tmp_path):
    store = BlobStore(tmp_path)
    store.put(CONTENT)
    before = store.path(SHA256).stat()
    assert BlobStore(tmp_path).put(CONTENT) == SHA256
    after = store.path(SHA256).stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)


def test_writers_of_the_same_content_do_not_disturb_each_other(tmp_path):
    store = BlobStore(tmp_path)
    contents = [bytes([number]) * 100_000 for number in range(3)]
    with ThreadPoolExecutor(8) as pool:
        keys = list(pool.map(store.put, contents * 10))
    assert len(set(keys)) == 3
    assert len(files(tmp_path)) == 3
    for key, content in zip(keys, contents * 10, strict=True):
        assert store.read(key) == content


def test_a_writer_that_fails_leaves_nothing(tmp_path):
    store = BlobStore(tmp_path)

    def broken():
        yield b"some"
        raise ConnectionError("the upload stopped")

    with pytest.raises(ConnectionError):
        store.put(broken())
    with pytest.raises(TooLarge):
        store.put(CONTENT, limit=len(CONTENT) - 1)
    assert files(tmp_path) == []
    assert store.put(CONTENT, limit=len(CONTENT)) == SHA256


def test_no_part_of_a_blob_is_ever_visible(tmp_path):
    store = BlobStore(tmp_path)

    def pieces():
        for number in range(4):
            assert not store.exists(SHA256)
            yield CONTENT[number * 1750 : (number + 1) * 1750]

    store.put(pieces())
    assert store.exists(SHA256)


def test_a_blob_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    store = BlobStore(tmp_path)
    steps = []
    sync, replace = os.fsync, Path.replace
    monkeypatch.setattr(os, "fsync", lambda handle: steps.append("sync") or sync(handle))
    monkeypatch.setattr(Path, "replace", lambda path, target: steps.append("rename") or replace(path, target))
    store.put(CONTENT)
    assert steps[:2] == ["sync", "rename"]


def test_delete(tmp_path):
    store = BlobStore(tmp_path)
    store.put(CONTENT)
    with store.open(SHA256) as stream:
        assert store.delete(SHA256)
        assert stream.read() == CONTENT
    assert not store.exists(SHA256)
    assert not store.delete(SHA256)
    for use in (store.open, store.read, store.size):
        with pytest.raises(NotFound):
            use(SHA256)


@pytest.mark.parametrize("key", ["", "../../etc/passwd", SHA256.upper(), SHA256 + "0", SHA256 + "\n", "g" * 64])
def test_only_hashes_are_keys(tmp_path, key):
    store = BlobStore(tmp_path)
    for use in (store.path, store.exists, store.open, store.delete):
        with pytest.raises(InvalidInput):
            use(key)


def test_leftovers_of_killed_writers_are_removed(tmp_path):
    store = BlobStore(tmp_path)
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
