"""The rows around the work: what is in hand is kept alive, what nobody has in hand is queued again, runs are ended."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from datetime import datetime, timedelta

from app.db.session import Database
from app.jobs.scoring_steps import submissions_in_hand
from app.jobs.stores import Stores
from app.jobs.work import DetectWork, Work
from app.services.calibration_queue import release_lost_calibrations
from app.services.lens_estimates import finish_settled_runs
from app.services.run_queue import beat, release_lost, unsettled_runs
from app.services.scoring_attempts import beat_submissions, release_lost_submissions
from app.services.tallies import IMAGES, RUNS, merge_tallies, owners_to_merge

logger = logging.getLogger(__name__)


def take_up_lost(stores: Stores, now: datetime) -> None:
    """Queue all work again that the rows call running; for who has just come to the lock and has nothing in hand."""
    with stores.database.write() as session:
        lost = release_lost(session, stores.max_attempts)
        lost += release_lost_submissions(session, stores.max_attempts, now)
        lost += release_lost_calibrations(session, stores.max_attempts, now)
    if lost:
        logger.info("took up %d pieces of work that were left behind", lost)


def keep_alive(work: Sequence[Work], stores: Stores, now: datetime, *, silence: timedelta) -> None:
    """Say that work is alive, queue again what nobody has said that of, and add up what was counted meanwhile.

    Args:
        work: All work in hand.
        stores: Where the rows are.
        now: When.
        silence: How long work may be silent.
    """
    images = [each.claim.run_image_id for each in work if isinstance(each, DetectWork)]
    with stores.database.write() as session:
        beat(session, images, now)
        beat_submissions(session, submissions_in_hand(work), now)
        # a claim whose commit went through although the connection broke is in nobody's hand
        release_lost(session, stores.max_attempts, silent_since=now - silence)
        release_lost_submissions(session, stores.max_attempts, now, silent_since=now - silence)
        release_lost_calibrations(session, stores.max_attempts, now, silent_since=now - silence)
        for tallied in (IMAGES, RUNS):
            for owner in owners_to_merge(session, tallied):
                merge_tallies(session, tallied, owner)


def finish_runs(database: Database, now: datetime) -> None:
    """End the runs that have nothing left to do."""
    with database.read() as session:
        settled = bool(unsettled_runs(session, limit=1))
    if settled:
        with database.write() as session:
            for run_id in finish_settled_runs(session, now):
                logger.info("run %d is finished", run_id)
