"""EDLines and FastLineDetector of opencv-contrib, in an environment of their own.

opencv-contrib and opencv are one Python package, so an environment can't hold both. This one is made on demand in
``.tools/peers``, with the versions of OpenCV and NumPy that this process uses.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from shared.detectors import Found

from app.vision import Segments

TOOLS = Path(__file__).resolve().parents[2] / ".tools"
WORKER = Path(__file__).with_name("peer_worker.py")
LONGEST_SECONDS = 600.0
NAMES = {"edlines": "EDLines", "fast_line_detector": "FastLineDetector, merge on"}
"""What the worker calls its detectors, and what they are called in print."""


class PeersUnavailable(Exception):
    """The environment can't be made here; the message says why."""


def run_peers(images: Sequence[NDArray[np.uint8]], passes: int = 1) -> dict[str, Found]:
    """Run every detector of opencv-contrib on N images, single-threaded, in a process of its own.

    Args:
        images: uint8 ``(H, W)``.
        passes: How often each image is timed; the best counts.

    Returns:
        By the name that the worker gives them.

    Raises:
        PeersUnavailable: When opencv-contrib can't be installed or run here.
    """
    interpreter = peer_interpreter()
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"{index:05}.png" for index in range(len(images))]
        for path, image in zip(paths, images, strict=True):
            cv2.imwrite(str(path), image)
        output = Path(folder) / "found.npz"
        _run([str(interpreter), str(WORKER), str(output), str(passes), *map(str, paths)])
        with np.load(output) as arrays:
            return {name: _found(arrays[f"{name}_lines"], arrays, name) for name in NAMES}


def peer_interpreter() -> Path:
    """Return the interpreter of the isolated environment, which is made when it isn't there.

    Raises:
        PeersUnavailable: When opencv-contrib can't be installed here.
    """
    folder = TOOLS / "peers"
    interpreter = folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    opencv = version("opencv-python-headless")
    requirements = [f"opencv-contrib-python-headless=={opencv}", f"numpy=={version('numpy')}"]
    stamp = folder / "installed.txt"
    if stamp.is_file() and stamp.read_text().split() == requirements:
        return interpreter
    uv = shutil.which("uv") or shutil.which("uv", path=str(TOOLS / "bin"))
    if uv:
        _run([uv, "venv", "--quiet", "--clear", "--python", sys.executable, str(folder)])
        _run([uv, "pip", "install", "--quiet", "--no-deps", "--python", str(interpreter), *requirements])
    else:
        _run([sys.executable, "-m", "venv", "--clear", str(folder)])
        _run([str(interpreter), "-m", "pip", "install", "--quiet", "--no-deps", *requirements])
    stamp.write_text("\n".join(requirements))
    return interpreter


def _run(command: Sequence[str]) -> None:
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=LONGEST_SECONDS)
    except subprocess.CalledProcessError as error:
        raise PeersUnavailable(_reason(str(error.stderr)) or f"exit status {error.returncode}") from error
    except (subprocess.TimeoutExpired, OSError) as error:
        raise PeersUnavailable(str(error)) from error


def _reason(printed: str) -> str:
    """Return the first line that speaks of an error, and the last line."""
    lines = [line.strip() for line in printed.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower()]
    return "; ".join(dict.fromkeys(errors[:1] + lines[-1:]))


def _found(lines: NDArray[np.float32], arrays: np.lib.npyio.NpzFile, name: str) -> Found:
    ends = lines.reshape(-1, 2, 2)
    images = np.split(ends, arrays[f"{name}_offsets"][1:-1])
    return Found(tuple(Segments.from_list(list(image)) for image in images), arrays[f"{name}_seconds"])
