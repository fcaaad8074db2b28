"""What holds for blobs wherever they lie."""

import hashlib
import io
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.errors import InvalidInput, NotFound, TooLarge

CONTENT = b"content" * 1000
SHA256 = hashlib.sha256(CONTENT).hexdigest()
NOTHING = "0" * 64


@pytest.mark.parametrize("given", [bytes, io.BytesIO, lambda content: [content[:10], b"", content[10:]]])
def test_content_is_stored_under_its_hash(store, given):
    assert not store.exists(SHA256)
    assert store.put(given(CONTENT)) == SHA256
    assert store.exists(SHA256)
    assert store.read(SHA256) == CONTENT
    assert store.size(SHA256) == len(CONTENT)
    with store.open(SHA256) as stream:
        assert stream.read(7) == b"content"
        assert stream.read() == CONTENT[7:]


def test_empty_content(store):
    sha256 = store.put(b"")
    assert (store.read(sha256), store.size(sha256)) == (b"", 0)
    with store.open(sha256) as stream:
        assert stream.read() == b""


def test_equal_content_is_stored_once(store):
    store.put(CONTENT)
    (before,) = store.iterate()
    assert store.put([CONTENT]) == SHA256
    assert list(store.iterate()) == [before]
    assert (before.sha256, before.size) == (SHA256, len(CONTENT))
    assert abs(before.modified - time.time()) < 60


def test_writers_of_the_same_content_do_not_disturb_each_other(store):
    contents = [bytes([number]) * 100_000 for number in range(3)]
    with ThreadPoolExecutor(4) as pool:
        keys = list(pool.map(store.put, contents * 4))
    assert len(list(store.iterate())) == 3
    for key, content in zip(keys, contents * 4, strict=True):
        assert store.read(key) == content


def test_a_writer_that_fails_leaves_nothing(store):
    def broken():
        yield b"some"
        raise ConnectionError("the upload stopped")

    with pytest.raises(ConnectionError):
        store.put(broken())
    for content in (CONTENT, [CONTENT], io.BytesIO(CONTENT)):
        with pytest.raises(TooLarge):
            store.put(content, limit=len(CONTENT) - 1)
    assert list(store.iterate()) == []
    assert store.discard_incoming(before=time.time() + 60) == 0
    assert store.put(CONTENT, limit=len(CONTENT)) == SHA256


def test_what_is_not_there(store):
    store.put(CONTENT)
    assert store.delete(SHA256)
    for sha256 in (SHA256, NOTHING):
        assert not store.exists(sha256)
        assert not store.delete(sha256)
        for use in (store.open, store.read, store.size):
            with pytest.raises(NotFound, match="there is no such blob"):
                use(sha256)


def test_many_are_deleted_at_once(store):
    names = [store.put(bytes([number])) for number in range(5)]
    store.delete_all([*names[:3], NOTHING])
    assert [blob.sha256 for blob in store.iterate()] == sorted(names[3:])
    assert store.delete_all([]) == 0


def test_only_hashes_are_keys(store):
    for key in ("", "../../etc/passwd", SHA256.upper(), SHA256 + "0", SHA256 + "\n", "g" * 64):
        for use in (store.local_path, store.exists, store.open, store.read, store.size, store.delete):
            with pytest.raises(InvalidInput, match="this is no SHA-256"):
                use(key)


def test_an_empty_store_lists_nothing_and_can_be_used(store):
    assert list(store.iterate()) == []
    store.check()
    assert list(store.iterate()) == []  # what the check wrote is no blob


@pytest.mark.parametrize("source", ["folder", "s3"])
def test_a_store_is_copied_into_another(store, make_store, source):
    contents = [b"", b"a", CONTENT]
    other = make_store(source)
    for content in contents:
        other.put(content)
    for blob in other.iterate():
        with other.open(blob.sha256) as stream:
            assert store.put(stream) == blob.sha256
    expected = sorted((hashlib.sha256(content).hexdigest(), len(content)) for content in contents)
    assert [(blob.sha256, blob.size) for blob in store.iterate()] == expected


contents = st.integers(0, 5).map(lambda number: bytes([number]) * number)
steps = st.lists(st.tuples(st.sampled_from(["put", "stream", "delete", "delete all"]), contents), max_size=6)


@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(steps=steps)
def test_a_store_is_a_dictionary_of_contents(store, steps):
    expected: dict[str, bytes] = {}
    store.delete_all([blob.sha256 for blob in store.iterate()])
    for step, content in steps:
        sha256 = hashlib.sha256(content).hexdigest()
        if step == "delete":
            assert store.delete(sha256) == (sha256 in expected)
            expected.pop(sha256, None)
        elif step == "delete all":
            store.delete_all(list(expected))
            expected.clear()
        else:
            assert store.put(content if step == "put" else [content]) == sha256
            expected[sha256] = content
        assert store.exists(sha256) == (sha256 in expected)
    listed = [(blob.sha256, blob.size) for blob in store.iterate()]
    assert listed == [(key, len(expected[key])) for key in sorted(expected)]
    assert {key: store.read(key) for key in expected} == expected
