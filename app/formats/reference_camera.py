"""``cameras.json``: reference distortions, in OpenCV's convention."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeGuard

from app.errors import InvalidFile
from app.formats.json_segments import parse_json
from app.formats.naming import composed

FILE_LIMIT = 16 * 2**20
COEFFICIENTS = (4, 5, 8, 12, 14)
ALL = "*"
"""Key of a camera that a file gives for all images."""


@dataclass(frozen=True)
class ReferenceCamera:
    """A camera as known from elsewhere: pinhole matrix and distortion as OpenCV's ``undistortPoints`` takes them.

    Attributes:
        width: Of the image in px.
        height: Of the image in px.
        matrix: K, three rows of three, px.
        distortion: D = (k1, k2, p1, p2[, k3[, ...]]), 4, 5, 8, 12 or 14 numbers without unit.
    """

    width: int
    height: int
    matrix: tuple[tuple[float, float, float], ...]
    distortion: tuple[float, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return the entry of ``cameras.json``."""
        rows = [list(row) for row in self.matrix]
        return {"width": self.width, "height": self.height, "K": rows, "D": list(self.distortion)}


def read_cameras(data: bytes, *, where: str = "cameras.json") -> Mapping[str, ReferenceCamera]:
    """Read ``{NAME: {"width", "height", "K", "D"}}``, NAME a camera's or an image's.

    A file that holds one such camera without a name is read too; it comes back under ``*``.

    Raises:
        InvalidFile: Naming camera and field.
        TooLarge: Over 16 MiB.
    """
    document = parse_json(data, where=where, limit=FILE_LIMIT)
    if not isinstance(document, dict):
        raise InvalidFile("there are no cameras", where=where, expected='{NAME: {"width", "height", "K", "D"}}')
    if "K" in document:
        return {ALL: camera_from_fields(document, where)}
    return {composed(name): camera_from_fields(entry, f"{where}: {name}") for name, entry in document.items()}


def write_cameras(cameras: Mapping[str, ReferenceCamera]) -> bytes:
    """Write ``cameras.json``, sorted by name."""
    return json.dumps({name: cameras[name].as_dict() for name in sorted(cameras)}, indent=1).encode()


def camera_from_fields(entry: Any, where: str) -> ReferenceCamera:
    """Return the camera of one entry of ``cameras.json``.

    Raises:
        InvalidFile: If it is no object, or naming the field that isn't what it should be.
    """
    if not isinstance(entry, dict):
        raise InvalidFile("a camera is no object", where=where, expected='{"width", "height", "K", "D"}')
    width, height = (_side(entry.get(name), f"{where}, {name}") for name in ("width", "height"))
    rows = entry.get("K")
    if not isinstance(rows, list) or len(rows) != 3 or not all(_are_numbers(row, (3,)) for row in rows):
        raise InvalidFile("K is no matrix", where=where, expected="3 x 3 finite numbers, px")
    if not (rows[0][0] > 0 and rows[1][1] > 0):
        raise InvalidFile("a focal length is not positive", where=f"{where}, K", expected="px")
    coefficients = entry.get("D")
    if not _are_numbers(coefficients, COEFFICIENTS):
        raise InvalidFile(
            "D is no distortion", where=where, expected="4, 5, 8, 12 or 14 finite numbers, k1 k2 p1 p2 k3 ..."
        )
    matrix = tuple((float(a), float(b), float(c)) for a, b, c in rows)
    return ReferenceCamera(width, height, matrix, tuple(float(value) for value in coefficients))


def _side(value: Any, where: str) -> int:
    if type(value) is not int or not 0 < value < 10**6:
        raise InvalidFile(f"{value!r:.40} is no size", where=where, expected="px, a positive integer")
    return value


def _are_numbers(values: Any, counts: tuple[int, ...]) -> TypeGuard[list[float]]:
    if not isinstance(values, list) or len(values) not in counts:
        return False
    return all(type(value) in (int, float) and abs(value) < 1e12 and math.isfinite(value) for value in values)
