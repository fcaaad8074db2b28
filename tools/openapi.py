"""Write the server's OpenAPI document to where the browser tool's types are made from it."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

from app.api.application import create_application
from app.settings import Settings

TARGET = Path(__file__).resolve().parent.parent / "frontend" / "src" / "api" / "openapi.json"


def openapi_text() -> str:
    """Return the document as it is kept in git: stable order, without the version that changes at each release."""
    with tempfile.TemporaryDirectory() as folder:
        document = create_application(Settings(data_dir=Path(folder))).openapi()
    document["info"]["version"] = "0"
    return json.dumps(document, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    TARGET.write_text(openapi_text())
