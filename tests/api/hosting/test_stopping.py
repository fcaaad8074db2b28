"""What would go on for long ends when the server is to end."""

from __future__ import annotations

import asyncio
import threading
from types import SimpleNamespace
from typing import Any

import pytest

from app.api.routers import submissions
from app.api.waiting import wait_for_validation
from app.commands.serve import EndingServer
from tests.event_loop import run


class Unfinished:
    """A submission that is scored for ever."""

    status = "scoring"

    def model_dump_json(self) -> str:
        return "{}"


async def events_of(server: Any) -> list[Any]:
    return [event async for event in submissions.watch_submission(server, SimpleNamespace(), 1)]  # type: ignore[arg-type]


def test_a_stream_of_events_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    stopping = threading.Event()
    asked: list[int] = []

    def read(*_: object) -> Unfinished:
        asked.append(1)
        if len(asked) == 2:
            stopping.set()
        return Unfinished()

    monkeypatch.setattr(submissions, "_read", read)
    monkeypatch.setattr(submissions, "EVENTS_PAUSE", 0.001)
    events = run(asyncio.wait_for(events_of(SimpleNamespace(stopping=stopping)), 30))
    assert len(events) == 1
    assert len(asked) == 2


def test_nobody_is_waited_for() -> None:
    stopping = threading.Event()
    stopping.set()
    server: Any = SimpleNamespace(stopping=stopping, settings=SimpleNamespace(validation_seconds=3600.0))
    run(asyncio.wait_for(wait_for_validation(server, 1), 30))


def test_the_application_is_told_with_the_signal() -> None:
    stopping = threading.Event()
    server = EndingServer.__new__(EndingServer)
    server._stopping = stopping
    server._captured_signals, server.should_exit, server.force_exit = [], False, False
    server.handle_exit(15, None)
    assert stopping.is_set()
    assert server.should_exit
