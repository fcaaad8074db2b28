"""What exports share: coordinates in another tool's convention, and the attributes of a segment."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.decimals import shifted, shortest
from app.formats.labelled import LabelledSegments

LABEL = "segment"
CORNER = 0.5
"""Added to x and y for tools whose origin is the outer corner of the first pixel; ours is its centre."""


def polylines(labelled: LabelledSegments, offset: float = 0.0) -> list[NDArray[np.float64]]:
    """Return the points of each segment, float64 ``(n, 2)`` with n >= 2, in px with ``offset`` added.

    No tool keeps a line of one point, so a lone point is written twice.
    """
    segments = labelled.segments
    points = shifted(segments.points, offset) if offset else shortest(segments.points)
    lines = np.split(points, segments.offsets[1:-1]) if len(segments) else []
    return [np.repeat(line, 2, axis=0) if len(line) == 1 else line for line in lines]


def attributes(labelled: LabelledSegments) -> list[dict[str, Any]]:
    """Return what is known of each segment: any of verdict, score, straightness, origin, id."""
    scores = labelled.segments.scores
    columns = {
        "verdict": labelled.verdicts,
        "score": None if scores is None else shortest(scores).tolist(),
        "straightness": None if labelled.straightness is None else shortest(labelled.straightness).tolist(),
        "origin": labelled.origins,
        "id": labelled.ids,
    }
    known = {field: values for field, values in columns.items() if values is not None}
    return [
        {field: values[index] for field, values in known.items() if values[index] is not None}
        for index in range(len(labelled))
    ]


def dump(value: Any) -> str:
    """Return compact JSON."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
