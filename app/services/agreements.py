"""How far people agree: Cohen's kappa of first and second verdicts, over all, per image, pair, person and length."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import Adjudication, Dataset, Image, SecondReview
from app.review.agreement import Kappa, LengthBin, kappa_by_length, kappa_of
from app.services.verdict_pairs import JUDGED, VerdictPair, verdict_pairs

Key = TypeVar("Key", bound=Hashable)


@dataclass(frozen=True)
class ImageAgreement:
    """Agreement on one image."""

    image_id: int
    name: str
    second_person: str | None
    kappa: Kappa


@dataclass(frozen=True)
class PairAgreement:
    """Agreement of one person's first verdicts with another's second ones."""

    first: str | None
    second: str | None
    kappa: Kappa


@dataclass(frozen=True)
class PersonAgreement:
    """Agreement of one person with all others, whoever was first."""

    person: str | None
    kappa: Kappa


@dataclass(frozen=True)
class Agreement:
    """Agreement in a dataset.

    Attributes:
        reviews: Second reviews that are done.
        overall: Of all candidates that two people judged.
        images: By name.
        pairs: First and second person.
        people: Each against all others.
        lengths: By arc length of the candidate.
        differences: Candidates on which the verdicts differ.
        adjudicated: Those of them that were decided since.
    """

    reviews: int
    overall: Kappa
    images: tuple[ImageAgreement, ...]
    pairs: tuple[PairAgreement, ...]
    people: tuple[PersonAgreement, ...]
    lengths: tuple[LengthBin, ...]
    differences: int
    adjudicated: int


def agreement_of(session: Session, dataset: Dataset) -> Agreement:
    """Return how far the people of a dataset agree; reviews that aren't done count for nothing."""
    pairs = verdict_pairs(session, dataset)
    done = (
        select(func.count(SecondReview.id))
        .join(Image, Image.id == SecondReview.image_id)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None), SecondReview.status == "done")
    )
    adjudicated = done.with_only_columns(func.count(Adjudication.segment_id)).join(
        Adjudication, Adjudication.second_review_id == SecondReview.id
    )
    by_image = _grouped(pairs, lambda pair: (pair.image_id, pair.image, pair.second_person))
    by_people = _grouped(pairs, lambda pair: (pair.first_person, pair.second_person))
    people = {person: _of_person(pairs, person) for pair in by_people for person in pair}
    lengths = kappa_by_length(
        [pair.first for pair in pairs],
        [pair.second for pair in pairs],
        [pair.length for pair in pairs],
        JUDGED,
    )
    return Agreement(
        reviews=session.scalar(done) or 0,
        overall=_kappa(pairs),
        images=tuple(ImageAgreement(*key, _kappa(group)) for key, group in by_image.items()),
        pairs=tuple(PairAgreement(*key, _kappa(group)) for key, group in sorted(by_people.items(), key=str)),
        people=tuple(PersonAgreement(person, _kappa(group)) for person, group in sorted(people.items(), key=str)),
        lengths=lengths,
        differences=sum(pair.first != pair.second for pair in pairs),
        adjudicated=session.scalar(adjudicated) or 0,
    )


def _kappa(pairs: Sequence[VerdictPair]) -> Kappa:
    return kappa_of([pair.first for pair in pairs], [pair.second for pair in pairs], JUDGED)


def _grouped(pairs: Sequence[VerdictPair], key: Callable[[VerdictPair], Key]) -> dict[Key, list[VerdictPair]]:
    groups: dict[Key, list[VerdictPair]] = {}
    for pair in pairs:
        groups.setdefault(key(pair), []).append(pair)
    return groups


def _of_person(pairs: Sequence[VerdictPair], person: str | None) -> list[VerdictPair]:
    return [pair for pair in pairs if person in (pair.first_person, pair.second_person)]
