"""The OpenAPI document that the browser tool's types are made from is the server's own."""

from __future__ import annotations

import json
from pathlib import Path

from fastapi.testclient import TestClient

from app.api.application import create_application
from app.settings import Settings

KEPT = Path(__file__).resolve().parent.parent.parent / "frontend" / "src" / "api" / "openapi.json"


def test_the_kept_document_is_the_server_s(client: TestClient) -> None:
    served = client.get("/api/openapi.json").json()
    served["info"]["version"] = "0"
    assert json.loads(KEPT.read_text()) == served, "run `make openapi` and commit what it writes"


def test_a_database_keeps_its_name_and_another_has_another(settings: Settings, tmp_path: Path) -> None:
    def instance(folder: Path) -> str:
        with TestClient(
            create_application(settings.model_copy(update={"data_dir": folder})), base_url="http://127.0.0.1"
        ) as client:
            return client.get("/api/configuration").json()["instance"]

    first = instance(tmp_path / "one")
    assert instance(tmp_path / "one") == first
    assert instance(tmp_path / "two") != first
