"""What is an extra isn't needed by who doesn't ask for it."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
MODULES = {"cluster": "distributed", "oidc": "joserfc", "postgres": "psycopg", "s3": "s3fs"}


def test_every_extra_is_known_here() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert set(project["optional-dependencies"]) - {"dev"} == set(MODULES)


def test_a_server_without_any_extra_answers(tmp_path: Path) -> None:
    program = f"""
import sys
for name in {list(MODULES.values())}:
    sys.modules[name] = None  # as where it isn't installed
from fastapi.testclient import TestClient
import app.cli
from app.api.application import create_application
from app.settings import Settings
application = create_application(Settings(data_dir={str(tmp_path)!r}, anonymous_role="reader"))
with TestClient(application, base_url="http://127.0.0.1:8765") as client:
    print(client.get("/api/ready").status_code, client.get("/api/session/providers").json())
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False)
    assert (done.stdout.strip(), done.returncode) == ("200 []", 0), done.stderr
