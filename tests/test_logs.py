"""The log: one event a line, with what it is about, and without secrets."""

from __future__ import annotations

import io
import json
import logging
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from pydantic import SecretStr
from structlog.contextvars import bound_contextvars

from app.commands.logs import secrets_of
from app.logs import LogFormat, Redaction, configure_logs
from app.settings import Settings

Open = Callable[..., io.StringIO]
TOKEN = "cl_" + "x" * 43


@pytest.fixture
def log_to() -> Iterator[Open]:
    root, own = logging.getLogger(), logging.getLogger("app")
    levels, handlers = (root.level, own.level), list[logging.Handler]()

    def log_to(form: LogFormat, level: str = "debug", known: tuple[str, ...] = ()) -> io.StringIO:
        stream = io.StringIO()
        handlers.append(configure_logs(form, level, redaction=Redaction(known), stream=stream))
        return stream

    yield log_to
    for handler in handlers:
        root.removeHandler(handler)
    root.setLevel(levels[0])
    own.setLevel(levels[1])


def test_json_is_one_object_a_line_with_what_is_bound(log_to: Open) -> None:
    stream = log_to("json")
    logger = logging.getLogger("app.somewhere")
    with bound_contextvars(request_id="r-1"):
        logger.info("request", extra={"status": 200, "viewer": "Ada"})
        logger.error("it failed", exc_info=ValueError("why"))
    first, second = map(json.loads, stream.getvalue().splitlines())
    assert first["event"] == "request"
    assert (first["status"], first["viewer"], first["request_id"]) == (200, "Ada", "r-1")
    assert (first["level"], first["logger"]) == ("info", "app.somewhere")
    assert first["timestamp"].endswith("Z")
    assert "ValueError: why" in second["exception"]


def test_text_is_one_line_an_event_whatever_names_hold(log_to: Open) -> None:
    stream = log_to("text")
    name = "a.png\n2026-01-01T00:00:00Z [error    ] all is lost\x1b[31m"
    logging.getLogger("app.x").warning("%s can't be read", name, extra={"viewer": name})
    (line,) = stream.getvalue().splitlines()
    assert line.count("[warning") == 1
    assert "\x1b" not in line


def test_libraries_tell_warnings_alone(log_to: Open) -> None:
    stream = log_to("json", "debug")
    logging.getLogger("some.library").info("request with all its headers")
    logging.getLogger("some.library").warning("something is wrong")
    assert [json.loads(line)["event"] for line in stream.getvalue().splitlines()] == ["something is wrong"]


def test_the_level_is_that_of_the_settings(log_to: Open) -> None:
    stream = log_to("text", "error")
    logging.getLogger("app.x").warning("not told")
    assert stream.getvalue() == ""


@pytest.mark.parametrize("form", ["text", "json"])
@pytest.mark.parametrize(
    ("text", "secret"),
    [
        ("connect to postgresql://ada:hunter2@db/lines failed", "hunter2"),
        ("connect to postgresql+psycopg://ada:p%40ss@db:5432/lines", "p%40ss"),
        (f"token {TOKEN} is unknown", TOKEN),
        ("Authorization: Bearer abcdefgh12345678", "abcdefgh12345678"),
        ("Cookie: a=b; clearlines_session=oh-so-secret; c=d", "oh-so-secret"),
        ("Set-Cookie: clearlines_token=cl_short; Path=/api", "cl_short"),
        ("[SQL: UPDATE users]\n[parameters: ('$argon2id$v=19$m=65536', 5)]", "argon2id"),
        ("the provider was told sesame", "sesame"),
    ],
)
def test_no_secret_gets_through(log_to: Open, form: LogFormat, text: str, secret: str) -> None:
    stream = log_to(form, known=("sesame",))
    logging.getLogger("app.x").error(text, exc_info=RuntimeError(text), extra={"also": text})
    assert secret not in stream.getvalue()
    assert "***" in stream.getvalue()


def test_an_address_without_password_is_told_whole(log_to: Open) -> None:
    stream = log_to("json")
    logging.getLogger("app.x").info("at postgresql://ada@db:5432/lines and http://127.0.0.1:8765/a@b")
    assert json.loads(stream.getvalue())["event"] == "at postgresql://ada@db:5432/lines and http://127.0.0.1:8765/a@b"


def test_what_the_settings_keep_secret_is_known_to_be_so() -> None:
    settings = Settings(
        data_dir=Path("nowhere"),
        database_url="postgresql://ada:hunter2@db/lines",
        metrics_token=SecretStr("scrape me"),
        openid_issuer="https://id.example.org",
        openid_client_id="lines",
        openid_client_secret=SecretStr("between us"),
        blob_options={
            "key": "AKIA1",
            "client_kwargs": {"aws_secret_access_key": "deeper"},
            "endpoint_url": "http://s3",
        },
    )
    assert secrets_of(settings) == {"hunter2", "scrape me", "between us", "AKIA1", "deeper"}
