"""Run a program of frontend/node_modules with the Node of the PyPI wheel: ``tools/node.py biome check .``"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from build_frontend import install_packages, node_environment  # noqa: E402


def main() -> int:
    name, *arguments = sys.argv[1:]
    frontend = ROOT / "frontend"
    environment = node_environment()
    install_packages(frontend)
    folders = f"{frontend / 'node_modules' / '.bin'}:{environment['PATH']}"
    program = shutil.which(name, path=folders)
    if program is None:
        sys.stderr.write(f"{name}: not among the packages of frontend/package.json\n")
        return 127
    return subprocess.run([program, *arguments], cwd=frontend, env={**environment, "PATH": folders}).returncode


if __name__ == "__main__":
    sys.exit(main())
