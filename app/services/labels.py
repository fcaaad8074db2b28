"""Labels that come with images: they become segments of origin ``import``, judged by whoever made them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from uuid import NAMESPACE_URL, uuid5

import numpy as np
from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session

from app.db.models import Decision, Image, Segment, SegmentState
from app.formats.labelled import LabelledSegments
from app.services.candidates import refresh_counts

POINT = np.dtype("<f4")


@dataclass(frozen=True)
class ImageLabels:
    """The labels of one image, as files bring them.

    Attributes:
        labels: Segments, kept unless they say otherwise; none at all means that nothing straight is in the image.
        ambiguous: Segments of the file beside it, which aren't to be scored.
    """

    labels: LabelledSegments | None = None
    ambiguous: LabelledSegments | None = None

    def judged(self) -> list[tuple[LabelledSegments, tuple[str, ...]]]:
        """Return segments with a verdict each."""
        parts = ((self.labels, "keep"), (self.ambiguous, "ambiguous"))
        return [
            (part, tuple(verdict or default for verdict in part.verdicts or (None,) * len(part)))
            for part, default in parts
            if part is not None
        ]


def import_labels(
    session: Session,
    image: Image,
    labels: ImageLabels,
    now: datetime,
    *,
    person: str | None = None,
    newly_added: bool = False,
) -> bool:
    """Store an image's labels once; with a label file the image is done, unless a candidate is left undecided.

    Args:
        session: A writing session.
        image: The image.
        labels: Its labels.
        now: When.
        person: Who imports them.
        newly_added: Whether the image itself came just now. An empty label file of an image that was here before
            says nothing new.

    Returns:
        Whether anything was stored: labels of an image that has imported ones already are left alone.
    """
    session.execute(select(Image.id).where(Image.id == image.id).with_for_update())
    judged = labels.judged()
    if _has_labels(session, image, judged) or not (newly_added or any(len(part) for part, _ in judged)):
        return False
    rows: list[Segment] = []
    verdicts: list[str] = []
    reasons: list[str | None] = []
    first = session.scalar(_imported(image).with_only_columns(func.count(Segment.id))) or 0
    for part, words in judged:
        rows += segment_rows(image.id, part, first_ordinal=first + len(rows))
        verdicts += words
        reasons += part.reasons or (None,) * len(part)
    session.add_all(rows)
    image.revision += 1
    session.flush()
    decided = zip(rows, verdicts, reasons, strict=True)
    decisions = [
        _decision(row, verdict, reason, person, now) for row, verdict, reason in decided if verdict != "undecided"
    ]
    session.add_all(decisions)
    session.flush()
    session.add_all(
        SegmentState(
            segment_id=decision.segment_id, verdict=decision.verdict, reason=decision.reason, decision_id=decision.id
        )
        for decision in decisions
    )
    refresh_counts(session, [image.id])
    undecided = image.n_candidates - image.n_keep - image.n_reject - image.n_ambiguous
    if labels.labels is not None and not undecided:
        image.review.status, image.review.person, image.review.updated_at = "done", person, now
    session.flush()
    return True


def _has_labels(session: Session, image: Image, judged: Sequence[tuple[LabelledSegments, tuple[str, ...]]]) -> bool:
    """Whether labels were imported before: any with a verdict, or one of these; imported candidates are none."""
    decided = _imported(image).join(Decision, Decision.segment_id == Segment.id).where(Decision.kind == "import")
    if session.scalar(decided.limit(1)) is not None:
        return True
    known = set(session.scalars(_imported(image).with_only_columns(Segment.points)))
    return any(polyline.astype(POINT).tobytes() in known for part, _ in judged for polyline in part.segments)


def _imported(image: Image) -> Select[int]:
    return select(Segment.id).where(Segment.image_id == image.id, Segment.origin == "import")


def segment_rows(image_id: int, labelled: LabelledSegments, *, first_ordinal: int = 0) -> list[Segment]:
    """Return rows of origin ``import``, in the order of the file."""
    segments = labelled.segments
    boxes, lengths = segments.boxes().tolist(), segments.lengths().tolist()
    scores = [None] * len(segments) if segments.scores is None else segments.scores.tolist()
    straightness = [None] * len(segments) if labelled.straightness is None else labelled.straightness.tolist()
    return [
        Segment(
            image_id=image_id,
            ordinal=first_ordinal + ordinal,
            n_points=len(polyline),
            points=polyline.astype(POINT).tobytes(),
            x0=boxes[ordinal][0],
            y0=boxes[ordinal][1],
            x1=boxes[ordinal][2],
            y1=boxes[ordinal][3],
            length=lengths[ordinal],
            score=scores[ordinal],
            straightness=straightness[ordinal],
            origin="import",
        )
        for ordinal, polyline in enumerate(segments)
    ]


def _decision(row: Segment, verdict: str, reason: str | None, person: str | None, now: datetime) -> Decision:
    # ids that follow from the segment: the same import can't be stored twice
    return Decision(
        image_id=row.image_id,
        segment_id=row.id,
        person=person,
        verdict=verdict,
        previous="undecided",
        kind="import",
        reason=reason,
        client_id=str(uuid5(NAMESPACE_URL, f"import/segment/{row.id}")),
        group_id=str(uuid5(NAMESPACE_URL, f"import/image/{row.image_id}")),
        created_at=now,
    )
