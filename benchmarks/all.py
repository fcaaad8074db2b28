"""Run every benchmark, one after the other: ``python benchmarks/all.py [--json]``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
NOT_PROGRAMS = {"all.py", "reporting.py"}


def main() -> int:
    failed = 0
    for program in sorted(path for path in HERE.glob("*.py") if path.name not in NOT_PROGRAMS):
        print(f"== {program.name}", flush=True)
        failed |= subprocess.run([sys.executable, str(program), *sys.argv[1:]]).returncode
    return failed


if __name__ == "__main__":
    sys.exit(main())
