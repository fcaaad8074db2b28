"""Progress of a detection, calling it off, and the memory it takes."""

import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from app.errors import Cancelled
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.prelabel import prelabel

MOST_BYTES_PER_PIXEL = 30
MEASURE = """
import json
import numpy as np
from app.vision import detect
def peak():
    # unlike the largest resident set that getrusage tells, this one doesn't start at that of the parent
    (line,) = (line for line in open("/proc/self/status") if line.startswith("VmHWM"))
    return int(line.split()[1]) * 1024
generator = np.random.default_rng(0)
detect(np.zeros((64, 64), np.uint8))
blocks = np.kron(generator.integers(0, 256, (130, 190)), np.ones((18, 16))).astype(np.uint8)
image = np.clip(blocks + generator.normal(0, 4, blocks.shape).astype(np.float32), 0, 255).astype(np.uint8)
before = peak()
found = detect(image)
print(json.dumps({"bytes": (peak() - before) / image.size, "segments": len(found)}))
"""


class OfTheCaller(Exception):
    """Raised by what the caller gave."""


def test_progress_rises_from_zero_to_one(windows: np.ndarray) -> None:
    told: list[float] = []
    watched = detect(windows, progress=told.append)
    assert told[0] == 0
    assert told[-1] == 1
    assert told == sorted(told)
    assert len(set(told)) > 8
    assert watched == detect(windows)


def test_a_tiny_image_is_done_at_once() -> None:
    told: list[float] = []
    detect(np.zeros((2, 2), np.uint8), progress=told.append)
    assert told == [1]


def test_no_step_of_a_large_image_is_long(street) -> None:
    told: list[float] = []
    detect(np.tile(street("P1020816"), (3, 3)), progress=told.append)
    assert np.diff(told).max() <= 0.1


@pytest.mark.parametrize("after", range(0, 12, 2))
def test_a_wish_to_cancel_is_heard_at_once(windows: np.ndarray, after: int) -> None:
    asked = 0

    def cancelled() -> bool:
        nonlocal asked
        asked += 1
        return asked > after

    with pytest.raises(Cancelled):
        detect(windows, cancelled=cancelled)
    assert asked == after + 1


def test_another_thread_may_cancel(windows: np.ndarray) -> None:
    event = threading.Event()

    def progress(share: float) -> None:
        if share > 0.3 and not event.is_set():
            canceller = threading.Thread(target=event.set)
            canceller.start()
            canceller.join()

    with pytest.raises(Cancelled):
        detect(windows, progress=progress, cancelled=event.is_set)


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.7, 0.95, 1.0])
def test_what_the_callback_raises_comes_out_as_it_is(windows: np.ndarray, share: float) -> None:
    error = OfTheCaller("enough")

    def progress(told: float) -> None:
        if told >= share:
            raise error

    with pytest.raises(OfTheCaller) as caught:
        detect(windows, progress=progress)
    assert caught.value is error


def test_after_a_cancelled_call_the_next_one_is_whole(windows: np.ndarray) -> None:
    parameters = DetectionParameters(min_length=40)
    before = detect(windows, parameters)
    with pytest.raises(Cancelled):
        detect(windows, parameters, cancelled=lambda: True)
    assert detect(windows, parameters) == before


def test_prelabelling_is_called_off_too(windows: np.ndarray) -> None:
    done: list[int] = []
    with pytest.raises(Cancelled):
        prelabel([windows] * 3, progress=lambda count, _: done.append(count), cancelled=lambda: bool(done))
    assert done == [1]


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="only Linux tells the peak of one program")
@pytest.mark.skipif("asan" in os.environ.get("LD_PRELOAD", ""), reason="a checked library takes more memory")
def test_memory_stays_bounded_per_pixel() -> None:
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", MEASURE], capture_output=True, text=True, cwd=root, check=True)
    measured = json.loads(done.stdout)
    assert measured["segments"] > 10
    assert 5 < measured["bytes"] <= MOST_BYTES_PER_PIXEL
