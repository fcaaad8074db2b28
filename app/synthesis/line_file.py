"""What is known of each line of a scene beyond its points: identity, kind, and why a distractor is none.

A JSON file per image, ``lines/NAME.json``::

    {"version": 1, "width": 640, "height": 480,
     "labels":      [{"line": 17, "kind": "kerb"}, ...],
     "ambiguous":   [{"line": 21, "kind": "cornice"}, ...],
     "distractors": [{"line": 3, "kind": "hanging wire", "reason": "curved", "points": [[x, y], ...]}, ...]}

Labels and ambiguous ones are in the order of the image's label files, and both name straight edges by one numbering:
fragments of one edge share a number. Distractors have a numbering of their own and bring their points, in px.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from app.errors import InvalidFile
from app.synthesis.scene import SyntheticScene

VERSION = 1
_DECIMALS = 2


def write_lines(scene: SyntheticScene) -> bytes:
    """Return the content of a scene's line file."""
    height, width = scene.image.shape[:2]
    content = {
        "version": VERSION,
        "width": width,
        "height": height,
        "labels": _named(scene.line_ids.tolist(), scene.kinds),
        "ambiguous": _named(scene.ambiguous_ids.tolist(), scene.ambiguous_kinds),
        "distractors": [
            {**named, "reason": reason, "points": points.astype(float).round(_DECIMALS).tolist()}
            for named, reason, points in zip(
                _named(scene.distractor_ids.tolist(), scene.distractor_kinds),
                scene.reasons,
                scene.distractors,
                strict=True,
            )
        ],
    }
    return (json.dumps(content, separators=(",", ":")) + "\n").encode()


def read_lines(data: bytes, *, where: str = "lines") -> Mapping[str, Any]:
    """Read a line file.

    Raises:
        InvalidFile: If it is none, or of another version.
    """
    try:
        content = json.loads(data)
    except ValueError as error:
        raise InvalidFile("the file is no JSON", where=where) from error
    if not isinstance(content, dict) or content.get("version") != VERSION:
        raise InvalidFile("the file holds no lines of a scene", where=where, expected=f"version {VERSION}")
    return content


def _named(lines: list[int], kinds: tuple[str, ...]) -> list[dict[str, Any]]:
    return [{"line": line, "kind": kind} for line, kind in zip(lines, kinds, strict=True)]
