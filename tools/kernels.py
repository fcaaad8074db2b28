"""Look after the C kernels: ``tools/kernels.py warnings`` and ``tools/kernels.py sanitize [pytest's arguments]``.

``warnings`` compiles them with every warning an error, which an installation on somebody's machine never does.
``sanitize`` runs the detector's and the painter's tests with kernels in which gcc checks each memory access and each
operation whose result C leaves undefined.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from build_native import CompileError, build_library, find_compiler, library_name  # noqa: E402

STRICT = ("-Werror", "-Wpedantic", "-Wshadow", "-Wstrict-prototypes", "-Wvla")
SANITIZERS = ("-O1", "-g", "-fno-omit-frame-pointer", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
TESTS = ("tests/vision", "tests/synthesis/test_painting.py")
LOADED = """
import sys
import numpy as np
from app.vision import detect
detect(np.zeros((64, 64), np.uint8))
sys.exit(sys.argv[1] not in open("/proc/self/maps").read())
"""


def check_warnings(folder: Path) -> int:
    """Compile with warnings as errors; return the exit status."""
    if find_compiler(os.environ) is None:
        print("no C compiler on this machine: the kernels' warnings were not checked")
        return 0
    build_library(ROOT, output=folder / library_name(), flags=STRICT)
    return 0


def sanitizer_runtime() -> Path:
    """Return gcc's library that has to be loaded before Python."""
    compiler = find_compiler(os.environ)
    if not sys.platform.startswith("linux") or compiler is None:
        raise SystemExit("the sanitizers need Linux and gcc")
    command = [*compiler, "-print-file-name=libasan.so"]
    runtime = Path(subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip())
    if not runtime.is_absolute():
        raise SystemExit(f"{compiler[0]} has no libasan.so: install gcc with its sanitizers, and set CC=gcc")
    return runtime


def run_sanitized(folder: Path, arguments: list[str]) -> int:
    """Run the kernels' tests, after a look whether they would use the library made for them; return the status."""
    runtime = sanitizer_runtime()
    library = build_library(ROOT, output=folder / library_name(), flags=SANITIZERS)
    environment = {
        **os.environ,
        "LD_PRELOAD": str(runtime),
        "CLEARLINES_KERNELS": str(library),
        # Python and its libraries keep memory until the end, so leaks can't be told from that
        "ASAN_OPTIONS": "detect_leaks=0",
        "UBSAN_OPTIONS": "print_stacktrace=1",
    }
    loaded = subprocess.run([sys.executable, "-c", LOADED, str(library)], cwd=ROOT, env=environment)
    if loaded.returncode != 0:
        print(f"detect() failed, or did not load what CLEARLINES_KERNELS names: {library}", file=sys.stderr)
        return 1
    tests = [sys.executable, "-m", "pytest", *TESTS, "-q", *arguments]
    return subprocess.run(tests, cwd=ROOT, env=environment).returncode


def main() -> int:
    task, *arguments = sys.argv[1:] or [""]
    with tempfile.TemporaryDirectory() as folder:
        if task == "warnings":
            return check_warnings(Path(folder))
        if task == "sanitize":
            return run_sanitized(Path(folder), arguments)
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    try:
        sys.exit(main())
    except CompileError as failed:
        sys.exit(str(failed))
