"""The browser tool is built again when anything it is made of has changed, and only then."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from build_frontend import is_current

BUILT = 1000.0


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A built project: every source, and every folder, is older than the page."""
    for name in ("frontend/src/pages/label.tsx", "frontend/package.json", "frontend/index.html", "app/index.html"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    for path in tmp_path.rglob("*"):
        os.utime(path, (BUILT - 1, BUILT - 1))
    os.utime(tmp_path / "app" / "index.html", (BUILT, BUILT))
    return tmp_path


def test_what_is_newer_than_its_sources_is_left_alone(project: Path) -> None:
    assert is_current(project / "frontend", project / "app" / "index.html")


@pytest.mark.parametrize(
    "change",
    [
        lambda root: (root / "frontend" / "src" / "pages" / "label.tsx").write_text("new"),
        lambda root: (root / "frontend" / "src" / "pages" / "label.tsx").unlink(),
        lambda root: (root / "frontend" / "package.json").write_text("{}"),
        lambda root: (root / "app" / "index.html").unlink(),
    ],
    ids=["changed", "removed", "packages", "never built"],
)
def test_it_is_built_again_after(project: Path, change: Callable[[Path], object]) -> None:
    change(project)
    assert not is_current(project / "frontend", project / "app" / "index.html")
