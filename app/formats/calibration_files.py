"""A camera's calibration as other tools write it: OpenCV's FileStorage, ROS's camera_info, ``cameras.json``, our own.

They all hold a camera matrix and OpenCV's coefficients, under names of their own. YAML is taken as plain text: tags are
ignored, no object is made, aliases are refused (a few of them unfold to gigabytes), and the nodes are counted before
the first is built.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import yaml

from app.errors import InvalidFile, TooLarge
from app.formats.json_segments import parse_json
from app.formats.lens_json import entry_from_lens, is_lens_json
from app.formats.naming import composed
from app.formats.polylines import check_file_size
from app.formats.reference_camera import ALL, ReferenceCamera, camera_from_fields

FILE_LIMIT = 2**20
NODE_LIMIT = 100_000
DEPTH_LIMIT = 20
MATRIX = ("k", "cameramatrix", "intrinsicmatrix")
COEFFICIENTS = ("d", "distortioncoefficients", "distcoeffs", "distortioncoeffs")
MODELS = ("", "plumb_bob", "rational_polynomial", "opencv", "radtan")
"""Distortion models, as files name them, whose coefficients are OpenCV's."""
KINDS = "cameras.json with one camera, OpenCV's YAML or JSON, ROS's camera_info, or ClearLines' own JSON"
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\Z")
_Loader: Any = getattr(yaml, "CBaseLoader", yaml.BaseLoader)


def read_calibration_file(
    data: bytes, *, where: str = "calibration", size: tuple[int, int] | None = None, camera: str | None = None
) -> ReferenceCamera:
    """Read one camera's calibration.

    Args:
        data: The file; what it is, is told from its content.
        where: Its name, for messages.
        size: Width and height of the images in px; needed where the file doesn't say them, checked where it does.
        camera: Which camera is meant, in a file of several.

    Raises:
        InvalidFile: If it is none of the kinds that are read, a field isn't what it should be, or it is for images
            of another size.
        TooLarge: Over 1 MiB, or of too many parts.
    """
    check_file_size(len(data), where=where, limit=FILE_LIMIT)
    document = _parsed(data, where)
    if not isinstance(document, dict):
        raise InvalidFile("there is no calibration in it", where=where, expected=KINDS)
    fields, place = _camera_fields(document, where, camera)
    found = camera_from_fields(_as_entry(fields, place, size), place)
    if size is not None and size != (found.width, found.height):
        raise InvalidFile(
            f"it is for images of {found.width} x {found.height} px",
            where=place,
            expected=f"{size[0]} x {size[1]} px, as the camera's images have",
        )
    return found


def _parsed(data: bytes, where: str) -> Any:
    text = data.removeprefix(b"\xef\xbb\xbf").lstrip()
    if text.startswith(b"{"):
        return parse_json(data, where=where, limit=FILE_LIMIT, containers=NODE_LIMIT)
    return _yaml_parsed(data, where)


def _yaml_parsed(data: bytes, where: str) -> Any:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidFile("the file is not UTF-8", where=f"{where}: byte {error.start}", expected=KINDS) from error
    # OpenCV writes "%YAML:1.0", which isn't a directive that YAML knows
    text = re.sub(r"\A%YAML[^\n]*\n", "", text)
    try:
        _check_events(text, where)
        return yaml.load(text, Loader=_Loader)  # noqa: S506 - the base loader makes texts, lists and dictionaries alone
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = where if mark is None else f"{where}: line {mark.line + 1}, column {mark.column + 1}"
        reason = getattr(error, "problem", None) or "it can't be read"
        raise InvalidFile(f"neither JSON nor YAML: {reason}", where=place, expected=KINDS) from error
    except (ValueError, RecursionError) as error:
        raise InvalidFile("neither JSON nor YAML", where=where, expected=KINDS) from error


def _check_events(text: str, where: str) -> None:
    """Refuse aliases, more nodes than any calibration has, and deep nesting, before a node is built."""
    depth = 0
    for number, event in enumerate(yaml.parse(text, Loader=_Loader)):
        if isinstance(event, yaml.AliasEvent):
            line = event.start_mark.line + 1
            raise InvalidFile("aliases are not read", where=f"{where}: line {line}", expected="values written out")
        if number > NODE_LIMIT:
            raise TooLarge("the file has too many parts", where=where, expected=f"at most {NODE_LIMIT:,} values")
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > DEPTH_LIMIT:
            raise TooLarge("the file is nested too deep", where=where, expected=f"at most {DEPTH_LIMIT} levels")


def _camera_fields(document: Mapping[Any, Any], where: str, camera: str | None) -> tuple[Mapping[Any, Any], str]:
    """Return the fields of the one camera that is meant, and their place in the file."""
    if _is_camera(document):
        return document, where
    if is_lens_json(document):
        return entry_from_lens(document, where), f"{where}: lens"
    cameras = {str(name): entry for name, entry in document.items() if isinstance(entry, dict) and _is_camera(entry)}
    chosen = next((name for name in (camera, ALL) if name is not None and composed(name) in cameras), None)
    if chosen is None and len(cameras) == 1:
        (chosen,) = cameras
    if chosen is not None:
        return cameras[composed(chosen)], f"{where}: {chosen}"
    if cameras:
        raise InvalidFile(
            f"the file has {len(cameras)} cameras",
            where=where,
            expected="one camera" if camera is None else f"one of them called {camera}",
            hint=f"it has {', '.join(sorted(cameras)[:10])}",
        )
    raise InvalidFile("no camera matrix with distortion coefficients is in it", where=where, expected=KINDS)


def _is_camera(fields: Mapping[Any, Any]) -> bool:
    names = {_plain(name) for name in fields}
    return not names.isdisjoint(MATRIX) and not names.isdisjoint(COEFFICIENTS)


def _as_entry(fields: Mapping[Any, Any], where: str, size: tuple[int, int] | None) -> dict[str, Any]:
    """Return the camera as an entry of ``cameras.json``, whatever its fields are called."""
    by_name = {_plain(name): value for name, value in fields.items()}
    model = by_name.get("distortionmodel", "")
    if not isinstance(model, str) or model.lower() not in MODELS:
        raise InvalidFile(
            f"the distortion model {model!r:.40} is not read",
            where=where,
            expected="plumb_bob or rational_polynomial, which are OpenCV's",
            hint="a fisheye lens has no such coefficients",
        )
    width, height = _size(by_name, where, size)
    matrix = _numbers(_first(by_name, MATRIX), f"{where}, camera matrix")
    if len(matrix) != 9:
        raise InvalidFile(f"the camera matrix has {len(matrix)} numbers", where=where, expected="3 x 3")
    rows = [matrix[first : first + 3] for first in (0, 3, 6)]
    if rows[1][0] != 0 or rows[2] != [0, 0, 1]:
        raise InvalidFile("this is no camera matrix", where=where, expected="fx 0 cx, 0 fy cy, 0 0 1")
    coefficients = _numbers(_first(by_name, COEFFICIENTS), f"{where}, distortion coefficients")
    # without a model ROS writes no coefficients at all
    return {"width": width, "height": height, "K": rows, "D": coefficients or [0.0] * 5}


def _size(by_name: Mapping[str, Any], where: str, size: tuple[int, int] | None) -> tuple[int | float, int | float]:
    both = by_name.get("imagesize", by_name.get("resolution"))
    if isinstance(both, dict):
        both = [both.get("width"), both.get("height")]
    if both is None:
        both = [by_name.get(f"image{side}", by_name.get(side)) for side in ("width", "height")]
    if both == [None, None] and size is not None:
        return size
    if both == [None, None]:
        raise InvalidFile(
            "the file doesn't say for images of what size it is", where=where, expected="image_width and image_height"
        )
    sides = _numbers(both, f"{where}, image size")
    if len(sides) != 2 or any(side != int(side) for side in sides):
        raise InvalidFile("the image size isn't two whole numbers", where=where, expected="image_width, image_height")
    return int(sides[0]), int(sides[1])


def _numbers(value: Any, where: str) -> list[float]:
    """Return the numbers of a list, a list of lists, or a matrix with ``rows``, ``cols`` and ``data``."""
    if isinstance(value, dict):
        value = value.get("data")
    if not isinstance(value, list) or len(value) > 100:
        raise InvalidFile(f"{value!r:.40} is no list of numbers", where=where, expected="finite numbers")
    flat = [each for row in value for each in (row if isinstance(row, list) else [row])]
    return [_number(each, where) for each in flat[:100]]


def _number(value: Any, where: str) -> float:
    number: Any = value
    if isinstance(value, str) and len(value) < 100 and _NUMBER.match(value):
        number = float(value)
    if type(number) not in (int, float) or not abs(number) < 1e12:
        raise InvalidFile(f"{value!r:.40} is no usable number", where=where, expected="a finite number")
    return float(number)


def _first(by_name: Mapping[str, Any], names: tuple[str, ...]) -> Any:
    return next(by_name[name] for name in names if name in by_name)


def _plain(name: Any) -> str:
    return re.sub(r"[^a-z0-9]", "", str(name).lower())
