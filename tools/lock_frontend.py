"""Write frontend/package-lock.json anew, and refuse one that would not install.

It is made in an empty folder: with packages already there npm leaves out those of other platforms.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from build_frontend import run_npm  # noqa: E402

FRONTEND = ROOT / "frontend"
LOCK = "package-lock.json"


def main() -> None:
    """Make the lock file, try it, and put it in its place."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copy(FRONTEND / "package.json", folder)
        run_npm("install", "--package-lock-only", "--omit-lockfile-registry-resolved", folder=folder)
        run_npm("ci", "--no-audit", "--no-fund", folder=folder)
        if '"resolved"' in (folder / LOCK).read_text():
            raise SystemExit("the lock file names where packages come from")
        shutil.copy(folder / LOCK, FRONTEND / LOCK)


if __name__ == "__main__":
    main()
