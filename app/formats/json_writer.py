"""Write the JSON of `json_segments`: for one image, or for all in one file."""

from __future__ import annotations

import json
from collections.abc import Iterable
from itertools import pairwise
from typing import Any

from app.formats.decimals import shortest
from app.formats.labelled import LabelledSegments


def write_json(labelled: LabelledSegments) -> bytes:
    """Write the segments of one image; what is unknown is left out. Numbers read back to the same float32."""
    return _dump(json_value(labelled))


def write_json_set(images: Iterable[tuple[str, LabelledSegments]]) -> bytes:
    """Write the segments of all images, given as (name, segments), into one file."""
    return _dump({"images": {name: json_value(labelled) for name, labelled in images}})


def json_value(labelled: LabelledSegments) -> dict[str, Any]:
    """Return the segments of one image as plain lists and dicts."""
    segments = labelled.segments
    rows = shortest(segments.points).tolist()
    bounds = segments.offsets.tolist()
    entries: list[dict[str, Any]] = [{"points": rows[start:stop]} for start, stop in pairwise(bounds)]
    fields = {
        "score": None if segments.scores is None else shortest(segments.scores).tolist(),
        "straightness": None if labelled.straightness is None else shortest(labelled.straightness).tolist(),
        "verdict": labelled.verdicts,
        "reason": labelled.reasons,
        "origin": labelled.origins,
        "id": labelled.ids,
    }
    for field, values in fields.items():
        for entry, value in zip(entries, values or (), strict=False):
            if value is not None:
                entry[field] = value
    return {"segments": entries}


def _dump(value: Any) -> bytes:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
