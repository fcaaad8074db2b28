"""How long each stage of detection takes."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.vision import pipeline, stages

from .call_times import Call, timed_calls
from .detectors import clearlines, opencv_lsd

# what `detect` calls, in this order, and the stage that each belongs to
CALLS = (
    ("equalisation", "equalisation tables"),
    ("edge_map", "edge points"),
    ("find_runs", "chaining and splitting"),
    ("find_runs", "chaining and splitting"),
    ("fit_pieces", "pieces"),
    ("merge", "merging"),
    ("merge", "merging, blind to polarity"),
    ("extend", "extension"),
    ("merge", "merging after extension"),
    ("select", "selection"),
    ("choose", "scores and points"),
    ("segments_of", "scores and points"),
)
REST = "everything else"
STAGES = (*dict.fromkeys(stage for _, stage in CALLS), REST)
WHOLE, LSD = "detect", "lsd"
_OF_PIPELINE = ("choose", "segments_of")
_FUNCTIONS = [(pipeline if name in _OF_PIPELINE else stages, name) for name in dict.fromkeys(name for name, _ in CALLS)]


def stage_times(photos: Sequence[NDArray[np.uint8]], min_length: float, passes: int) -> dict[str, NDArray[np.float64]]:
    """Return the time of each stage, of the whole detection and of OpenCV's LSD, each the best of some passes.

    It is this thread's time on the processor. Ours and LSD take turns on each photo, so that whatever else the machine
    does slows both.

    Args:
        photos: N times uint8 ``(H, W)``.
        min_length: Shortest segment asked for, px.
        passes: Over each photo.

    Returns:
        By name, `STAGES`, `WHOLE` and `LSD`, float64 ``(N,)`` ms.
    """
    ours, lsd = clearlines(min_length), opencv_lsd()
    for detector in (ours, lsd):
        detector(photos[0])
    best = {name: np.full(len(photos), np.inf) for name in (*STAGES, WHOLE, LSD)}
    for index, photo in enumerate(photos):
        for _ in range(passes):
            with timed_calls(_FUNCTIONS) as calls:
                start = time.thread_time()
                ours(photo)
                whole = time.thread_time() - start
            start = time.thread_time()
            lsd(photo)
            seconds = by_stage(calls) | {LSD: time.thread_time() - start, WHOLE: whole}
            seconds[REST] = whole - sum(call.seconds for call in calls)
            for name, value in seconds.items():
                best[name][index] = min(best[name][index], 1000 * value)
    return best


def by_stage(calls: Sequence[Call]) -> dict[str, float]:
    """Add up the seconds of one detection's calls by stage.

    Raises:
        RuntimeError: If these aren't `CALLS`: then the detection has changed, and the stages here must.
    """
    names = [call.name for call in calls]
    if names != [name for name, _ in CALLS]:
        raise RuntimeError(f"the stages of detection have changed, they call {', '.join(names)}")
    seconds: dict[str, float] = {}
    for call, (_, stage) in zip(calls, CALLS, strict=True):
        seconds[stage] = seconds.get(stage, 0.0) + call.seconds
    return seconds
