"""The wheel is whole: made from a source distribution, it serves the browser tool, knows its tables and detects."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from packaging.tags import sys_tags
from packaging.utils import parse_wheel_filename

from build_native import NATIVE, find_compiler, library_name

ROOT = Path(__file__).resolve().parent.parent.parent
SOURCES = (
    *("pyproject.toml", "build_hook.py", "build_frontend.py", "build_native.py"),
    *("README.md", "LICENSE", "CHANGELOG.md"),
)
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
DETECT = """
import app, sys
import numpy as np
from app.vision import detect
assert app.__file__.startswith(sys.argv[1]), app.__file__
image = np.full((240, 320), 60, np.uint8)
image[:, 160:] = 180
assert len(detect(image)) == 1
"""


def run(command: list[str | Path], folder: Path, environment: dict[str, str] | None = None) -> None:
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, f"{done.stdout}\n{done.stderr}"


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a source distribution as somebody would who has built everything in the tree, and unpack it."""
    folder = tmp_path_factory.mktemp("sources")
    copy = folder / "copy"
    copy.mkdir()
    for name in SOURCES:
        shutil.copy(ROOT / name, copy)
    for name in ("app", "frontend"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__", "node_modules"))
    run([sys.executable, "-m", "hatchling", "build", "--target", "sdist", "--directory", folder], copy)
    with tarfile.open(next(folder.glob("*.tar.gz"))) as archive:
        archive.extractall(folder / "unpacked", filter="data")
    return next((folder / "unpacked").iterdir())


@pytest.fixture(scope="module")
def wheel(sources: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the wheel from the source distribution."""
    folder = tmp_path_factory.mktemp("wheel")
    (sources / "frontend" / "node_modules").symlink_to(ROOT / "frontend" / "node_modules")
    if find_compiler(os.environ) is None:
        # only a build in an environment of its own fetches one; what was made so for the tree will do
        for path in (ROOT / NATIVE).glob("_kernels.*"):
            shutil.copy(path, sources / NATIVE)
    run([sys.executable, "-m", "hatchling", "build", "--target", "wheel", "--directory", folder], sources)
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="module")
def unpacked(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Unpack the wheel, as an installation does."""
    folder = tmp_path_factory.mktemp("installed")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def test_the_source_distribution_has_the_kernels_sources_and_nothing_built(sources: Path) -> None:
    for pattern in ("*.c", "*.h"):
        names = {path.name for path in (ROOT / NATIVE).glob(pattern)}
        assert names
        assert {path.name for path in (sources / NATIVE).glob(pattern)} == names
    assert not list((sources / "app").rglob("_kernels.*"))
    assert not (sources / "app" / "static").exists()


def test_the_wheel_is_for_any_python_3_on_this_platform(wheel: Path, unpacked: Path) -> None:
    (tag,) = parse_wheel_filename(wheel.name)[3]
    assert (tag.interpreter, tag.abi) == ("py3", "none")
    assert tag.platform != "any"
    assert tag in set(sys_tags())
    metadata = next(unpacked.glob("*.dist-info")) / "WHEEL"
    assert f"Root-Is-Purelib: false\nTag: {tag}\n" in metadata.read_text()


def test_the_wheel_has_what_was_built_and_none_of_what_it_was_built_of(unpacked: Path) -> None:
    names = {path.relative_to(unpacked).as_posix() for path in unpacked.rglob("*") if path.is_file()}
    assert "app/static/index.html" in names
    assert "app/db/migrations/versions/0001_first_tables.py" in names
    assert {name for name in names if "_kernels" in name} == {f"app/vision/native/{library_name()}"}
    assert not [name for name in names if "node_modules" in name or name.startswith(("tests/", "frontend/", "build_"))]
    assert not [name for name in names if name.endswith((".c", ".h"))]


def test_the_wheel_serves_the_tool_and_makes_its_tables(unpacked: Path, tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(unpacked)}
    run([sys.executable, "-W", "ignore", "-c", SERVE, unpacked, tmp_path / "data"], tmp_path, environment)


def test_the_wheel_detects_with_its_own_kernels(unpacked: Path, tmp_path: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "CLEARLINES_KERNELS"}
    run([sys.executable, "-c", DETECT, unpacked], tmp_path, {**environment, "PYTHONPATH": str(unpacked)})
