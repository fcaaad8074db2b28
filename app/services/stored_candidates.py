"""What the pipeline found in an image, whatever people decided on it."""

from __future__ import annotations

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Image, RunImage, Segment
from app.services.candidates import current_segments, verdict_of_segment
from app.services.labels import POINT
from app.vision.segments import Segments


def stored_candidates(session: Session, image: Image) -> Segments | None:
    """Return all candidates of an image, whatever was decided on them.

    Args:
        session: Any session.
        image: The image.

    Returns:
        ``None`` when they aren't all in the database: without a run, when the run dropped some, or when some were left
        out because an imported or hand-drawn segment was there already.
    """
    row = session.get(RunImage, image.current_run_image_id) if image.current_run_image_id is not None else None
    if row is None or row.status != "done":
        return None
    if any((row.changes or {}).get(name, 0) for name in ("already_there", "discarded")):
        return None
    found = session.execute(
        select(Segment.points, Segment.score).where(Segment.run_image_id == row.id).order_by(Segment.ordinal)
    ).all()
    if not found:
        return Segments.empty()
    points = [np.frombuffer(each.points, POINT).reshape(-1, 2) for each in found]
    scores = None if any(each.score is None for each in found) else [each.score for each in found]
    return Segments.from_list(points, scores)


def imported_candidates(session: Session, image: Image) -> Segments | None:
    """Return the candidates that came with an image from elsewhere, with a verdict each.

    Returns:
        ``None`` when the import brought labels alone. Rejected segments tell that it brought what was judged, too:
        labels are no candidates, and would do perfectly against themselves.
    """
    rows = session.execute(
        current_segments(Segment.points, verdict_of_segment().label("verdict")).where(
            Segment.image_id == image.id, Segment.origin == "import"
        )
    ).all()
    if not any(row.verdict == "reject" for row in rows):
        return None
    return Segments.from_list([np.frombuffer(row.points, POINT).reshape(-1, 2) for row in rows])
