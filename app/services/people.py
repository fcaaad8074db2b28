"""People: names that can be, and what each has to do and has done in a dataset."""

from __future__ import annotations

import unicodedata
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Dataset, ImagePerson, ImageTally, Review
from app.errors import InvalidInput
from app.services.tallies import counts_by, of_dataset

PERSON_LENGTH = 80
WORK = ("judge", "accept", "take_over", "undo", "redo")
"""Kinds of decisions that a person made; a run's carrying and an import aren't work."""


@dataclass(frozen=True)
class PersonEntry:
    """One who has images to review, or decided on some.

    Attributes:
        person: The name.
        assigned: Images that are theirs to review.
        done: Those of them that aren't open any more.
        decisions: Verdicts they gave in the dataset.
    """

    person: str
    assigned: int
    done: int
    decisions: int


def checked_person(name: str, where: str = "person") -> str:
    """Return a person's name in Unicode's composed form, with single spaces.

    Raises:
        InvalidInput: When it is empty, too long, or has characters that can't be seen.
    """
    name = " ".join(part for part in unicodedata.normalize("NFC", name).split(" ") if part)
    if not name or len(name) > PERSON_LENGTH or not name.isprintable():
        raise InvalidInput(
            "this can't be a person's name", where=where, expected=f"1 to {PERSON_LENGTH} characters that can be seen"
        )
    return name


def people_of(session: Session, dataset: Dataset, decided: Mapping[str, int]) -> list[PersonEntry]:
    """Return everyone who has images of a dataset to review or decided on some, by name.

    Args:
        session: Any session.
        dataset: The dataset.
        decided: Number of verdicts that each person gave in it.
    """
    given = ImageTally.assignee.is_not(None)
    images = counts_by(session, ImageTally.assignee, of_dataset(dataset), given)
    done = counts_by(session, ImageTally.assignee, of_dataset(dataset), given, ImageTally.review_status != "open")
    assigned = {person: (count, done.get(person, 0)) for person, count in images.items()}
    return [
        PersonEntry(person, *assigned.get(person, (0, 0)), decided.get(person, 0))
        for person in sorted({*assigned, *decided}, key=lambda name: (name.casefold(), name))
    ]


def first_reviewers(session: Session, image_ids: Collection[int]) -> dict[int, set[str]]:
    """Return who judged candidates of images, or said that the image is done."""
    found: dict[int, set[str]] = {image_id: set() for image_id in image_ids}
    judged = select(ImagePerson.image_id, ImagePerson.person).where(ImagePerson.image_id.in_(image_ids))
    finished = select(Review.image_id, Review.person).where(
        Review.image_id.in_(image_ids), Review.person.is_not(None), Review.status != "open"
    )
    for query in (judged, finished):
        for image_id, person in session.execute(query):
            if person is not None:
                found[image_id].add(person)
    return found
