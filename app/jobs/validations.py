"""Check an upload without storing anything, in a worker of its own: nobody waits behind a run, nor holds one up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from threading import BoundedSemaphore, Lock

from app.errors import Unavailable
from app.formats.submission_files import ExpectedImage
from app.formats.submission_limits import SubmissionLimits
from app.jobs.executor import end_executor, make_executor
from app.jobs.limits import TaskLimits
from app.jobs.scoring_tasks import Validated, validate_task

MOST_WAITING = 4


class Validations:
    """Validates uploads. Safe to use from several threads.

    Args:
        limits: How much an upload may hold.
        task: How long one may take, with how much memory.
        seconds: How long a caller waits.
        executors: Makes an executor of so many workers; called again when one broke.
    """

    def __init__(
        self,
        limits: SubmissionLimits,
        task: TaskLimits,
        seconds: float,
        *,
        executors: Callable[[int], Executor] = make_executor,
    ) -> None:
        self._limits = limits
        self._task = task
        self._seconds = seconds
        self._executors = executors
        self._executor: Executor | None = None
        self._lock = Lock()
        self._room = BoundedSemaphore(MOST_WAITING)

    def validate(self, upload: bytes, name: str, images: Sequence[ExpectedImage]) -> Validated:
        """Read an upload and check everything in it.

        Raises:
            InvalidSubmission: With everything that is wrong.
            Unavailable: When too many wait, the worker was killed, or it takes too long.
        """
        if not self._room.acquire(blocking=False):
            raise Unavailable("other uploads are being checked", hint="try again in a moment")
        try:
            future = self._submit(upload, name, images)
            try:
                return future.result(self._seconds)
            except TimeoutError:
                future.cancel()  # what hasn't begun would be read for nobody, and keep its bytes until then
                hint = "hand it in: then it is checked in its turn"
                raise Unavailable("the check takes long", where=name, hint=hint) from None
        except (BrokenExecutor, CancelledError):
            self._end()
            hint = "is it far too large?"
            raise Unavailable("the process that checked it was killed", where=name, hint=hint) from None
        finally:
            self._room.release()

    def stop(self) -> None:
        """End the worker at once; whoever waits is told that it was killed."""
        self._end()

    def _submit(self, upload: bytes, name: str, images: Sequence[ExpectedImage]) -> Future[Validated]:
        arguments = (validate_task, upload, name, images, self._limits, self._task)
        with self._lock:
            self._executor = self._executor or self._executors(1)
            try:
                return self._executor.submit(*arguments)
            except BrokenExecutor:  # it died while it had nothing to do
                end_executor(self._executor)
                self._executor = self._executors(1)
                return self._executor.submit(*arguments)

    def _end(self) -> None:
        with self._lock:
            if self._executor is not None:
                end_executor(self._executor)
                self._executor = None
