"""What comes back from workers: results are stored; work that cost its worker is tried again or given up."""

from __future__ import annotations

import logging
from collections.abc import Callable
from datetime import datetime
from typing import Any

from app.jobs.flight import Flight
from app.jobs.hanging import hung_worker_error, longest_seconds
from app.jobs.journal import Journal
from app.jobs.scoring_work import TotalWork
from app.jobs.stores import Stores
from app.jobs.trouble import DATABASE_TROUBLE, reason_of
from app.jobs.work import Work
from app.services.run_queue import killed_worker_error

logger = logging.getLogger(__name__)


def store_arrived(
    flight: Flight, stores: Stores, journal: Journal, now: datetime, *, on_total: Callable[[], None]
) -> None:
    """Store what has arrived; what the database can't take now stays in hand for the next turn.

    Args:
        flight: Work in hand.
        stores: Where results go.
        journal: Where it is noted.
        now: When.
        on_total: Called when the score of a submission was stored.
    """
    for future, work in flight.arrived():
        with journal.about(work):
            error = future.exception()
            reason = _store(work, stores, future.result(), now) if error is None else reason_of(error)
            if reason is not None:
                work.fail(stores, reason, now)
        journal.ended(work, "done" if reason is None else "failed", reason)
        flight.drop(work)
        if isinstance(work, TotalWork):
            on_total()
    for culprit in flight.recover():
        journal.ended(culprit, "lost", killed_worker_error(culprit.attempts))
        _charge(culprit, flight, stores, killed_worker_error(culprit.attempts), now)


def end_hung(
    flight: Flight, stores: Stores, journal: Journal, seconds: float, task_seconds: float, now: datetime
) -> None:
    """Take work for hung that takes too long: its worker is ended, and it is tried again or given up.

    Args:
        flight: Work in hand.
        stores: Where results go.
        journal: Where it is noted.
        seconds: Of a clock that doesn't jump.
        task_seconds: How long work may take; longer where a bound of its own ends it.
        now: When.
    """
    for culprit in flight.end_hung(seconds, lambda work: longest_seconds(work, stores, task_seconds)):
        longest = longest_seconds(culprit, stores, task_seconds)
        journal.ended(culprit, "lost", hung_worker_error(culprit.attempts, longest))
        _charge(culprit, flight, stores, hung_worker_error(culprit.attempts, longest), now)


def _store(work: Work, stores: Stores, result: Any, now: datetime) -> dict[str, Any] | None:
    """Store a result; return why it can't be, where it can't."""
    try:
        work.store(stores, result, now)
    except DATABASE_TROUBLE:
        raise
    except Exception as error:
        logger.exception("the result of %s can't be stored", work.key)
        return reason_of(error)
    return None


def _charge(work: Work, flight: Flight, stores: Stores, error: dict[str, Any], now: datetime) -> None:
    """Count an attempt of work that cost its worker; when none is left it fails, alone."""
    if work.attempts >= stores.max_attempts:
        logger.error("%s is given up after %d attempts", work.key, work.attempts)
        work.fail(stores, error, now)
        flight.drop(work)
        return
    logger.warning("%s is tried again", work.key)
    again = work.again(stores, now)
    if again is None:
        flight.drop(work)
    else:
        flight.replace(work, again)
