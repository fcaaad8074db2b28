"""Whether the server can do what it is there for: asked by proxies and container engines, every few seconds."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

import anyio
from anyio import CapacityLimiter
from anyio.to_thread import run_sync
from sqlalchemy import text

from app.db.migrations import revisions, stored_revision
from app.db.session import Database
from app.errors import ClearLinesError, Unavailable
from app.storage import BlobStore

SECONDS = 4.0
"""For all checks together."""
GOOD_FOR = 1.0
"""Seconds for which an answer is given again: whoever asks without pause asks database and blob store no oftener."""


@dataclass
class Readiness:
    """Asks the database and the blob store whether they answer.

    Attributes:
        expected: The form of the tables that this server works with.
        seconds: For all checks together.
        clock: Seconds, of a clock that doesn't jump.
    """

    database: Database
    blobs: BlobStore
    expected: str = field(default_factory=lambda: revisions()[-1])
    seconds: float = SECONDS
    clock: Callable[[], float] = time.monotonic
    _asked_at: float = field(default=float("-inf"), init=False)
    _problem: Unavailable | None = field(default=None, init=False)
    _lock: anyio.Lock = field(default_factory=anyio.Lock, init=False)
    # threads of its own: those that hang with a database must not be those that answer requests
    _threads: CapacityLimiter | None = field(default=None, init=False)

    async def require(self) -> None:
        """Return when all is well.

        Raises:
            Unavailable: Else, with what is wrong.
        """
        async with self._lock:
            if self.clock() - self._asked_at >= GOOD_FOR:
                self._problem = await self._asked()
                self._asked_at = self.clock()
        if self._problem is not None:
            raise self._problem.with_traceback(None)

    async def _asked(self) -> Unavailable | None:
        self._threads = self._threads or CapacityLimiter(4)
        asked = "the database"
        try:
            with anyio.fail_after(self.seconds):
                await run_sync(self._check_database, abandon_on_cancel=True, limiter=self._threads)
                asked = "the blob store"
                await run_sync(self.blobs.check, abandon_on_cancel=True, limiter=self._threads)
        except TimeoutError:
            return Unavailable(f"{asked} didn't answer", expected=f"an answer within {self.seconds:g} s")
        except Unavailable as error:
            return error
        except ClearLinesError as error:
            return Unavailable(error.message, where=error.where, expected=error.expected, hint=error.hint)
        return None

    def _check_database(self) -> None:
        with self.database.read() as session:
            session.execute(text("SELECT 1"))
            found = stored_revision(session.connection())
        if found != self.expected:
            raise Unavailable(
                "the tables have another form than this version of ClearLines works with",
                where=f"revision {found}",
                expected=f"revision {self.expected}",
                hint="restart this server; if another version made the tables, run that one",
            )
