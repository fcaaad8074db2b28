"""Run the line detectors of opencv-contrib: the one program that is run by the interpreter of the isolated environment.

python peer_worker.py OUTPUT.npz PASSES IMAGE...

Of every detector the file holds ``NAME_lines`` float32 ``(L, 4)``, the ends ``x0, y0, x1, y1`` of all lines in px;
``NAME_offsets`` int64 ``(N + 1,)``, image i has lines ``offsets[i]`` to ``offsets[i + 1]``; and ``NAME_seconds``
float64 ``(N,)``, the best of the passes. All settings are the defaults but for FastLineDetector's merging. One thread.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np

CONTRIB: Any = cv2  # the types of the plain package know nothing of ximgproc


def edlines() -> Callable[[Any], Any]:
    """EDLines: Akinlar and Topal, Pattern Recognition Letters 2011."""
    drawing = CONTRIB.ximgproc.createEdgeDrawing()

    def detect(gray: Any) -> Any:
        drawing.detectEdges(gray)
        return drawing.detectLines()

    return detect


def fast_line_detector() -> Callable[[Any], Any]:
    """FastLineDetector: Lee et al., ICRA 2014."""
    return CONTRIB.ximgproc.createFastLineDetector(do_merge=True).detect


def time_image(detect: Callable[[Any], Any], image: Any, passes: int) -> tuple[Any, float]:
    """Return the lines ``(L, 4)`` of an image and the least time of the passes, s."""
    lines, best = None, float("inf")
    for _ in range(passes):
        start = time.perf_counter()
        lines = detect(image)
        best = min(best, time.perf_counter() - start)
    return np.zeros((0, 4), np.float32) if lines is None else lines.reshape(-1, 4), best


def main() -> None:
    output, passes, *paths = sys.argv[1:]
    cv2.setNumThreads(1)
    images = [cv2.imread(path, cv2.IMREAD_GRAYSCALE) for path in paths]
    arrays: dict[str, Any] = {}
    for name, detect in {"edlines": edlines(), "fast_line_detector": fast_line_detector()}.items():
        found, seconds = zip(*(time_image(detect, image, int(passes)) for image in images), strict=True)
        arrays[f"{name}_lines"] = np.concatenate(found)
        arrays[f"{name}_offsets"] = np.cumsum([0, *map(len, found)])
        arrays[f"{name}_seconds"] = np.array(seconds)
    np.savez(output, **arrays)


if __name__ == "__main__":
    main()
