"""discorpy (Vo, Atwood and Drakopoulos 2015) on chessboards, in an environment of its own.

It takes evenly spaced rows and columns of a target seen in one photo, so lines of a scene are nothing for it. Its
factors carry corrected points to measured ones: ``r_d = r_u (f0 + f1 r_u + f2 r_u^2)``.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from shared.peers import TOOLS, PeersUnavailable

VERSION = "1.7.0"
WORKER = Path(__file__).with_name("discorpy_worker.py")
LONGEST_SECONDS = 600.0
STEPS = 100


@dataclass(frozen=True)
class RadialLens:
    """discorpy's backward model."""

    center: tuple[float, float]
    factors: tuple[float, ...]

    def undistort(self, points: ArrayLike) -> NDArray[np.float64]:
        """Map measured points ``(N, 2)`` in px to corrected ones, by fixed-point iteration."""
        offset = np.asarray(points, np.float64).reshape(-1, 2) - self.center
        measured = np.hypot(*offset.T)
        radius = measured.copy()
        with np.errstate(all="ignore"):
            for _ in range(STEPS):
                radius = measured / np.polynomial.polynomial.polyval(radius, self.factors)
        return self.center + offset * (radius / np.maximum(measured, 1e-12))[:, None]


def discorpy_lenses(boards: Sequence[NDArray[np.float64]]) -> list[RadialLens | None]:
    """Return the lens of each photo's corners ``(rows, columns, 2)``; ``None`` where discorpy finds none.

    Raises:
        PeersUnavailable: When discorpy can't be installed or run here.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "boards.npy"
        np.save(path, np.stack(boards))
        printed = _run([str(_interpreter()), str(WORKER), str(path)])
    found = json.loads(printed.splitlines()[-1])
    return [None if each is None else RadialLens((each[0], each[1]), tuple(each[2])) for each in found]


def _interpreter() -> Path:
    folder = TOOLS / "discorpy"
    interpreter = folder / "bin" / "python"
    stamp = folder / "installed.txt"
    if stamp.is_file():
        return interpreter
    uv = shutil.which("uv") or shutil.which("uv", path=str(TOOLS / "bin"))
    if uv is None:
        raise PeersUnavailable("uv isn't installed")
    _run([uv, "venv", "--quiet", "--clear", "--python", "3.11", str(folder)])
    _run([uv, "pip", "install", "--quiet", "--python", str(interpreter), f"discorpy=={VERSION}"])
    stamp.write_text(VERSION)
    return interpreter


def _run(command: Sequence[str]) -> str:
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True, timeout=LONGEST_SECONDS).stdout
    except (subprocess.SubprocessError, OSError) as error:
        raise PeersUnavailable(str(error)) from error
