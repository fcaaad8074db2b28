"""Pictures and commands for the tests of the command line."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.cli import main

Done = subprocess.CompletedProcess[str]
Run = Callable[..., Done]
INSTALLED = Path(sys.executable).with_name("clearlines")


@pytest.fixture
def clearlines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Run]:
    """Run the command as its entry point does, in this process: a new one would spend seconds on its imports."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CLEARLINES_DATA_DIR", str(tmp_path / "data"))
    on_terminate = signal.getsignal(signal.SIGTERM)

    def run(*arguments: object, status: int = 0) -> Done:
        monkeypatch.setattr(sys, "argv", ["clearlines", *map(str, arguments)])
        out, err = io.StringIO(), io.StringIO()
        code = 0
        with redirect_stdout(out), redirect_stderr(err):
            try:
                main()
            except SystemExit as end:
                code = end.code if isinstance(end.code, int) else 1
        assert code == status, f"{out.getvalue()}\n{err.getvalue()}"
        return subprocess.CompletedProcess(sys.argv, code, out.getvalue(), err.getvalue())

    yield run
    signal.signal(signal.SIGTERM, on_terminate)


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start the installed command in a process of its own, in an empty folder; at the end it is killed."""
    running: list[subprocess.Popen[str]] = []

    def start(*arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [INSTALLED, *map(str, arguments)],
            cwd=tmp_path,
            env={**os.environ, "CLEARLINES_DATA_DIR": str(tmp_path / "data"), "CLEARLINES_WORKERS": "1"},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        running.append(process)
        return process

    yield start
    for process in running:
        process.kill()
        process.communicate()


@pytest.fixture
def street(tmp_path: Path) -> Path:
    """A folder with two pictures of long edges in a subfolder."""
    folder = tmp_path / "street"
    (folder / "a").mkdir(parents=True)
    for seed, name in enumerate(("one", "two")):
        rng = np.random.default_rng(seed)
        image = np.full((240, 320), 90, np.uint8)
        for x in (30, 120, 210):
            cv2.rectangle(image, (x, 20), (x + 50, 220), int(rng.integers(150, 255)), -1, cv2.LINE_AA)
        cv2.imwrite(str(folder / "a" / f"{name}.png"), image)
    return folder
