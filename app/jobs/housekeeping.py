"""What the server does now and then without being asked: purge what was deleted, once its grace period is over."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from datetime import datetime, timedelta

from sqlalchemy.exc import SQLAlchemyError

from app.db.session import Database
from app.errors import ClearLinesError
from app.services.purging import purge
from app.storage import BlobStore

logger = logging.getLogger(__name__)

EVERY = timedelta(hours=1)


class Housekeeper:
    """Purges in the background: at its start, then every hour.

    Args:
        database: Where the rows are.
        blobs: Where the files are.
        grace: How long what was deleted can be restored.
        clock: Gives the time, UTC.
    """

    def __init__(
        self, database: Database, blobs: BlobStore, *, grace: timedelta, clock: Callable[[], datetime]
    ) -> None:
        self._database = database
        self._blobs = blobs
        self._grace = grace
        self._clock = clock
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._work, name="housekeeper", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """Stop, after the transaction in hand."""
        self._stopping.set()
        if self._thread.ident is not None:
            self._thread.join()

    def _work(self) -> None:
        while not self._stopping.is_set():
            try:
                purged = purge(self._database, self._blobs, self._clock(), grace=self._grace)
                if any(vars(purged).values()):
                    logger.info("purged %s", purged)
            except (SQLAlchemyError, ClearLinesError, OSError):
                logger.warning("the purge failed; it is tried again later", exc_info=True)
            self._stopping.wait(EVERY.total_seconds())
