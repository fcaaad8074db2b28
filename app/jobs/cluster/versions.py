"""Which versions a worker has, and whether its answers can be trusted to be this server's.

Results are pickled arrays and records, and a candidate's score depends on the code that found it: a worker that runs
another version would give other results without anybody noticing.
"""

from __future__ import annotations

import platform
from collections.abc import Mapping

import cv2
import numpy as np

from app import __version__
from app.vision.code_version import code_version

EXACT = ("clearlines", "code")
MAJOR = {"python": 2, "numpy": 1, "opencv": 1}
"""How many parts of a version must agree."""


def installed_versions() -> dict[str, str]:
    """Return this process's versions: of ClearLines, its code with the compiled part, Python, numpy, OpenCV."""
    return {
        "clearlines": __version__,
        "code": code_version(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "opencv": cv2.__version__,
    }


def difference(ours: Mapping[str, str], theirs: Mapping[str, str]) -> str | None:
    """Tell why a worker can't work for this server; ``None`` when it can.

    Args:
        ours: ``installed_versions`` of the server.
        theirs: Of the worker.
    """
    differing = [name for name in EXACT if ours[name] != theirs.get(name)]
    differing += [
        name for name, parts in MAJOR.items() if _leading(ours[name], parts) != _leading(theirs.get(name, ""), parts)
    ]
    if not differing:
        return None
    found = ", ".join(f"{name} {theirs.get(name, 'of an unknown version')}" for name in differing)
    wanted = ", ".join(f"{name} {ours[name]}" for name in differing)
    return f"it runs {found}; this server runs {wanted}"


def _leading(version: str, parts: int) -> tuple[str, ...]:
    return tuple(version.split(".")[:parts])
