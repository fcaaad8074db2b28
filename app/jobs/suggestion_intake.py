"""What suggestions need is taken in hand last: when nothing of runs or submissions waits, one piece at a time."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.db.session import Database
from app.jobs.flight import Flight
from app.jobs.suggestion_work import FeaturesWork, TrainWork
from app.services.suggestion_examples import images_to_describe
from app.services.suggestion_features import feature_inputs, images_without_features
from app.services.suggestion_training import next_training


class SuggestionIntake:
    """Takes what suggestions need in hand; it remembers where nothing was due, so as not to count all over again."""

    def __init__(self) -> None:
        self._looked_at: dict[int, int] = {}

    def take(self, flight: Flight, database: Database) -> None:
        """Take the next piece in hand, if nothing else is.

        A training waits for the features of what it learns from; those of all other images come after it.

        Args:
            flight: Work in hand.
            database: Where the rows are.
        """
        if flight.work:
            return
        with database.read() as session:
            work = self._next(session)
        if work is not None:
            flight.add(work)

    def _next(self, session: Session) -> FeaturesWork | TrainWork | None:
        due = next_training(session, self._looked_at)
        if due is not None:
            image_id = session.scalar(images_to_describe(due.dataset_id).limit(1))
            return TrainWork(due) if image_id is None else FeaturesWork(feature_inputs(session, image_id))
        waiting = images_without_features(session, 1)
        return FeaturesWork(feature_inputs(session, waiting[0])) if waiting else None
