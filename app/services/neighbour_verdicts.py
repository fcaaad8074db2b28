"""Verdicts of the same edges in the frames before and after an image, for a person to take over."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.db.models import Image, Segment, SegmentState
from app.review.frame_matches import frame_matches
from app.services.candidates import current_segments, verdict_of_segment
from app.services.carrying import stored_polyline
from app.services.images import get_image
from app.services.neighbour_frames import frames_beside
from app.vision.segments import Segments


@dataclass(frozen=True)
class JudgedFrame:
    """S current candidates of a frame with what was decided on them.

    Attributes:
        segment_ids: Their rows.
        segments: Their points, px.
        verdicts: Verdict and reason of each.
    """

    image_id: int
    segment_ids: tuple[int, ...]
    segments: Segments
    verdicts: tuple[tuple[str, str | None], ...]


@dataclass(frozen=True)
class FramesToMatch:
    """An image's candidates, and those of the frames beside it on which something is decided."""

    size: tuple[int, int]
    image: JudgedFrame
    beside: tuple[JudgedFrame, ...]


@dataclass(frozen=True)
class NeighbourVerdict:
    """What was decided on the same edge in the frame before or after."""

    segment_id: int
    verdict: str
    reason: str | None
    from_image_id: int


def frames_to_match(session: Session, image_id: int) -> FramesToMatch:
    """Return what the verdicts of the frames beside an image follow from; none are where its drive isn't known.

    Raises:
        NotFound: When there is no such image, or it is deleted.
    """
    image = get_image(session, image_id)
    beside = frames_beside(session, image)
    frames = [_judged_frame(session, frame) for frame in (beside.before, beside.after) if frame and _is_judged(frame)]
    return FramesToMatch((image.width, image.height), _judged_frame(session, image), tuple(frames))


def neighbour_verdicts(frames: FramesToMatch) -> tuple[NeighbourVerdict, ...]:
    """Match the frames, and return the verdicts on edges of the image's undecided candidates, in their order.

    Where the frames before and after say different things of one edge, nothing is said of it. This takes seconds where
    frames have thousands of candidates, and needs no session.
    """
    said: dict[int, list[tuple[float, NeighbourVerdict]]] = {}
    for frame in frames.beside:
        matches = frame_matches(frames.image.segments, frame.segments, frames.size)
        for mine, theirs, cost in zip(*(part.tolist() for part in matches), strict=True):
            verdict, reason = frame.verdicts[theirs]
            if verdict != "undecided" and frames.image.verdicts[mine][0] == "undecided":
                entry = NeighbourVerdict(frames.image.segment_ids[mine], verdict, reason, frame.image_id)
                said.setdefault(mine, []).append((cost, entry))
    agreed = {mine: entries for mine, entries in said.items() if len({entry.verdict for _, entry in entries}) == 1}
    return tuple(min(agreed[mine], key=lambda pair: pair[0])[1] for mine in sorted(agreed))


def _is_judged(image: Image) -> bool:
    return image.n_keep + image.n_reject + image.n_ambiguous > 0


def _judged_frame(session: Session, image: Image) -> JudgedFrame:
    query = current_segments(Segment.id, Segment.points, verdict_of_segment(), SegmentState.reason)
    rows = session.execute(query.where(Segment.image_id == image.id)).all()
    return JudgedFrame(
        image.id,
        tuple(row[0] for row in rows),
        Segments.from_list([stored_polyline(row[1]) for row in rows]),
        tuple((row[2], row[3]) for row in rows),
    )
