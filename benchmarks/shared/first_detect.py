"""Time the first `detect` of this process: ``python first_detect.py GRAY.npy``; prints one JSON object.

The clock starts when the interpreter has started and stops when the segments are there: imports count, reading the
image doesn't.
"""

from __future__ import annotations

import json
import sys
import time


def main() -> None:
    start = time.perf_counter()
    import numpy as np

    from app.vision import detect

    imported = time.perf_counter()
    gray = np.load(sys.argv[1])
    read = time.perf_counter()
    detect(gray)
    found = time.perf_counter()
    detect(gray)
    again = time.perf_counter()
    seconds = {"import": imported - start, "first": found - read, "total": found - start - (read - imported)}
    print(json.dumps(seconds | {"second": again - found}))


if __name__ == "__main__":
    main()
