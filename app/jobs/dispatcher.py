"""The dispatcher: a thread that takes work from the rows, sends it to workers and stores each result as it arrives.

All that it keeps in memory may be lost at any moment: work that was running goes back to the queue when the next
dispatcher takes the lock, and finished work is never done again.
"""

from __future__ import annotations

import logging
import os
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor
from datetime import datetime, timedelta
from typing import Any

from app.db.session import Database
from app.jobs.executor import make_executor
from app.jobs.flight import Flight
from app.jobs.limits import TaskLimits
from app.jobs.lock import lock_for
from app.jobs.scoring_steps import scoring_in_hand, scoring_share, scoring_work, submissions_in_hand
from app.jobs.scoring_work import TotalWork
from app.jobs.stores import Stores
from app.jobs.trouble import DATABASE_TROUBLE, reason_of
from app.jobs.webhooks import Webhooks
from app.jobs.work import DetectWork, EstimateWork, JudgeWork, Tasks, Work
from app.services.lens_estimates import finish_settled_runs, pending_estimates, pending_judgements
from app.services.run_queue import (
    beat,
    claim_images,
    has_queued_images,
    killed_worker_error,
    release_lost,
    unsettled_runs,
)
from app.services.scoring_queue import (
    beat_submissions,
    claim_scoring,
    has_scoring_work,
    release_lost_submissions,
)
from app.services.submission_limits import submission_limits
from app.settings import Settings
from app.storage import BlobStore

logger = logging.getLogger(__name__)

DATABASE_PAUSE = 1.0  # s; how long to wait after the database couldn't answer


class Dispatcher:
    """Works off runs in the background, or until nothing is left.

    Args:
        database: Where the rows are.
        blobs: Where the images' bytes are.
        settings: ``workers``, ``max_attempts``, ``heartbeat_seconds``, ``stale_seconds``, ``max_image_pixels``.
        clock: Gives the time, UTC.
        executors: Makes an executor of so many workers; called again when a pool broke.
        tasks: What runs in a worker.
    """

    def __init__(
        self,
        database: Database,
        blobs: BlobStore,
        settings: Settings,
        clock: Callable[[], datetime],
        *,
        executors: Callable[[int], Executor] = make_executor,
        tasks: Tasks | None = None,
    ) -> None:
        self._database = database
        self._stores = Stores(
            database,
            blobs,
            settings.max_image_pixels,
            max_attempts=settings.max_attempts,
            submission_limits=submission_limits(settings),
            task_limits=TaskLimits(settings.scoring_seconds, settings.scoring_megabytes),
        )
        self._settings = settings
        self._clock = clock
        self._tasks = tasks or Tasks()
        workers = settings.workers or os.cpu_count() or 1
        self._signal = threading.Event()
        self._stopping = threading.Event()
        self._flight = Flight(workers, executors, self._signal.set)
        self._lock = lock_for(database)
        self._holds_lock = False
        self._last_beat: datetime | None = None
        self._thread: threading.Thread | None = None
        self._webhooks = Webhooks(database, settings, clock)

    def start(self) -> None:
        """Begin to work in the background; what an earlier dispatcher left behind is taken up."""
        if self._thread is None:
            self._stopping.clear()
            self._thread = threading.Thread(target=self._work, name="dispatcher", daemon=True)
            self._thread.start()
            self._webhooks.start()

    def wake(self) -> None:
        """Say that there is new work; safe from any thread."""
        self._signal.set()

    def stop(self) -> None:
        """Stop at once: work in flight goes back to the queue, uncharged, and the workers end."""
        self._stopping.set()
        self._signal.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None
            self._webhooks.stop()

    def run_until_idle(self, progress: Callable[[], None] | None = None) -> None:
        """Work in this thread until no run has anything left to do.

        Where another process holds the lock, it does the work and this one waits for it.

        Args:
            progress: Called whenever something may have changed.
        """
        self._stopping.clear()
        self._work(until_idle=True, progress=progress)

    def _work(self, *, until_idle: bool = False, progress: Callable[[], None] | None = None) -> None:
        try:
            while not self._stopping.is_set():
                self._signal.clear()
                pause = self._settings.heartbeat_seconds
                try:
                    self._turn(self._clock())
                    if progress is not None:
                        progress()
                    if until_idle and self._is_idle():
                        return
                except DATABASE_TROUBLE as error:
                    logger.warning("the database didn't answer, trying again: %s", error)
                    pause = min(pause, DATABASE_PAUSE)
                except Exception:
                    if until_idle:
                        raise
                    logger.exception("the dispatcher stumbled and goes on")
                self._signal.wait(pause)
        finally:
            self._leave()

    def _turn(self, now: datetime) -> None:
        if self._acquire_lock():
            self._collect(now)
            self._beat(now)
            self._settle(now)
            self._take(now)
            self._send(now)

    def _acquire_lock(self) -> bool:
        held = self._lock.acquire()
        if held and not self._holds_lock:
            with self._database.write() as session:
                lost = release_lost(session, self._settings.max_attempts)
                lost += release_lost_submissions(session, self._settings.max_attempts, self._clock())
            if lost:
                logger.info("took up %d pieces of work that were left behind", lost)
        if self._holds_lock and not held:
            logger.warning("another dispatcher took over")
            self._flight.clear()
        self._holds_lock = held
        return held

    def _collect(self, now: datetime) -> None:
        """Store what has arrived; what the database can't take now stays in hand for the next turn."""
        for future, work in self._flight.arrived():
            error = future.exception()
            if error is None:
                self._store(work, future.result(), now)
            else:
                work.fail(self._stores, reason_of(error), now)
            self._flight.drop(work)
            if isinstance(work, TotalWork):
                self._webhooks.wake()
        culprit = self._flight.recover()
        if culprit is not None:
            self._charge(culprit, now)

    def _store(self, work: Work, result: Any, now: datetime) -> None:
        try:
            work.store(self._stores, result, now)
        except DATABASE_TROUBLE:
            raise
        except Exception as error:
            logger.exception("the result of %s can't be stored", work.key)
            work.fail(self._stores, reason_of(error), now)

    def _charge(self, work: Work, now: datetime) -> None:
        """Count an attempt of work that killed its worker; when none is left it fails, alone."""
        if work.attempts >= self._settings.max_attempts:
            logger.error("%s killed its worker %d times and is given up", work.key, work.attempts)
            work.fail(self._stores, killed_worker_error(work.attempts), now)
            self._flight.drop(work)
            return
        logger.warning("%s killed its worker and is tried again", work.key)
        again = work.again(self._stores, now)
        if again is None:
            self._flight.drop(work)
        else:
            self._flight.replace(work, again)

    def _beat(self, now: datetime) -> None:
        if self._last_beat is not None and now - self._last_beat < timedelta(seconds=self._settings.heartbeat_seconds):
            return
        mine = [work.claim.run_image_id for work in self._flight.work if isinstance(work, DetectWork)]
        with self._database.write() as session:
            beat(session, mine, now)
            beat_submissions(session, submissions_in_hand(self._flight.work), now)
            # a claim whose commit went through although the connection broke is in nobody's hand
            silent = now - timedelta(seconds=self._settings.stale_seconds)
            release_lost(session, self._settings.max_attempts, silent_since=silent)
            release_lost_submissions(session, self._settings.max_attempts, now, silent_since=silent)
        self._last_beat = now

    def _settle(self, now: datetime) -> None:
        with self._database.read() as session:
            settled = bool(unsettled_runs(session, limit=1))
        if settled:
            with self._database.write() as session:
                for run_id in finish_settled_runs(session, now):
                    logger.info("run %d is finished", run_id)

    def _take(self, now: datetime) -> None:
        """Take work from the rows in hand, as much as there is room for."""
        if not self._flight.room:
            return
        self._take_scoring(now)
        known = {work.key for work in self._flight.work}
        with self._database.read() as session:
            steps: list[Work] = [EstimateWork(step) for step in pending_estimates(session)]
            steps += [JudgeWork(step) for step in pending_judgements(session, self._flight.room + len(known))]
            queued = has_queued_images(session)
        for work in [step for step in steps if step.key not in known][: self._flight.room]:
            self._flight.add(work)
        if queued and self._flight.room:
            with self._database.write() as session:
                claims = claim_images(session, self._flight.room, now)
            for claim in claims:
                # what was lost before may be what killed the server
                self._flight.add(DetectWork(claim), suspect=claim.attempts > 1)

    def _take_scoring(self, now: datetime) -> None:
        """Take the work of submissions first: somebody waits for it, and it is short."""
        with self._database.read() as session:
            if not has_scoring_work(session):
                return
            shared = has_queued_images(session)
        room = scoring_share(self._flight, shared=shared)
        if room > 0:
            with self._database.write() as session:
                claims = claim_scoring(session, room, scoring_in_hand(self._flight.work), now)
            for claim in claims:
                self._flight.add(scoring_work(claim), suspect=claim.claim.attempts > 1)

    def _send(self, now: datetime) -> None:
        while (work := self._flight.next()) is not None and not self._stopping.is_set():
            try:
                self._flight.send(work, lambda executor, work=work: work.begin(self._stores, self._tasks, executor))
            except BrokenExecutor:
                self._signal.set()
                return
            except DATABASE_TROUBLE:
                raise
            except Exception as error:
                logger.warning("%s can't be begun: %s", work.key, error)
                work.fail(self._stores, reason_of(error), now)
                self._flight.drop(work)

    def _is_idle(self) -> bool:
        if self._flight.work:
            return False
        with self._database.read() as session:
            pending = has_queued_images(session) or has_scoring_work(session) or unsettled_runs(session, limit=1)
        return not pending

    def _leave(self) -> None:
        """Put work back and let everything go; what can't be put back now, the next dispatcher takes up."""
        left = self._flight.work
        self._flight.clear()
        try:
            for work in left:
                work.put_back(self._stores)
        except DATABASE_TROUBLE as error:
            logger.warning("work in flight is taken up at the next start: %s", error)
        self._lock.release()
        self._holds_lock = False
        self._last_beat = None
