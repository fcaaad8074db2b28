"""The wheel is whole: made from a clean copy of the sources, it serves the browser tool and knows its tables."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
SOURCES = ("pyproject.toml", "build_frontend.py", "README.md", "LICENSE", "CHANGELOG.md")
SERVE = """
from fastapi.testclient import TestClient
from app.api.application import create_application
from app.settings import Settings
import app, sys
assert app.__file__.startswith(sys.argv[1]), app.__file__
with TestClient(create_application(Settings(data_dir=sys.argv[2])), base_url="http://127.0.0.1") as client:
    page = client.get("/datasets/any", headers={"accept": "text/html"})
    assert page.status_code == 200 and "<div id=" in page.text, page.text
    script = page.text.split('src="')[1].split('"')[0]
    assert client.get(script).status_code == 200, script
    assert client.post("/api/datasets", json={"name": "street"}).status_code == 201
"""


@pytest.fixture
def wheel(tmp_path: Path) -> Path:
    """Build the wheel from a copy without anything that was built before."""
    copy = tmp_path / "sources"
    copy.mkdir()
    for name in SOURCES:
        shutil.copy(ROOT / name, copy)
    shutil.copytree(ROOT / "app", copy / "app", ignore=shutil.ignore_patterns("static", "__pycache__"))
    shutil.copytree(ROOT / "frontend", copy / "frontend", ignore=shutil.ignore_patterns("node_modules"))
    (copy / "frontend" / "node_modules").symlink_to(ROOT / "frontend" / "node_modules")
    command = [sys.executable, "-m", "hatchling", "build", "--target", "wheel", "--directory", tmp_path / "dist"]
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True)
    assert done.returncode == 0, f"{done.stdout}\n{done.stderr}"
    return next((tmp_path / "dist").glob("*.whl"))


def test_the_wheel_serves_the_tool_and_makes_its_tables(wheel: Path, tmp_path: Path) -> None:
    unpacked = tmp_path / "unpacked"
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        archive.extractall(unpacked)
    assert "app/static/index.html" in names
    assert "app/db/migrations/versions/0001_first_tables.py" in names
    assert not [name for name in names if "node_modules" in name or name.startswith(("tests/", "frontend/"))]
    environment = {**os.environ, "PYTHONPATH": str(unpacked)}
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", SERVE, unpacked, tmp_path / "data"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
