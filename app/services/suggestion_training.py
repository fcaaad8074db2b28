"""When a dataset's suggestions are learnt anew, and what was learnt."""

from __future__ import annotations

from collections.abc import MutableMapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Select, func, or_, select
from sqlalchemy.orm import Session

from app.db.models import Dataset, Decision, Image, Review, SuggestionModel, SuggestionTraining
from app.errors import Conflict
from app.services.events import record_event
from app.services.suggestion_examples import judged_candidates, teaches
from app.services.suggestion_models import latest_model

FEWEST_DECISIONS = 40
"""Decisions that a first model is learnt from, and by which a later one is ahead, at least."""
GROWTH = 1.2
"""A later model is learnt from so many times the decisions of the one before."""
PAUSE_AFTER_FAILURE = 200
"""A training that failed isn't tried again by itself before so many newer decisions."""


@dataclass(frozen=True)
class TrainingDue:
    """A dataset that there is enough new to learn from.

    Attributes:
        n_decisions: Candidates judged by a person, on images all of whose candidates are decided.
        n_images: These images.
        last_decision_id: The newest decision on the dataset.
    """

    dataset_id: int
    n_decisions: int
    n_images: int
    last_decision_id: int


def next_training(session: Session, looked_at: MutableMapping[int, int] | None = None) -> TrainingDue | None:
    """Return a dataset whose model is to be learnt anew, or for the first time; those asked for come first.

    Args:
        session: Any session.
        looked_at: By dataset, the newest decision at which nothing was due: it isn't counted again before a newer one.
            Kept up to date here.
    """
    looked_at = {} if looked_at is None else looked_at
    asked = SuggestionTraining.asked_at.is_not(None)
    counts = _counts_from_above().subquery()
    rows = session.execute(
        select(counts, SuggestionTraining)
        .outerjoin(SuggestionTraining, SuggestionTraining.dataset_id == counts.c.dataset_id)
        .where(or_(asked, counts.c.decided >= FEWEST_DECISIONS))
        .order_by(SuggestionTraining.asked_at.is_(None), counts.c.dataset_id)
    ).all()
    for row in rows:
        training: SuggestionTraining | None = row.SuggestionTraining
        is_asked = training is not None and training.asked_at is not None
        if not is_asked and looked_at.get(row.dataset_id) == row.newest:
            continue
        if not is_asked and row.decided < wanted_decisions(session, row.dataset_id):
            continue
        due = training_due(session, row.dataset_id)
        if is_asked or (_is_enough(session, due) and not _failed_lately(training, due)):
            return due
        looked_at[row.dataset_id] = row.newest
    return None


def training_due(session: Session, dataset_id: int) -> TrainingDue:
    """Return what a model of a dataset would be learnt from now."""
    judged = judged_candidates(dataset_id).subquery()
    decisions, images = session.execute(
        select(func.count(), func.count(judged.c.image_id.distinct())).select_from(judged)
    ).one()
    newest = select(func.max(Decision.id)).join(Image, Image.id == Decision.image_id)
    return TrainingDue(dataset_id, decisions, images, session.scalar(newest.where(Image.dataset_id == dataset_id)) or 0)


def ask_for_training(session: Session, dataset: Dataset, now: datetime, *, person: str | None = None) -> TrainingDue:
    """Have a dataset's model learnt as soon as possible, however few decisions are new.

    Args:
        session: A writing session.
        dataset: The dataset.
        now: When.
        person: Who asks.

    Raises:
        Conflict: When there is too little to learn from.
    """
    due = training_due(session, dataset.id)
    if due.n_decisions < FEWEST_DECISIONS:
        raise Conflict(
            f"{due.n_decisions} decisions are too few to learn from",
            where=dataset.slug,
            expected=f"{FEWEST_DECISIONS} on images whose candidates are all decided",
            hint="until then the general model suggests",
            details={"decisions": due.n_decisions, "images": due.n_images},
        )
    row = session.get(SuggestionTraining, dataset.id, with_for_update=True)
    if row is None:
        row = SuggestionTraining(dataset_id=dataset.id)
        session.add(row)
    row.asked_at, row.error = now, None
    details = {"decisions": due.n_decisions, "images": due.n_images}
    record_event(session, "suggestions.asked", now, dataset_id=dataset.id, person=person, details=details)
    return due


def store_model(
    session: Session,
    due: TrainingDue,
    version: str,
    parameters: dict[str, Any],
    report: dict[str, Any],
    now: datetime,
) -> SuggestionModel | None:
    """Store what was learnt; ``None`` when the dataset is gone."""
    if session.get(Dataset, due.dataset_id, with_for_update=True) is None:
        return None
    training = session.get(SuggestionTraining, due.dataset_id)
    if training is not None:
        session.delete(training)
    model = SuggestionModel(
        dataset_id=due.dataset_id,
        version=version,
        n_decisions=due.n_decisions,
        n_images=due.n_images,
        last_decision_id=due.last_decision_id,
        parameters=parameters,
        report=report,
        created_at=now,
    )
    session.add(model)
    session.flush()
    return model


def fail_training(session: Session, due: TrainingDue, error: dict[str, Any]) -> None:
    """Store why nothing could be learnt."""
    if session.get(Dataset, due.dataset_id, with_for_update=True) is None:
        return
    row = session.get(SuggestionTraining, due.dataset_id)
    if row is None:
        row = SuggestionTraining(dataset_id=due.dataset_id)
        session.add(row)
    row.asked_at, row.error, row.failed_decision_id = None, error, due.last_decision_id


def _counts_from_above() -> Select[int, int, int]:
    """Select each dataset with its newest decision and a bound, from above, of what its model would be learnt from.

    Both are cheap; to leave out what was imported is not.
    """
    newest = select(func.max(Decision.id)).where(Decision.image_id == Image.id).correlate(Image).scalar_subquery()
    return (
        select(
            Image.dataset_id,
            func.sum(Image.n_keep + Image.n_reject).label("decided"),
            func.max(newest).label("newest"),
        )
        .join(Review, Review.image_id == Image.id)
        .join(Dataset, Dataset.id == Image.dataset_id)
        .where(Dataset.deleted_at.is_(None), teaches())
        .group_by(Image.dataset_id)
    )


def _is_enough(session: Session, due: TrainingDue) -> bool:
    return due.n_decisions >= wanted_decisions(session, due.dataset_id)


def wanted_decisions(session: Session, dataset_id: int) -> float:
    """Return the number of decisions from which on a dataset's model is learnt anew by itself."""
    model = latest_model(session, dataset_id)
    known = 0 if model is None else model.n_decisions
    return max(known * GROWTH, known + FEWEST_DECISIONS)


def _failed_lately(training: SuggestionTraining | None, due: TrainingDue) -> bool:
    if training is None or training.failed_decision_id is None:
        return False
    return due.last_decision_id < training.failed_decision_id + PAUSE_AFTER_FAILURE
