"""Read JSON: ``{"segments": [{"points": [[x, y], ...], "score", ...}]}``, or ``{"images": {NAME: that}}``."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidFile, InvalidInput, InvalidSegments, TooLarge
from app.formats.labelled import ORIGINS, LabelledSegments
from app.formats.limits import SEGMENT_LIMITS, SET_LIMITS, SegmentLimits, SetLimits
from app.formats.naming import check_names, composed, has_control_characters
from app.formats.polylines import check_counts, check_file_size, segments_from_arrays
from app.verdicts import REASONS, VERDICTS
from app.vision.segments import Segments

WORD_LIMIT = 200
FIELDS = ("points", "score", "straightness", "verdict", "reason", "origin", "id")


def read_json(data: bytes, *, where: str = "file", limits: SegmentLimits = SEGMENT_LIMITS) -> LabelledSegments:
    """Read the segments of one image.

    Args:
        data: The file, UTF-8.
        where: Its name, for messages.
        limits: How many bytes, segments and points are taken.

    Raises:
        InvalidFile: Naming file, segment, point, what was expected and, where something helps, what.
        TooLarge: Over a limit.
    """
    containers = limits.points + 2 * limits.segments + 100
    document = parse_json(data, where=where, limit=limits.json_bytes, containers=containers)
    return segments_from_json(document, where=where, limits=limits)


def read_json_set(
    data: bytes, *, where: str = "file", limits: SetLimits = SET_LIMITS
) -> Mapping[str, LabelledSegments]:
    """Read the segments of all images from one file; errors as `read_json`, with the image's name."""
    containers = limits.points + 2 * limits.segments + 2 * limits.images + 100
    document = parse_json(data, where=where, limit=limits.json_bytes, containers=containers)
    images = document.get("images") if isinstance(document, dict) else None
    if not isinstance(images, dict):
        raise InvalidFile("there are no images", where=where, expected='{"images": {NAME: {"segments": [...]}}}')
    if len(images) > limits.images:
        raise TooLarge(f"{len(images):,} images are too many", where=where, expected=f"at most {limits.images:,}")
    check_names(images, where=where)
    found: dict[str, LabelledSegments] = {}
    segments = points = 0
    bounds = SegmentLimits(limits.file_bytes, limits.json_bytes, limits.segments, limits.points)
    for name, image in images.items():
        labelled = segments_from_json(image, where=f"{where}: image {name}", limits=limits.image)
        segments, points = segments + len(labelled), points + len(labelled.segments.points)
        found[composed(name)] = labelled
        check_counts(segments, points, where=where, limits=bounds)
    return found


def parse_json(
    data: bytes, *, where: str, limit: int, containers: int = 1_000_000, allow_constants: bool = False
) -> Any:
    """Parse strict JSON: UTF-8, no NaN or infinity, no key twice.

    Args:
        data: The file.
        where: Its name, for messages.
        limit: Bytes to accept.
        containers: Lists and objects to accept; each takes about a hundred bytes, even an empty one.
        allow_constants: Read NaN and infinity as numbers, for a caller that complains of them by their place.

    Raises:
        InvalidFile: If it isn't that.
        TooLarge: Over a limit.
    """
    check_file_size(len(data), where=where, limit=limit)
    if data.count(b"[") + data.count(b"{") > containers:
        raise TooLarge("the file has too many lists and objects", where=where, expected=f"at most {containers:,}")
    constant = float if allow_constants else _no_constant
    try:
        return json.loads(data.decode("utf-8-sig"), parse_constant=constant, object_pairs_hook=_no_key_twice)
    except InvalidInput as error:
        raise InvalidFile(error.message, where=where, expected=error.expected, hint=error.hint) from error
    except UnicodeDecodeError as error:
        raise InvalidFile("the file is not UTF-8", where=f"{where}: byte {error.start}") from error
    except json.JSONDecodeError as error:
        raise InvalidFile(
            f"no JSON: {error.msg}", where=f"{where}: line {error.lineno}, column {error.colno}"
        ) from error
    except (RecursionError, ValueError) as error:
        raise InvalidFile("no usable JSON: nested too deep, or a number too long", where=where) from error


def segments_from_json(value: Any, *, where: str, limits: SegmentLimits = SEGMENT_LIMITS) -> LabelledSegments:
    """Turn one image's parsed JSON into segments; errors as `read_json`."""
    entries = value.get("segments") if isinstance(value, dict) else None
    if not isinstance(entries, list):
        raise InvalidFile("there is no list of segments", where=where, expected='{"segments": [{"points": [[x, y]]}]}')
    check_counts(len(entries), 0, where=where, limits=limits)
    for index, entry in enumerate(entries):
        _check_entry(entry, f"{where}: segment {index}")
    arrays = [_points(entry["points"], f"{where}: segment {index}") for index, entry in enumerate(entries)]
    segments = segments_from_arrays(arrays, where=where, limits=limits)
    scores = _numbers(entries, "score", where)
    fields = (
        _numbers(entries, "straightness", where),
        _words(entries, "verdict", VERDICTS, where),
        _words(entries, "origin", ORIGINS, where),
        _words(entries, "id", None, where),
        _words(entries, "reason", REASONS, where),
    )
    try:
        return LabelledSegments(Segments(segments.points, segments.offsets, scores), *fields)
    except InvalidSegments as error:  # a reason without a rejection
        raise InvalidFile(error.message, where=f"{where}: {error.where}", expected=error.expected) from error


def _no_constant(name: str) -> Any:
    raise InvalidInput(f"{name} is no number in JSON", expected="finite numbers")


def _no_key_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice = Counter(key for key, _ in pairs).most_common(1)[0][0]
        raise InvalidInput(f"the key {twice!r:.80} stands twice in one object", expected="each key once")
    return found


def _check_entry(entry: Any, where: str) -> None:
    if not isinstance(entry, dict) or "points" not in entry:
        raise InvalidFile("a segment has no points", where=where, expected='{"points": [[x, y], ...]}')
    unknown = sorted(set(entry) - set(FIELDS))
    if unknown:
        raise InvalidFile(f"unknown field {unknown[0]!r:.80}", where=where, expected=", ".join(FIELDS))


def _points(points: Any, where: str) -> NDArray[np.float64]:
    if not isinstance(points, list):
        raise InvalidFile("points is no list", where=where, expected="[[x, y], ...]")
    if set(map(type, points)) <= {list} and set(map(len, points)) <= {2}:
        flat = list(chain.from_iterable(points))
        if set(map(type, flat)) <= {int, float}:
            try:
                return np.array(flat, dtype=np.float64).reshape(-1, 2)
            except OverflowError as error:
                raise InvalidFile("a coordinate is too large", where=where, expected="px") from error
    index = next(index for index, point in enumerate(points) if not _is_point(point))
    raise InvalidFile(f"{points[index]!r:.80} is no point", where=f"{where}, point {index}", expected="[x, y] in px")


def _is_point(point: Any) -> bool:
    return isinstance(point, list) and len(point) == 2 and all(type(value) in (int, float) for value in point)


def _numbers(entries: list[dict[str, Any]], field: str, where: str) -> NDArray[np.float32] | None:
    given = [entry.get(field) for entry in entries]
    if all(value is None for value in given):
        return None
    for index, value in enumerate(given):
        here = f"{where}: segment {index}, {field}"
        if value is None:
            raise InvalidFile(f"no {field}, although other segments have one", where=here, expected="all or none")
        if type(value) not in (int, float) or not 0 <= value <= 1:
            raise InvalidFile(f"{value!r:.80} is no {field}", where=here, expected="a number from 0 to 1")
    return np.array(given, dtype=np.float32)


def _words(
    entries: list[dict[str, Any]], field: str, known: tuple[str, ...] | None, where: str
) -> tuple[str | None, ...] | None:
    given = [entry.get(field) for entry in entries]
    for index, value in enumerate(given):
        if value is None or (isinstance(value, str) and (value in known if known else _is_word(value))):
            continue
        raise InvalidFile(
            f"{value!r:.80} is no {field}",
            where=f"{where}: segment {index}, {field}",
            expected=", ".join(known) if known else f"a text of at most {WORD_LIMIT} characters",
        )
    return None if all(value is None for value in given) else tuple(given)


def _is_word(text: str) -> bool:
    return len(text) <= WORD_LIMIT and not has_control_characters(text)
