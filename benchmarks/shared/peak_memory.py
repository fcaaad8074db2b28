"""Time and memory of one `detect`: ``python peak_memory.py GRAY.npy SMALL.npy``; prints one JSON object.

Memory is the process's largest resident set beyond that before the call. The image itself is read before, and a small
image's segments are found before, so neither it nor what the libraries take once is counted.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from pathlib import Path

import cv2
import numpy as np

from app.vision import detect

STATUS = Path("/proc/self/status")


def peak_bytes() -> int:
    """Return the largest resident set of this program so far, bytes."""
    if STATUS.is_file():
        # getrusage won't do on Linux: its figure starts at that of the process that started this one
        return int(STATUS.read_text().split("VmHWM:")[1].split()[0]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def main() -> None:
    cv2.setNumThreads(1)
    gray, small = (np.load(path) for path in sys.argv[1:])
    detect(small)
    before = peak_bytes()
    processor, start = time.process_time(), time.perf_counter()
    segments = detect(gray)
    seconds = {"seconds": time.perf_counter() - start, "processor": time.process_time() - processor}
    print(json.dumps(seconds | {"bytes": peak_bytes() - before, "segments": len(segments)}))


if __name__ == "__main__":
    main()
