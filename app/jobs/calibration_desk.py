"""What somebody waits for of a finished calibration: pictures, exports, the report; by a worker of its own.

The latest answers are remembered: a calibration never changes, so neither do they.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from concurrent.futures import BrokenExecutor, CancelledError, Executor
from threading import BoundedSemaphore, Lock
from typing import Any, TypeVar, cast

from app.errors import Unavailable
from app.jobs.executor import make_executor
from app.jobs.on_demand import OnDemandWorker

LONGEST_WAIT = 60.0
"""Seconds; what takes longer isn't waited for."""
MOST_WAITING = 8
"""Who wait at once; each of them keeps a thread of the server's and perhaps a copy of an image's file."""
MOST_BYTES = 64 * 2**20
"""Of the answers that are remembered."""
SMALL = 64 * 2**10
"""Bytes that an answer counts for which isn't bytes itself."""

Result = TypeVar("Result")


class CalibrationDesk:
    """Answers by a worker, and remembers. Safe to use from several threads.

    Args:
        executors: Makes an executor of so many workers; called again when one broke.
    """

    def __init__(self, *, executors: Callable[[int], Executor] = make_executor) -> None:
        self._worker = OnDemandWorker(executors)
        self._room = BoundedSemaphore(MOST_WAITING)
        self._known: OrderedDict[Hashable, Any] = OrderedDict()
        self._lock = Lock()

    def answer(
        self, key: Hashable, where: str, task: Callable[..., Result], arguments: Callable[[], tuple[object, ...]]
    ) -> Result:
        """Return what a task gives; waits for the worker where it isn't remembered.

        Args:
            key: Equal for equal answers.
            where: What it is about, for messages.
            task: A module-level function.
            arguments: Gives its arguments; asked only when there is room, since they may be large files.

        Raises:
            Unavailable: When too many wait, the worker was killed, or it takes too long.
            ClearLinesError: When the task fails, or what it needs is gone.
        """
        with self._lock:
            if key in self._known:
                self._known.move_to_end(key)
                return cast(Result, self._known[key])
        if not self._room.acquire(blocking=False):
            raise Unavailable("others are being answered", where=where, hint="try again in a moment")
        try:
            found = self._computed(where, task, arguments())
        finally:
            self._room.release()
        self._remember(key, found)
        return found

    def stop(self) -> None:
        """End the worker at once; whoever waits is told that it was killed."""
        self._worker.stop()

    def _computed(self, where: str, task: Callable[..., Result], arguments: tuple[object, ...]) -> Result:
        future = self._worker.submit(task, *arguments)
        try:
            return future.result(LONGEST_WAIT)
        except TimeoutError:
            future.cancel()  # what hasn't begun would be made for nobody
            raise Unavailable("it takes long", where=where, hint="try again in a minute") from None
        except (BrokenExecutor, CancelledError):
            hint = "most often memory ran out: a large image needs some 25 bytes per pixel"
            raise Unavailable("the process that worked on it was killed", where=where, hint=hint) from None

    def _remember(self, key: Hashable, found: object) -> None:
        with self._lock:
            self._known[key] = found
            while len(self._known) > 1 and sum(map(_size, self._known.values())) > MOST_BYTES:
                self._known.popitem(last=False)


def _size(found: object) -> int:
    return len(found) if isinstance(found, bytes) else SMALL
