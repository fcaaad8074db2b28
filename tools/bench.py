"""Run every program in benchmarks/, one after the other: ``tools/bench.py [--json] [--york DIR] [--kitti DIR]``.

Every program is given all arguments. With ``--json`` the last line is one object with every program's figures.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

BENCHMARKS = Path(__file__).resolve().parent.parent / "benchmarks"


def run(program: Path, arguments: list[str]) -> tuple[int, str]:
    """Run one program, showing what it prints; return its exit status and its last line."""
    last = ""
    command = [sys.executable, "-u", str(program), *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            sys.stdout.write(line)
            last = line
    return process.returncode, last


def main() -> int:
    """Run all of them; the exit status is that of the first that failed."""
    failed = 0
    results = {}
    for program in sorted(BENCHMARKS.glob("*.py")):
        print(f"== {program.name}", flush=True)
        status, last = run(program, sys.argv[1:])
        failed = failed or status
        if "--json" in sys.argv and status == 0:
            results[program.stem] = json.loads(last)
    if "--json" in sys.argv:
        met = not failed and all(result["met"] for result in results.values())
        print(json.dumps({"figures": results, "targets": {}, "met": met}))
    return failed


if __name__ == "__main__":
    sys.exit(main())
