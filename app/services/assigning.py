"""Whose task an image is: given by hand, or in equal shares that keep a drive with one person."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from app.db.models import Dataset, Image, Review
from app.errors import InvalidInput
from app.services.batches import in_batches
from app.services.events import record_event
from app.services.images import images_of
from app.services.people import checked_person

AssignMode = Literal["to", "shares"]
MOST_PEOPLE = 100


@dataclass(frozen=True)
class Task:
    """An image that somebody is to review: its id, its name, and the drive it belongs to."""

    image_id: int
    name: str
    sequence: str | None


@dataclass(frozen=True)
class Share:
    """How many images a person was given."""

    person: str
    images: int


def assign(
    session: Session,
    dataset: Dataset,
    people: Sequence[str],
    mode: AssignMode,
    image_ids: Sequence[int] | None,
    now: datetime,
    *,
    person: str | None = None,
) -> list[Share]:
    """Say who is to review images.

    Args:
        session: A writing session.
        dataset: The dataset.
        people: Names. With the mode ``to`` one, or none to make the images nobody's.
        mode: ``to`` gives all images to one person, ``shares`` as many to each as drives allow.
        image_ids: Which ones; when left out all open images that are nobody's yet.
        now: When.
        person: Who says so.

    Returns:
        How many images each was given, in the order of the people.

    Raises:
        InvalidInput: On names that can't be, the same one twice, or a number of people that the mode doesn't take.
        NotFound: Naming the ids that no image of the dataset has.
    """
    names = _checked_people(people, mode)
    session.get_one(
        Dataset, dataset.id, with_for_update={"key_share": True}
    )  # who shares out at once shares what is left then
    tasks = _tasks(session, dataset, image_ids)
    shares = dict.fromkeys(names, tasks) if mode == "to" else equal_shares(tasks, names)
    if not names:
        _set_assignee(session, tasks, None)
    for name, share in shares.items():
        _set_assignee(session, share, name)
    given = [Share(name, len(share)) for name, share in shares.items()]
    if tasks:
        details = {
            "ids": [task.image_id for task in tasks],
            "people": {share.person: share.images for share in given},
            "mode": mode,
        }
        record_event(session, "images.assigned", now, dataset_id=dataset.id, person=person, details=details)
    return given


def equal_shares(tasks: Sequence[Task], people: Sequence[str]) -> dict[str, list[Task]]:
    """Share images out so that each person gets about as many; the same images are shared the same way each time.

    Each drive goes whole to whoever has least, the longest first (Graham, "Bounds on multiprocessing timing
    anomalies", 1969). Images of no drive fill up what is missing, neighbours by name together.

    Args:
        tasks: The images.
        people: At least one name, each once.
    """
    drives: dict[str, list[Task]] = {}
    for task in sorted(tasks, key=lambda task: task.name):
        if task.sequence is not None:
            drives.setdefault(task.sequence, []).append(task)
    shares: dict[str, list[Task]] = {name: [] for name in people}
    for _, drive in sorted(drives.items(), key=lambda item: (-len(item[1]), item[0])):
        min(shares.values(), key=len).extend(drive)
    alone = [task for task in sorted(tasks, key=lambda task: task.name) if task.sequence is None]
    start = 0
    for name, missing in _missing([len(share) for share in shares.values()], len(alone), people):
        shares[name] += alone[start : start + missing]
        start += missing
    return shares


def _missing(sizes: Sequence[int], left: int, people: Sequence[str]) -> list[tuple[str, int]]:
    """Return how many more each person gets so that, as far as they go, all have as many."""
    level = list(sizes)
    for _ in range(left):
        level[level.index(min(level))] += 1
    return [(name, after - before) for name, before, after in zip(people, sizes, level, strict=True)]


def _checked_people(people: Sequence[str], mode: AssignMode) -> list[str]:
    names = [checked_person(name, f"people[{number}]") for number, name in enumerate(people)]
    if len(set(names)) != len(names):
        raise InvalidInput("a name is given twice", where="people", expected="each person once")
    if mode == "to" and len(names) > 1:
        raise InvalidInput("an image is one person's", where="people", expected="one name, or none to take it back")
    if mode == "shares" and not 1 <= len(names) <= MOST_PEOPLE:
        raise InvalidInput(
            f"images can't be shared among {len(names)} people", where="people", expected=f"1 to {MOST_PEOPLE} names"
        )
    return names


def _tasks(session: Session, dataset: Dataset, image_ids: Sequence[int] | None) -> list[Task]:
    if image_ids is not None:
        return [Task(image.id, image.name, image.sequence) for image in images_of(session, dataset, image_ids)]
    rows = session.execute(
        select(Image.id, Image.name, Image.sequence)
        .join(Review, Review.image_id == Image.id)
        .where(
            Image.dataset_id == dataset.id,
            Image.deleted_at.is_(None),
            Image.assignee.is_(None),
            Review.status == "open",
        )
    )
    return [Task(*row) for row in rows]


def _set_assignee(session: Session, tasks: Sequence[Task], person: str | None) -> None:
    for batch in in_batches([task.image_id for task in tasks]):
        session.execute(update(Image).where(Image.id.in_(batch)).values(assignee=person))
