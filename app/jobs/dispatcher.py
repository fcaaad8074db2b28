"""The dispatcher: a thread that takes work from the rows, sends it to workers and stores each result as it arrives.

All that it keeps in memory may be lost at any moment: work that was running goes back to the queue when the next
dispatcher takes the lock, and finished work is never done again.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, Executor
from datetime import datetime, timedelta

from app.db.locks import lock_for
from app.db.session import Database
from app.jobs.arrivals import end_hung, store_arrived
from app.jobs.calibration_work import has_calibrations, look_after_calibrations
from app.jobs.crew import Crew
from app.jobs.crew_choice import crew_of
from app.jobs.crew_status import DispatcherStatus
from app.jobs.executor import make_background_executor
from app.jobs.flight import Flight
from app.jobs.intake import take_work, work_is_left
from app.jobs.journal import Journal, OnWork
from app.jobs.limits import TaskLimits
from app.jobs.stores import Stores
from app.jobs.suggestion_intake import SuggestionIntake
from app.jobs.trouble import DATABASE_TROUBLE, reason_of
from app.jobs.upkeep import finish_runs, keep_alive, take_up_lost
from app.jobs.webhooks import Webhooks
from app.jobs.work import Tasks, Work
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
        settings: ``workers``, ``cluster``, ``max_attempts``, ``heartbeat_seconds``, ``stale_seconds``,
            ``task_seconds``, ``worker_megabytes``, ``max_image_pixels``, ``data_dir``.
        clock: Gives the time, UTC.
        executors: Makes an executor of so many workers on this machine; called again when a pool broke.
        crew: The workers; those of ``settings.cluster``, or processes on this machine, if left out.
        tasks: What runs in a worker.
        seconds: A clock that doesn't jump, in s; tells which work hangs.
        on_work: Told kind, outcome and seconds of work that has ended.
    """

    def __init__(
        self,
        database: Database,
        blobs: BlobStore,
        settings: Settings,
        clock: Callable[[], datetime],
        *,
        executors: Callable[[int], Executor] = make_background_executor,
        crew: Crew | None = None,
        tasks: Tasks | None = None,
        seconds: Callable[[], float] = time.monotonic,
        on_work: OnWork = lambda _kind, _outcome, _seconds: None,
    ) -> None:
        self._database = database
        self._crew = crew or crew_of(settings, executors)
        self._stores = Stores(
            database,
            blobs,
            settings.max_image_pixels,
            self._crew.notes,
            max_attempts=settings.max_attempts,
            submission_limits=submission_limits(settings),
            task_limits=TaskLimits(settings.scoring_seconds, settings.scoring_megabytes),
        )
        self._settings = settings
        self._clock = clock
        self._seconds = seconds
        self._tasks = tasks or Tasks()
        self._journal = Journal(on_work, seconds=seconds)
        self._signal = threading.Event()
        self._stopping = threading.Event()
        self._flight = Flight(self._crew, self._signal.set)
        self._suggestions = SuggestionIntake()
        # it ends with the process that holds it, so all work that the rows call running was left behind
        self._lock = lock_for(database, "dispatcher")
        self._holds_lock = False
        self._deserted_at: float | None = None
        self._last_beat: float | None = None
        self._last_look: float | None = None
        self._thread: threading.Thread | None = None
        self._webhooks = Webhooks(database, settings, clock, is_ours=lambda: self._holds_lock)

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

    def status(self) -> DispatcherStatus:
        """Return what it and its workers do; safe from any thread."""
        return DispatcherStatus(self._holds_lock, self._crew.status(), *self._flight.counts())

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
        self._crew.start(self._signal.set)
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
            store_arrived(self._flight, self._stores, self._journal, now, on_total=self._webhooks.wake)
            end_hung(self._flight, self._stores, self._journal, self._seconds(), self._settings.task_seconds, now)
            self._put_back_what_nobody_does()
            self._beat()
            finish_runs(self._database, now)
            take_work(self._flight, self._database, now, suggestions)
            self._send(now)

    def _acquire_lock(self) -> bool:
        held = self._lock.acquire()
        if held and not self._holds_lock:
            take_up_lost(self._stores, self._clock())
            self._suggestions = SuggestionIntake()  # another server may have worked since this one last did
            self._webhooks.wake()
        if self._holds_lock and not held:
            logger.warning("another dispatcher took over")
            self._flight.release()
            self._journal.left()
        self._holds_lock = held
        return held

    def _put_back_what_nobody_does(self) -> None:
        """Queue work again, uncharged, while no worker is to be reached: the rows then say so."""
        if self._crew.reachable and self._crew.size:
            self._deserted_at = None
            return
        self._deserted_at = self._seconds() if self._deserted_at is None else self._deserted_at
        # workers that are restarted are back soon, and what one of them died of is still known then
        patience = self._settings.stale_seconds if self._crew.reachable else 0.0
        if self._flight.work and self._seconds() - self._deserted_at >= patience:
            left = self._flight.release()
            logger.warning("no worker is to be reached: %d pieces of work wait for one", len(left))
            self._journal.left()
            self._put_back(left)

    def _put_back(self, left: Sequence[Work]) -> None:
        try:
            for work in left:
                work.put_back(self._stores)
        except DATABASE_TROUBLE as error:
            logger.warning("work that was in hand is taken up later: %s", error)

    def _beat(self) -> None:
        now, seconds = self._clock(), self._seconds()
        is_due = self._last_beat is None or seconds - self._last_beat >= self._settings.heartbeat_seconds
        if is_due or self._last_look is None or seconds - self._last_look >= LONG_WORK_PAUSE:
            look_after_calibrations(self._flight.work, self._stores, now)
            self._last_look = seconds
        if is_due:  # after the calibrations said that they live: the clock may have jumped since they last did
            keep_alive(self._flight.work, self._stores, now, silence=timedelta(seconds=self._settings.stale_seconds))
            self._last_beat = seconds

    def _send(self, now: datetime) -> None:
        while (work := self._flight.next()) is not None and not self._stopping.is_set():
            try:
                self._flight.send(work, lambda executor, work=work: work.begin(self._stores, self._tasks, executor))
                self._journal.begun(work)
            except BrokenExecutor:
                self._signal.set()
                return
            except DATABASE_TROUBLE:
                raise
            except Exception as error:
                work.fail(self._stores, reason_of(error), now)
                self._journal.ended(work, "failed", reason_of(error))
                self._flight.drop(work)

    def _leave(self) -> None:
        """Put work back and let everything go; what can't be put back now, the next dispatcher takes up."""
        left = self._flight.release()
        self._journal.left()
        self._crew.stop()
        self._put_back(left)
        self._lock.release()
        self._holds_lock = False
        self._last_beat = self._last_look = None
