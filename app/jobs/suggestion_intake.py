"""What suggestions need is taken in hand last: when nothing of runs or submissions waits, one piece at a time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from sqlalchemy.orm import Session

from app.db.session import Database
from app.jobs.flight import Flight
from app.jobs.suggestion_work import FeaturesWork, TrainWork
from app.services.suggestion_examples import images_to_describe
from app.services.suggestion_features import feature_inputs, images_without_features
from app.services.suggestion_training import next_training

LONG = 0.1  # s
REST = 20.0
"""Where looking took long and found nothing to do, it isn't looked again for so many times as long."""


class SuggestionIntake:
    """Takes what suggestions need in hand; it remembers where nothing was due, so as not to count all over again.

    Looking reads a row of every image. That is nothing in a small installation; in a large one, it is done the less
    often the longer it takes: a twentieth of one processor's time is spent on it at most.

    Args:
        clock: Gives the time that has passed since some moment, s.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._looked_at: dict[int, int] = {}
        self._clock = clock
        self._resting_until = -math.inf

    def take(self, flight: Flight, database: Database) -> None:
        """Take the next piece in hand, if nothing else is.

        A training waits for the features of what it learns from; those of all other images come after it.

        Args:
            flight: Work in hand.
            database: Where the rows are.
        """
        begun = self._clock()
        if flight.work or begun < self._resting_until:
            return
        with database.read() as session:
            work = self._next(session)
        if work is not None:
            flight.add(work)
            return
        took = self._clock() - begun
        if took > LONG:
            self._resting_until = begun + took + REST * took

    def _next(self, session: Session) -> FeaturesWork | TrainWork | None:
        due = next_training(session, self._looked_at)
        if due is not None:
            image_id = session.scalar(images_to_describe(due.dataset_id).limit(1))
            return TrainWork(due) if image_id is None else FeaturesWork(feature_inputs(session, image_id))
        waiting = images_without_features(session, 1)
        return FeaturesWork(feature_inputs(session, waiting[0])) if waiting else None
