"""What comes back from workers: results are stored, and work that killed its worker is tried again or given up."""

from __future__ import annotations

import logging
from collections.abc import Callable
from datetime import datetime
from typing import Any

from app.jobs.flight import Flight
from app.jobs.scoring_work import TotalWork
from app.jobs.stores import Stores
from app.jobs.trouble import DATABASE_TROUBLE, reason_of
from app.jobs.work import Work
from app.services.run_queue import killed_worker_error

logger = logging.getLogger(__name__)


def store_arrived(flight: Flight, stores: Stores, now: datetime, *, on_total: Callable[[], None]) -> None:
    """Store what has arrived; what the database can't take now stays in hand for the next turn.

    Args:
        flight: Work in hand.
        stores: Where results go.
        now: When.
        on_total: Called when the score of a submission was stored.
    """
    for future, work in flight.arrived():
        error = future.exception()
        if error is None:
            _store(work, stores, future.result(), now)
        else:
            work.fail(stores, reason_of(error), now)
        flight.drop(work)
        if isinstance(work, TotalWork):
            on_total()
    culprit = flight.recover()
    if culprit is not None:
        _charge(culprit, flight, stores, now)


def _store(work: Work, stores: Stores, result: Any, now: datetime) -> None:
    try:
        work.store(stores, result, now)
    except DATABASE_TROUBLE:
        raise
    except Exception as error:
        logger.exception("the result of %s can't be stored", work.key)
        work.fail(stores, reason_of(error), now)


def _charge(work: Work, flight: Flight, stores: Stores, now: datetime) -> None:
    """Count an attempt of work that killed its worker; when none is left it fails, alone."""
    if work.attempts >= stores.max_attempts:
        logger.error("%s killed its worker %d times and is given up", work.key, work.attempts)
        work.fail(stores, killed_worker_error(work.attempts), now)
        flight.drop(work)
        return
    logger.warning("%s killed its worker and is tried again", work.key)
    again = work.again(stores, now)
    if again is None:
        flight.drop(work)
    else:
        flight.replace(work, again)
