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

from app.db.session import Database
from app.jobs.arrivals import store_arrived
from app.jobs.calibration_work import has_calibrations, look_after_calibrations
from app.jobs.executor import make_background_executor
from app.jobs.flight import Flight
from app.jobs.intake import take_work, work_is_left
from app.jobs.limits import TaskLimits
from app.jobs.lock import lock_for
from app.jobs.stores import Stores
from app.jobs.suggestion_intake import SuggestionIntake
from app.jobs.trouble import DATABASE_TROUBLE, reason_of
from app.jobs.upkeep import finish_runs, keep_alive, take_up_lost
from app.jobs.webhooks import Webhooks
from app.jobs.work import Tasks
from app.services.submission_limits import submission_limits
from app.settings import Settings
from app.storage import BlobStore

logger = logging.getLogger(__name__)

DATABASE_PAUSE = 1.0  # s; how long to wait after the database couldn't answer
LONG_WORK_PAUSE = 1.0  # s; how often long work in hand is asked how far it is, and told if nobody wants it any more


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
        executors: Callable[[int], Executor] = make_background_executor,
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
        self._suggestions = SuggestionIntake()
        self._lock = lock_for(database)
        self._holds_lock = False
        self._last_beat: datetime | None = None
        self._last_look: datetime | None = None
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
                    self._turn(self._clock(), None if until_idle else self._suggestions)
                    if has_calibrations(self._flight.work):
                        pause = min(pause, LONG_WORK_PAUSE)
                    if progress is not None:
                        progress()
                    if until_idle and not self._flight.work and not work_is_left(self._database):
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

    def _turn(self, now: datetime, suggestions: SuggestionIntake | None) -> None:
        if self._acquire_lock():
            store_arrived(self._flight, self._stores, now, on_total=self._webhooks.wake)
            self._beat(now)
            self._look_after_long_work(now)
            finish_runs(self._database, now)
            take_work(self._flight, self._database, now, suggestions)
            self._send(now)

    def _acquire_lock(self) -> bool:
        held = self._lock.acquire()
        if held and not self._holds_lock:
            take_up_lost(self._stores, self._clock())
        if self._holds_lock and not held:
            logger.warning("another dispatcher took over")
            self._flight.clear()
        self._holds_lock = held
        return held

    def _beat(self, now: datetime) -> None:
        pause = timedelta(seconds=self._settings.heartbeat_seconds)
        if self._last_beat is None or now - self._last_beat >= pause:
            keep_alive(self._flight.work, self._stores, now, silence=timedelta(seconds=self._settings.stale_seconds))
            self._last_beat = now

    def _look_after_long_work(self, now: datetime) -> None:
        if self._last_look is None or now - self._last_look >= timedelta(seconds=LONG_WORK_PAUSE):
            look_after_calibrations(self._flight.work, self._stores, now)
            self._last_look = now

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
        self._last_beat = self._last_look = None
