"""The polylines of an edit: as a hand sends them, or made of the segments that it replaces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Image, RunImage, Segment
from app.errors import InvalidInput, InvalidSegments, NoEdge, TooLarge
from app.services.carrying import stored_polyline
from app.services.image_lens import lens_fields
from app.services.images import get_image
from app.vision.edits import cut, joined, junction, trim
from app.vision.segments import Segments

MOST_POINTS = 50_000
"""Points that one edit adds: ten times the diagonal of a large image."""
SHAPES: dict[str, tuple[int, int]] = {
    "trace": (0, 1),
    "cut": (1, 2),
    "trim": (1, 1),
    "extend": (1, 1),
    "join": (2, 1),
}
"""How many segments each kind of edit replaces, and how many it adds."""
SHORTEST_GAP = 8.0
"""px; in a shorter gap no edge can be told."""

Points = NDArray[np.float32]
Trace = Callable[[NDArray[Any], str], Points]
"""Gives the points of the edge between two points (``edge``), or of a segment with its extension (``extend``)."""


@dataclass(frozen=True, eq=False)
class EditedImage:
    """What making an edit has to know of its image.

    Attributes:
        distortion: The lens as ``DistortionEstimate.as_dict`` gives it; ``None`` where it isn't known.
        polylines: float32 ``(n, 2)`` px of the segments named, in the order given, retired ones too.
    """

    image_id: int
    name: str
    sha256: str
    width: int
    height: int
    distortion: dict[str, Any] | None
    polylines: tuple[Points, ...]


def edited_image(session: Session, image_id: int, segment_ids: Sequence[int] = ()) -> EditedImage:
    """Return an image and the points of some of its segments.

    Raises:
        NotFound: When there is no such image, or it is deleted.
        InvalidInput: On a segment that isn't of this image.
    """
    image = get_image(session, image_id)
    query = select(Segment.id, Segment.points).where(Segment.id.in_(segment_ids), Segment.image_id == image.id)
    found = {key: stored_polyline(points) for key, points in session.execute(query).all()} if segment_ids else {}
    foreign = [key for key in segment_ids if key not in found]
    if foreign:
        raise InvalidInput(
            f"segment {foreign[0]} isn't of image {image_id}", where="segment_id", expected="segments of this image"
        )
    work = session.get(RunImage, image.current_run_image_id) if image.current_run_image_id else None
    return EditedImage(
        image.id,
        image.name,
        image.sha256,
        image.width,
        image.height,
        lens_fields(session, image, work),
        tuple(found[key] for key in segment_ids),
    )


def made_polylines(
    kind: str, polylines: Sequence[Points], at: tuple[float, float] | None, trace: Trace
) -> list[Points]:
    """Make the polylines that an edit adds of those that it replaces.

    Args:
        kind: ``cut`` or ``trim`` at a place, ``join`` or ``extend``.
        polylines: Of the segments that it replaces.
        at: The place, px.
        trace: Traces an edge in the image.

    Raises:
        InvalidInput: When the edit can't be made of these, or the place is missing.
        NoEdge: When there is nothing to extend along.
    """
    if kind in ("cut", "trim") and at is None:
        raise InvalidInput(f"where to {kind} is missing", where="at", expected="x, y in px")
    if kind == "cut":
        return list(cut(polylines[0], at or (0, 0)))
    if kind == "trim":
        return [trim(polylines[0], at or (0, 0))]
    if kind == "extend":
        return [trace(polylines[0], "extend")]
    if kind == "join":
        return [_joined(polylines[0], polylines[1], trace)]
    raise InvalidInput("a traced line comes with its points", where="adds", expected="one polyline")


def checked_polylines(kind: str, adds: Sequence[NDArray[Any]], image: Image) -> Segments:
    """Return the polylines that an edit adds.

    Raises:
        InvalidInput: On another number of them than its kind has, too few points, no extent, or points outside.
        TooLarge: On more than 50,000 points.
    """
    number = SHAPES[kind][1]
    if len(adds) != number:
        raise InvalidInput(f"{len(adds)} polylines", where="adds", expected=f"a {kind} adds {number}")
    total = sum(len(points) for points in adds)
    if total > MOST_POINTS:
        raise TooLarge(f"{total} points", where="adds", expected=f"at most {MOST_POINTS}")
    for index, points in enumerate(adds):
        _check_polyline(np.asarray(points), f"adds[{index}]", image)
    try:
        segments = Segments.from_list(list(adds))
    except InvalidSegments as error:
        raise InvalidInput(error.message, where=f"adds: {error.where}", expected=error.expected) from error
    short = np.flatnonzero(segments.lengths() < 1)
    if short.size:
        raise InvalidInput("a line without extent", where=f"adds[{int(short[0])}]", expected="1 px and more")
    return segments


def require_inside(at: tuple[float, float] | None, image: EditedImage) -> None:
    """Check that the place of an edit, if it has one, lies in the image.

    Raises:
        InvalidInput: When it doesn't.
    """
    if at is not None:
        _check_inside(np.array([at], np.float64), "at", image)


def _check_polyline(points: NDArray[Any], where: str, image: Image) -> None:
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
        raise InvalidInput("no polyline", where=where, expected="two or more pairs of x, y")
    _check_inside(points, where, image)


def _check_inside(points: NDArray[Any], where: str, image: Image | EditedImage) -> None:
    inside = np.isfinite(points) & (points >= -0.5) & (points <= np.array([image.width, image.height]) - 0.5)
    if not inside.all():
        row = int(np.flatnonzero(~inside.all(axis=1))[0])
        raise InvalidInput(
            "a point lies outside the image",
            where=where if len(points) == 1 else f"{where}[{row}]",
            expected=f"x from -0.5 to {image.width - 0.5:g}, y from -0.5 to {image.height - 0.5:g}",
        )


def _joined(one: Points, other: Points, trace: Trace) -> Points:
    both = junction(one, other)
    if both.gap < SHORTEST_GAP:
        return joined(both)
    try:
        return joined(both, trace(np.stack([both.before[-1], both.after[0]]), "edge"))
    except NoEdge:  # what nobody can see stays a gap, as the pipeline leaves one
        return joined(both)
