"""A server that others reach at https://lines.example.org, and who may ask there."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import make_url

from app.api.application import create_application
from app.clock import utc_now
from app.services.tokens import create_token
from app.settings import Settings

HOME = "https://lines.example.org"
Serve = Callable[..., TestClient]


@pytest.fixture(scope="module")
def serve(sqlite_template: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serve]:
    """Start a hosted server with the settings given; the tests of a file share those that they start."""
    with ExitStack() as stack:

        def serve(**given: Any) -> TestClient:
            folder = tmp_path_factory.mktemp("hosted")
            settings = Settings(data_dir=folder, workers=1, public_url=HOME, **given)
            shutil.copy(sqlite_template, str(make_url(settings.database_address).database))
            application = create_application(settings)
            client = TestClient(application, base_url=HOME, client=("198.51.100.7", 50000))
            return stack.enter_context(client)

        yield serve


@pytest.fixture(scope="module")
def hosted(serve: Serve) -> TestClient:
    return serve()


def server_of(client: TestClient) -> Any:
    return client.app.state.server  # type: ignore[attr-defined]


def token_for(client: TestClient, name: str, role: str) -> dict[str, str]:
    """Return the header of a service token that is made for it."""
    with server_of(client).database.write() as session:
        made = create_token(session, name, role, utc_now(), person=None)
    return {"authorization": f"Bearer {made.text}"}
