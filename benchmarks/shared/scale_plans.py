"""The SQL that a page really sends, and how the database carries it out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from threading import current_thread
from typing import Any

from fastapi.testclient import TestClient
from shared.scale_requests import PageQuery
from sqlalchemy import Engine, event

from app.api.application import create_application
from app.settings import Settings


@dataclass(frozen=True)
class Statement:
    """A statement as the application sent it.

    Attributes:
        text: With the places of its parameters.
        parameters: What stood in them.
    """

    text: str
    parameters: Any


def written_plans(settings: Settings, pages: Sequence[PageQuery]) -> str:
    """Ask the application for each page, and return its statements with the plans of carrying them out."""
    parts = []
    application = create_application(settings)
    with TestClient(application, base_url="http://127.0.0.1") as client:
        engine = application.state.server.database.engine
        for page in pages:
            with _statements_of(engine) as sent:
                client.get(f"/api{page.path(3)}")
            parts.append(f"===== {page.name}: {page.path(3)}\n")
            parts += [f"{statement.text}\n\n{_explained(engine, statement)}\n" for statement in sent]
    return "\n".join(parts)


@contextmanager
def _statements_of(engine: Engine) -> Iterator[list[Statement]]:
    """List the reading statements that an engine sends while the context lasts."""
    sent: list[Statement] = []

    def note(_connection: object, _cursor: object, text: str, parameters: Any, *_rest: object) -> None:
        asked = current_thread().name not in ("dispatcher", "housekeeper", "webhooks", "counting")
        if asked and text.lstrip().upper().startswith(("SELECT", "WITH")):
            sent.append(Statement(text, parameters))

    event.listen(engine, "before_cursor_execute", note)
    try:
        yield sent
    finally:
        event.remove(engine, "before_cursor_execute", note)


def _explained(engine: Engine, statement: Statement) -> str:
    with engine.connect() as connection:
        rows = connection.exec_driver_sql(f"EXPLAIN (ANALYZE, BUFFERS) {statement.text}", statement.parameters)
        return "\n".join(row[0] for row in rows)
