"""Choosing images by what is known of their candidates: verdicts, scores, and who decided."""

from __future__ import annotations

from sqlalchemy import ColumnElement, exists

from app.db.models import Image, ImagePerson, Segment
from app.errors import InvalidInput
from app.services.candidates import is_current
from app.verdicts import VERDICTS


def candidate_conditions(
    person: str | None, verdict: str | None, min_score: float | None, max_score: float | None
) -> list[ColumnElement[bool]]:
    """Return conditions on ``Image``; a bound that is ``None`` is none.

    Args:
        person: Who decided on at least one of its candidates.
        verdict: That at least one of its candidates has.
        min_score: With a candidate of at least this score.
        max_score: With a candidate of at most this score.

    Raises:
        InvalidInput: On an unknown verdict.
    """
    conditions: list[ColumnElement[bool]] = []
    if person is not None:
        conditions.append(has_decided(person))
    if verdict is not None:
        conditions.append(_number_of(verdict) > 0)
    if min_score is not None:
        conditions.append(Image.highest_score >= min_score)
    if max_score is not None:
        conditions.append(Image.lowest_score <= max_score)
    if min_score is not None and max_score is not None:
        between = (Segment.score >= min_score) & (Segment.score <= max_score)
        conditions.append(exists().where(Segment.image_id == Image.id, between, is_current()).correlate(Image))
    return conditions


def has_decided(person: str) -> ColumnElement[bool]:
    """Return the condition on ``Image`` that a person decided on at least one of its candidates."""
    return exists().where(ImagePerson.image_id == Image.id, ImagePerson.person == person).correlate(Image)


def _number_of(verdict: str) -> ColumnElement[int]:
    numbers: dict[str, ColumnElement[int]] = {
        "keep": Image.n_keep.expression,
        "reject": Image.n_reject.expression,
        "ambiguous": Image.n_ambiguous.expression,
        "undecided": Image.n_candidates - Image.n_keep - Image.n_reject - Image.n_ambiguous,
    }
    if verdict not in numbers:
        raise InvalidInput(f"{verdict!r:.60} is no verdict", where="verdict", expected=", ".join(VERDICTS))
    return numbers[verdict]
