"""A server of objects that fails, in as many ways as servers do."""

from __future__ import annotations

import hashlib
import random
import selectors
import signal
import socket
import socketserver
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any, cast

import pytest

from app.errors import NotFound, Unavailable
from app.storage import BlobStore, open_blobs_at

CONTENT = random.Random(1).randbytes(600_000)
SHA256 = hashlib.sha256(CONTENT).hexdigest()
ONCE = {"retries": {"mode": "standard", "max_attempts": 1}}


class Line(socketserver.BaseRequestHandler):
    """A connection to the server that breaks when so many bytes have gone there."""

    def handle(self) -> None:
        relay = cast("Relay", self.server)
        try:
            there = socket.create_connection(("127.0.0.1", relay.target))
        except ConnectionRefusedError:
            return
        with there, selectors.DefaultSelector() as both:
            both.register(self.request, selectors.EVENT_READ, there)
            both.register(there, selectors.EVENT_READ, self.request)
            sent = 0
            while True:
                for key, _ in both.select():
                    try:
                        piece = key.fileobj.recv(2**16)  # type: ignore[union-attr]
                    except ConnectionError:
                        return
                    if not piece:
                        return
                    key.data.sendall(piece)
                    sent += len(piece) if key.data is there else 0
                if sent > relay.most:
                    relay.at_break()
                    return


class Relay(socketserver.ThreadingTCPServer):
    """Passes connections on to the server, each only so far."""

    block_on_close = True

    def __init__(self, target: int, most: int, at_break: Callable[[], None]) -> None:
        super().__init__(("127.0.0.1", 0), Line)
        self.target = target
        self.most = most
        self.at_break = at_break


@contextmanager
def relayed(server: Any, most: int, at_break: Callable[[], None] = lambda: None) -> Iterator[str]:
    with Relay(server.port, most, at_break) as passing:
        thread = threading.Thread(target=passing.serve_forever, args=(0.02,))
        thread.start()
        try:
            yield f"http://127.0.0.1:{passing.server_address[1]}"
        finally:
            passing.shutdown()
            thread.join()


@pytest.fixture
def opened(object_server, tmp_path: Path, monkeypatch) -> Iterator[Callable[..., BlobStore]]:
    """Open a store on the server, which tries nothing twice, with other options where they are given."""
    monkeypatch.setattr("app.storage.addresses.S3_TRIES", 1)
    stores: list[BlobStore] = []

    def open_one(bucket: str, **options: Any) -> BlobStore:
        given = {**object_server.options, "config_kwargs": ONCE, **options}
        stores.append(open_blobs_at(f"s3://{bucket}/blobs", given, folder=tmp_path))
        return stores[-1]

    yield open_one
    for store in stores:
        store.close()


def told(use: Callable[[], Any]) -> str:
    """What is said when something can't be done now, and can be tried again."""
    with pytest.raises(Unavailable) as caught:
        use()
    assert caught.value.status == 503
    text = "".join(traceback.format_exception(caught.value))
    assert "Traceback" not in text.replace("Traceback", "", 1)  # nothing of the library's own errors
    return str(caught.value)


@pytest.mark.parametrize("content", [CONTENT, [CONTENT[:1000], CONTENT[1000:]]], ids=["bytes", "stream"])
def test_a_line_that_breaks_in_the_middle_of_an_upload_leaves_nothing(object_server, opened, content) -> None:
    bucket = object_server.make_bucket()
    straight = opened(bucket)
    with relayed(object_server, 200_000) as address:
        broken = opened(bucket, endpoint_url=address)
        assert "can't be reached" in told(lambda: broken.put(content))
    assert list(straight.iterate()) == []
    assert not straight.exists(SHA256)
    assert straight.put(content) == SHA256
    assert straight.read(SHA256) == CONTENT


def test_a_server_that_is_killed_in_the_middle_of_an_upload(object_server, opened) -> None:
    bucket = object_server.make_bucket()
    with relayed(object_server, 200_000, lambda: object_server.send(signal.SIGKILL)) as address:
        store = opened(bucket, endpoint_url=address)
        small = store.put(b"small")
        with store.open(small) as stream:
            told(lambda: store.put(CONTENT))
            told(stream.read)  # what was to come isn't taken for the end
        for use in (store.exists, store.read):
            assert "can't be reached" in told(lambda use=use: use(SHA256))
        told(lambda: list(store.iterate()))
    object_server.start()
    again = opened(object_server.make_bucket())
    assert not again.exists(SHA256)
    assert again.put(CONTENT) == SHA256
    assert again.read(SHA256) == CONTENT


def test_a_server_that_does_not_answer_is_not_waited_for(object_server, opened, monkeypatch) -> None:
    monkeypatch.setattr("app.storage.remote.CHECK_SECONDS", 0.3)
    bucket = object_server.make_bucket()
    store = opened(bucket, config_kwargs={**ONCE, "read_timeout": 0.3})
    object_server.send(signal.SIGSTOP)
    try:
        assert "doesn't answer in time" in told(opened(bucket).check)
        assert "doesn't answer in time" in told(lambda: store.put(CONTENT))
    finally:
        object_server.send(signal.SIGCONT)
    assert opened(bucket).put(CONTENT) == SHA256


def test_a_bucket_that_is_not_there_is_not_an_empty_one(opened) -> None:
    store = opened("no-such-bucket")
    uses = (
        store.check,
        lambda: store.put(CONTENT),
        lambda: store.put([CONTENT]),
        lambda: store.read(SHA256),
        lambda: store.open(SHA256),
        lambda: store.size(SHA256),
        lambda: store.exists(SHA256),
        lambda: store.delete(SHA256),
        lambda: store.delete_all([SHA256]),
        lambda: list(store.iterate()),
    )
    for use in uses:
        said = told(use)
        assert said.startswith("s3://no-such-bucket/blobs: the store of the uploaded files isn't there")
        assert "hint: make it" in said


@pytest.mark.parametrize("wrong", ["key", "secret"])
def test_wrong_credentials_are_told_and_not_shown(object_server, opened, wrong: str, caplog) -> None:
    bucket = object_server.make_bucket()
    given = "AKIAWRONGWRONGWRONG"
    store = opened(bucket, **{wrong: given})
    for use in (store.check, lambda: store.put(CONTENT), lambda: store.exists(SHA256), lambda: list(store.iterate())):
        said = told(use)
        assert "refuses" in said
        assert "CLEARLINES_BLOB_OPTIONS" in said
        for secret in (given, object_server.options["key"], object_server.options["secret"]):
            assert secret not in said
    assert given not in caplog.text
    with closing(opened(bucket)) as right, pytest.raises(NotFound):
        right.read(SHA256)
