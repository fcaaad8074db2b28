"""Tell whoever asked for it that a submission is scored; whatever happens on the way, the score stays as it is."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from datetime import datetime, timedelta

from sqlalchemy.exc import SQLAlchemyError

from app.db.session import Database
from app.errors import ClearLinesError
from app.services.webhook_deliveries import FAILED, Delivery, deliveries_due, record_delivery
from app.services.webhook_sending import send_webhook
from app.settings import Settings

logger = logging.getLogger(__name__)

TRIES = 3
PAUSE = 2.0  # s before the second try, twice that before the third
IDLE = 60.0  # s
LATEST = timedelta(days=1)
"""What nobody could be told within a day isn't told any more."""


class Webhooks:
    """Sends webhooks in the background. The rows say which are due, so that a server that was killed goes on.

    Args:
        database: Where the rows are.
        settings: ``webhook_seconds``, ``webhook_private_addresses``.
        clock: Gives the time, UTC.
        is_ours: Whether it is this process that sends them: of several servers one does.
        pause: Seconds before the second try.
    """

    def __init__(
        self,
        database: Database,
        settings: Settings,
        clock: Callable[[], datetime],
        *,
        is_ours: Callable[[], bool] = lambda: True,
        pause: float = PAUSE,
    ) -> None:
        self._database = database
        self._settings = settings
        self._clock = clock
        self._is_ours = is_ours
        self._pause = pause
        self._signal = threading.Event()
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin; what an earlier server left unsent is sent."""
        if self._thread is None:
            self._stopping.clear()
            self._thread = threading.Thread(target=self._work, name="webhooks", daemon=True)
            self._thread.start()

    def wake(self) -> None:
        """Say that one may be due."""
        self._signal.set()

    def stop(self) -> None:
        """Stop, after the request in hand."""
        self._stopping.set()
        self._signal.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    def send_due(self) -> int:
        """Send what is due now, and return how many that were."""
        now = self._clock()
        with self._database.read() as session:
            due = deliveries_due(session, since=now - LATEST)
        for delivery in due:
            if self._stopping.is_set():
                break
            outcome = self._deliver(delivery)
            with self._database.write() as session:
                record_delivery(session, delivery, outcome, self._clock())
        return len(due)

    def _work(self) -> None:
        while not self._stopping.is_set():
            self._signal.clear()
            try:
                if self._is_ours():
                    self.send_due()
            except (SQLAlchemyError, ClearLinesError):
                logger.warning("webhooks wait for the database", exc_info=True)
            self._signal.wait(IDLE)

    def _deliver(self, delivery: Delivery) -> str:
        """Try a few times; return what came of it, in words for the log of the submission."""
        outcome = ""
        for attempt in range(TRIES):
            if attempt and self._stopping.wait(self._pause * 2 ** (attempt - 1)):
                break
            try:
                status = send_webhook(
                    delivery.url,
                    delivery.content,
                    seconds=self._settings.webhook_seconds,
                    allow_private=self._settings.webhook_private_addresses,
                )
            except ClearLinesError as error:
                outcome = f"{FAILED}{error.message}"
                if error.status < 500:  # a second try would be refused as the first was
                    return outcome
                continue
            if 200 <= status < 300:
                return f"webhook sent, answered with {status}"
            outcome = f"{FAILED}answered with {status}"
        return outcome
