"""How candidates were found, told on request: the detection is done over in a worker, and the latest are remembered.

The worker is another than those of the runs: nobody who looks at a candidate waits behind a thousand images, and an
image that is too large for the machine's memory takes neither the server nor a run with it.
"""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from threading import Lock

from app.errors import Unavailable
from app.jobs.executor import make_executor
from app.jobs.on_demand import OnDemandWorker
from app.jobs.tasks import ImageHistory, fingerprint, history_task
from app.services.segment_history import Found, StageHistory, tell
from app.storage import BlobStore

MOST_IMAGES = 4
"""Detections that are remembered or under way; those who look at a candidate look at its neighbours next."""
LONGEST_WAIT = 120.0
"""Seconds; what takes longer is worked on, and remembered, but not waited for."""


class Histories:
    """Tells how candidates were found. Safe to use from several threads.

    Args:
        blobs: Where the images' bytes are.
        max_pixels: Greatest number of pixels that is decoded.
        executors: Makes an executor of so many workers; called again when one broke.
        task: What runs in the worker.
    """

    def __init__(
        self,
        blobs: BlobStore,
        max_pixels: int,
        *,
        executors: Callable[[int], Executor] = make_executor,
        task: Callable[..., ImageHistory] = history_task,
    ) -> None:
        self._blobs = blobs
        self._max_pixels = max_pixels
        self._worker = OnDemandWorker(executors)
        self._task = task
        self._latest: OrderedDict[tuple[str, str], Future[ImageHistory]] = OrderedDict()
        self._lock = Lock()

    def tell(self, found: Found) -> StageHistory:
        """Tell how a candidate was found; waits for the worker if need be.

        Args:
            found: The candidate and its detection.

        Raises:
            NoHistory: When the detection doesn't give the candidate any more.
            NotFound: When the image's file is gone.
            Unavailable: When the worker was killed, has too much to do, or takes too long.
            ClearLinesError: When the detection fails.
        """
        future = self._begin(found)
        try:
            image = future.result(LONGEST_WAIT)
        except TimeoutError:
            raise Unavailable(
                "the detection takes long", where=found.image_name, hint="ask again in a minute"
            ) from None
        except (BrokenExecutor, CancelledError):
            raise Unavailable(
                "the process that looked into it was killed",
                where=found.image_name,
                hint="most often memory ran out: a large image needs some 25 bytes per pixel",
            ) from None
        return tell(found, image.by_points.get(fingerprint(found.points)), image.typical)

    def stop(self) -> None:
        """End the worker at once; whoever waits is told that it was killed."""
        with self._lock:
            self._worker.stop()
            self._latest.clear()

    def _begin(self, found: Found) -> Future[ImageHistory]:
        key = (found.sha256, json.dumps(found.parameters, sort_keys=True))
        with self._lock:
            known = self._known(key)
            if known is not None:
                return known
            self._make_room()  # who is refused reads nothing
        content = self._blobs.read(found.sha256)  # which may take long, and others ask for what is known
        with self._lock:
            known = self._known(key)
            if known is not None:
                return known
            self._make_room()
            arguments = (content, found.image_name, found.parameters)
            future = self._worker.submit(self._task, *arguments, max_pixels=self._max_pixels)
            self._latest[key] = future
            return future

    def _known(self, key: tuple[str, str]) -> Future[ImageHistory] | None:
        known = self._latest.get(key)
        if known is None or _failed(known):
            return None
        self._latest.move_to_end(key)
        return known

    def _make_room(self) -> None:
        for key, future in list(self._latest.items()):
            if _failed(future):
                del self._latest[key]
        while len(self._latest) >= MOST_IMAGES:
            oldest = next((key for key, future in self._latest.items() if future.done()), None)
            if oldest is None:
                raise Unavailable("other images are being looked into", hint="try again in a moment")
            del self._latest[oldest]


def _failed(future: Future[ImageHistory]) -> bool:
    return future.done() and (future.cancelled() or future.exception() is not None)
