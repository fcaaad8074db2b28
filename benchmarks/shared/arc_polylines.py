"""Arcs between chaining and output, as segments that can be compared with labels."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.vision import Segments
from app.vision.arcs import positions

STEP = 4.0
"""Greatest distance of vertices, px; an arc of 300 px radius strays from such a polyline by 0.01 px at most."""


def arc_polylines(arcs: NDArray[Any]) -> Segments:
    """Return arcs `app.vision.native.records.ARC` ``(n,)`` as polylines from start to end, both included."""
    counts = np.ceil(np.maximum(arcs["high"] - arcs["low"], 0) / STEP).astype(np.int64) + 2
    offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    rows = np.repeat(np.arange(len(arcs)), counts)
    share = (np.arange(offsets[-1]) - offsets[rows]) / (counts[rows] - 1)
    along = arcs["low"][rows] + share * (arcs["high"] - arcs["low"])[rows]
    return Segments(positions(arcs[rows], along).astype(np.float32), offsets)
