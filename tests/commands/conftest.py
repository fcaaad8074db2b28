"""Pictures and commands for the tests of the command line."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def clearlines(tmp_path: Path) -> Run:
    """Run the installed command in a process of its own, in an empty folder."""

    def run(*arguments: object, status: int = 0) -> subprocess.CompletedProcess[str]:
        command = [Path(sys.executable).with_name("clearlines"), *map(str, arguments)]
        environment = {**os.environ, "CLEARLINES_DATA_DIR": str(tmp_path / "data"), "COLUMNS": "200"}
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120)
        assert done.returncode == status, f"{done.stdout}\n{done.stderr}"
        return done

    return run


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
