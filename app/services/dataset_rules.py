"""How a dataset is to be labelled: guidelines to read, and rules that the program itself follows."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from datetime import datetime
from typing import Any

from sqlalchemy.orm import Session

from app.db.models import Dataset
from app.errors import InvalidInput
from app.services.datasets import get_dataset
from app.services.events import record_event
from app.services.given import UNCHANGED, Unchanged, checked_text


@dataclass(frozen=True)
class Rules:
    """What is asked of the people.

    Attributes:
        second_share: Share of the images that a second person reviews without seeing the first review, in [0, 1].
        ask_recall: Whether whoever finishes an image says how much of what is straight its labels hold.
    """

    second_share: float = 0.0
    ask_recall: bool = False


@dataclass(frozen=True)
class Guidelines:
    """What annotators read, and what they are asked."""

    guidelines: str | None
    rules: Rules


def rules_of(dataset: Dataset) -> Rules:
    """Return a dataset's rules; those that were never set have their defaults."""
    known = {field.name for field in fields(Rules)}
    return Rules(**{name: value for name, value in (dataset.rules or {}).items() if name in known})


def guidelines_of(dataset: Dataset) -> Guidelines:
    """Return what a dataset's annotators read and are asked."""
    return Guidelines(dataset.guidelines, rules_of(dataset))


def change_rules(
    session: Session,
    slug: str,
    now: datetime,
    *,
    guidelines: str | Unchanged | None = UNCHANGED,
    rules: Rules | Unchanged = UNCHANGED,
    person: str | None = None,
) -> Dataset:
    """Change a dataset's guidelines or rules.

    Args:
        session: A writing session.
        slug: Of the dataset.
        now: When.
        guidelines: Markdown; ``None`` clears them.
        rules: All of them.
        person: Who does it.

    Raises:
        NotFound: When there is no such dataset.
        InvalidInput: When the text is too long or holds a NUL character, or the share isn't one.
    """
    dataset = get_dataset(session, slug)
    changed: dict[str, Any] = {}
    if guidelines is not UNCHANGED:
        text = checked_text(guidelines, "guidelines")
        if text != dataset.guidelines:
            dataset.guidelines = text
            changed["guidelines"] = None if text is None else len(text)
    if rules is not UNCHANGED:
        if not 0.0 <= rules.second_share <= 1.0:
            raise InvalidInput("this is no share", where="rules.second_share", expected="0 to 1")
        if rules != rules_of(dataset):
            dataset.rules = asdict(rules)
            changed["rules"] = asdict(rules)
    if changed:
        session.flush()
        record_event(session, "dataset.rules", now, dataset_id=dataset.id, person=person, details=changed)
    return dataset
