"""Webhooks reach what they should, and nothing else."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

from app.db.models import Blob, Method, Split, SplitVersion, Submission
from app.db.session import Database
from app.errors import InvalidInput, Unavailable
from app.jobs.webhooks import Webhooks
from app.services.webhook_deliveries import deliveries_due
from app.services.webhook_sending import check_webhook_url, send_webhook
from app.settings import Settings

NOW = datetime(2026, 5, 1, 12, 0, tzinfo=UTC)


class Listener:
    """A server on this machine that notes what it is sent and answers as it is told."""

    def __init__(self, answer: int = 204, location: str | None = None) -> None:
        self.received: list[tuple[str, str, dict[str, Any]]] = []
        listener = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["Content-Length"]))
                listener.received.append((self.path, self.headers["Host"], json.loads(body)))
                self.send_response(answer)
                if location:
                    self.send_header("Location", location)
                self.send_header("Content-Length", "0")
                self.end_headers()

            def log_message(self, format: str, *args: Any) -> None:  # noqa: A002 - the name it has there
                pass

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.thread = threading.Thread(target=self.server.serve_forever, args=(0.02,), daemon=True)
        self.thread.start()
        self.url = f"http://localhost:{self.server.server_port}/hook?key=1"

    def close(self) -> None:
        self.server.shutdown()
        self.thread.join()
        self.server.server_close()


@pytest.fixture
def listen() -> Iterator[Callable[..., Listener]]:
    made: list[Listener] = []

    def listen(*args: Any, **options: Any) -> Listener:
        made.append(Listener(*args, **options))
        return made[-1]

    yield listen
    for listener in made:
        listener.close()


@pytest.mark.parametrize(
    "url",
    [
        "http://127.0.0.1:{port}/",
        "http://localhost:{port}/",
        "http://[::1]:{port}/",
        "http://0.0.0.0:{port}/",
        "http://127.1:{port}/",
        "http://2130706433:{port}/",
        "http://[::ffff:127.0.0.1]:{port}/",
        "http://[64:ff9b::7f00:1]:{port}/",
        "http://[2002:7f00:1::]:{port}/",
        "http://169.254.169.254/latest/meta-data/",
        "http://10.0.0.1/",
        "http://192.168.1.1/",
        "http://100.64.0.1/",
        "http://224.0.0.1/",
    ],
)
def test_addresses_of_this_machine_and_its_network_are_refused(url: str, listen) -> None:
    listener = listen()
    with pytest.raises((InvalidInput, Unavailable)) as caught:
        send_webhook(url.format(port=listener.server.server_port), {}, seconds=2, allow_private=False)
    assert isinstance(caught.value, InvalidInput) or "resolved" in caught.value.message
    assert listener.received == []


@pytest.mark.parametrize(
    "url",
    [
        *("file:///etc/passwd", "ftp://example.org/", "gopher://example.org/", "http://", "https:///path", "x", ""),
        *(
            "http://user:word@example.org/",
            "http://example.org:0/",
            "http://exa mple.org/",
            "http://example.org:99999/",
        ),
        *("http://example.org/\r\nHost: other", "http://[", "http://example.org/" + "x" * 2_000),
    ],
)
def test_what_is_no_web_address_is_refused(url: str) -> None:
    with pytest.raises(InvalidInput):
        check_webhook_url(url)


def test_a_redirect_is_not_followed(listen) -> None:
    second = listen()
    first = listen(302, second.url)
    assert send_webhook(first.url, {"a": 1}, seconds=5, allow_private=True) == 302
    assert first.received == [("/hook?key=1", f"localhost:{first.server.server_port}", {"a": 1})]
    assert second.received == []


def test_nobody_there_is_an_error_of_ours() -> None:
    with pytest.raises(Unavailable):
        send_webhook("http://localhost:9/", {}, seconds=2, allow_private=True)


@pytest.fixture
def scored(sqlite_database: Database) -> Callable[[str], int]:
    """Store a scored submission with a webhook."""

    def scored(url: str) -> int:
        with sqlite_database.write() as session:
            session.add(Blob(sha256="0" * 64, size=1, media_type="x/x", created_at=NOW))
            split = Split(slug="s", name="S", min_length=0, visibility="open", daily_limit=1, created_at=NOW)
            method = Method(slug="m", name="M", kind="method", created_at=NOW)
            session.add_all([split, method])
            session.flush()
            version = SplitVersion(
                split_id=split.id,
                number=1,
                truth_sha256="0" * 64,
                truth_hash="0" * 64,
                n_images=1,
                n_labels=1,
                n_ambiguous=0,
                created_at=NOW,
            )
            session.add(version)
            session.flush()
            row = Submission(
                split_version_id=version.id, method_id=method.id, status="scored", webhook_url=url, created_at=NOW
            )
            session.add(row)
            session.flush()
            return row.id

    return scored


def webhooks(database: Database, folder: Path, **settings: Any) -> Webhooks:
    given = Settings(data_dir=folder, webhook_seconds=2, webhook_private_addresses=True, **settings)
    return Webhooks(database, given, lambda: NOW, pause=0.01)


def log_of(database: Database, submission: int) -> list[str]:
    with database.read() as session:
        row = session.get_one(Submission, submission)
        assert row.status == "scored"
        return [line["text"] for line in row.log or []]


def test_a_webhook_is_sent_once(sqlite_database: Database, tmp_path: Path, listen, scored) -> None:
    listener = listen()
    submission = scored(listener.url)
    sender = webhooks(sqlite_database, tmp_path)
    assert [sender.send_due(), sender.send_due()] == [1, 0]
    ((_, _, told),) = listener.received
    assert (told["submission"], told["status"], told["method"], told["split"]) == (submission, "scored", "m", "s")
    assert log_of(sqlite_database, submission) == ["webhook sent, answered with 204"]


def test_a_failing_webhook_is_tried_three_times_and_harms_nothing(
    sqlite_database: Database, tmp_path: Path, listen, scored
) -> None:
    listener = listen(500)
    submission = scored(listener.url)
    assert webhooks(sqlite_database, tmp_path).send_due() == 1
    assert len(listener.received) == 3
    assert log_of(sqlite_database, submission) == ["webhook failed: answered with 500"]


def test_what_is_a_day_old_is_not_told_any_more(sqlite_database: Database, scored) -> None:
    scored("http://localhost/")
    with sqlite_database.read() as session:
        assert len(deliveries_due(session, since=NOW - timedelta(days=1))) == 1
        assert deliveries_due(session, since=NOW + timedelta(seconds=1)) == []
