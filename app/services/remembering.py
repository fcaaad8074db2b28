"""What is counted over all of a large dataset is counted at most once a minute, however many look at it.

Of a small dataset everything is counted afresh each time: nobody is shown what was so a minute ago without need.
"""

from __future__ import annotations

import logging
from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from datetime import datetime, timedelta
from threading import Lock, Thread
from typing import Any, TypeVar

from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from app.db.models import Dataset, ImageTally
from app.errors import ClearLinesError
from app.services.tallies import image_count

logger = logging.getLogger(__name__)

FRESH = timedelta(minutes=1)
"""So old a figure is shown as it is; an older one is shown too, and counted anew meanwhile."""
OLD = timedelta(minutes=10)
"""An older one isn't shown: whoever asks waits."""
LARGE = 2_000
"""Images of a dataset whose figures are remembered."""
MOST = 64

Value = TypeVar("Value")


@dataclass(frozen=True)
class _Figure:
    value: Any
    at: datetime


class Remembered:
    """Remembers figures by what they are of. Safe to use from several threads."""

    def __init__(self) -> None:
        self._figures: OrderedDict[Hashable, _Figure] = OrderedDict()
        self._at_work: dict[Hashable, Lock] = {}
        self._lock = Lock()

    def get(self, key: Hashable, now: datetime, make: Callable[[], Value]) -> Value:
        """Return a figure that is at most ``OLD``; of several who have to wait, the first one counts.

        Args:
            key: What it is of.
            now: When it is asked for.
            make: Counts it, in a session of its own.
        """
        figure = self._known(key)
        if figure is None or now - figure.at > OLD:
            with self._working(key):
                figure = self._known(key)
                if figure is None or now - figure.at > OLD:
                    figure = self._put(key, make(), now)
        elif now - figure.at > FRESH:
            Thread(target=self._renew, args=(key, now, make), name="counting", daemon=True).start()
        value: Value = figure.value
        return value

    def _renew(self, key: Hashable, now: datetime, make: Callable[[], Any]) -> None:
        working = self._working(key)
        if not working.acquire(blocking=False):
            return  # somebody is at it
        try:
            self._put(key, make(), now)
        except (SQLAlchemyError, ClearLinesError) as error:  # whoever asks next tries again, and is told
            logger.info("%s couldn't be counted anew: %s", key, error)
        finally:
            working.release()

    def _known(self, key: Hashable) -> _Figure | None:
        with self._lock:
            return self._figures.get(key)

    def _working(self, key: Hashable) -> Lock:
        with self._lock:
            return self._at_work.setdefault(key, Lock())

    def _put(self, key: Hashable, value: Any, now: datetime) -> _Figure:
        figure = _Figure(value, now)
        with self._lock:
            self._figures[key] = figure
            self._figures.move_to_end(key)
            while len(self._figures) > MOST:
                gone, _ = self._figures.popitem(last=False)
                self._at_work.pop(gone, None)
        return figure


def is_large(session: Session, dataset: Dataset) -> bool:
    """Whether a dataset's figures are remembered, deleted images counted too."""
    return image_count(session, ImageTally.dataset_id == dataset.id) > LARGE
