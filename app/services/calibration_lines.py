"""How far each line of a calibration is from straight: an npz in its row, and its pages.

The lines of a calibration never change; the segments they were may be replaced or gone by now, and the list says so.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.calibration.line_table import COLUMNS, CalibrationLines, no_lines, unpacked_lines
from app.db.models import Calibration, Image, Segment
from app.errors import InvalidInput
from app.services.candidates import is_current
from app.services.paging import Page, checked_limit, read_cursor, write_cursor

LineOrder = Literal["residual", "length", "image"]
LINE_ORDERS: tuple[LineOrder, ...] = get_args(LineOrder)
LineState = Literal["current", "replaced", "gone"]


@dataclass(frozen=True)
class LineEntry:
    """A line as the list of residuals shows it.

    Attributes:
        image: The image's name; ``None`` where it is gone.
        box: x0, y0, x1, y1 of the segment, px; ``None`` where it is gone.
        state: ``current``, ``replaced`` by a later run or an edit, or ``gone`` with its image or its run.
    """

    segment_id: int
    image_id: int
    image: str | None
    rms: float | None
    maximum: float | None
    length: float
    probability: float
    box: tuple[float, float, float, float] | None
    state: LineState


def lines_of(row: Calibration) -> CalibrationLines:
    """Return the lines of a calibration; none before it is done."""
    if row.lines is None:
        return no_lines()
    return unpacked_lines(row.lines)


def list_lines(
    session: Session,
    row: Calibration,
    *,
    order: LineOrder = "residual",
    limit: int = 100,
    cursor: str | None = None,
) -> Page[LineEntry]:
    """Return a page of a calibration's lines.

    Args:
        session: Any session.
        row: A finished calibration.
        order: Largest residual first, longest first, or by image in the calibration's order.
        limit: Lines of a page.
        cursor: Of the page before.

    Raises:
        InvalidInput: On an order, limit or cursor that can't be.
    """
    limit = checked_limit(limit)
    lines = lines_of(row)
    ranked = _ranked(lines, order)
    start = _place_after(f"lines-{order}", cursor, row.id)
    chosen = ranked[start : start + limit]
    end = start + len(chosen)
    following = write_cursor(f"lines-{order}", row.id, end) if end < len(ranked) else None
    return Page(_entries(session, lines, chosen), following, len(ranked))


def _ranked(lines: CalibrationLines, order: LineOrder) -> NDArray[np.int64]:
    """Return the indices of all lines in an order; what has no residual comes last."""
    if order not in LINE_ORDERS:
        raise InvalidInput(f"{order!r:.40} is no order", where="order", expected=", ".join(LINE_ORDERS))
    if order == "image":
        return np.arange(len(lines))
    value = np.nan_to_num(lines.rms if order == "residual" else lines.length, nan=-1.0)
    return np.lexsort((lines.segment_id, -value))


def _place_after(order: str, cursor: str | None, calibration_id: int) -> int:
    if cursor is None:
        return 0
    of_calibration, place = read_cursor(order, cursor)
    if of_calibration != calibration_id or place < 0:
        raise InvalidInput("the cursor belongs to another calibration", where="cursor", expected="one of this list")
    return place


def _entries(session: Session, lines: CalibrationLines, chosen: NDArray[np.int64]) -> tuple[LineEntry, ...]:
    rows = list(zip(*(getattr(lines, name)[chosen].tolist() for name in COLUMNS), strict=True))
    names: dict[int, str] = dict(
        session.execute(
            select(Image.id, Image.name).where(Image.id.in_({row[0] for row in rows}), Image.deleted_at.is_(None))
        ).all()
    )
    boxes = (Segment.x0, Segment.y0, Segment.x1, Segment.y1)
    wanted = Segment.id.in_([row[1] for row in rows])
    found = session.execute(select(Segment.id, *boxes, is_current().label("current")).where(wanted)).all()
    known = {segment.id: segment for segment in found}
    entries: list[LineEntry] = []
    for image_id, segment_id, rms, maximum, length, probability in rows:
        segment = known.get(segment_id) if image_id in names else None
        entries.append(
            LineEntry(
                segment_id=segment_id,
                image_id=image_id,
                image=names.get(image_id),
                rms=_finite(rms),
                maximum=_finite(maximum),
                length=length,
                probability=probability,
                box=None if segment is None else (segment.x0, segment.y0, segment.x1, segment.y1),
                state="gone" if segment is None else "current" if segment.current else "replaced",
            )
        )
    return tuple(entries)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
