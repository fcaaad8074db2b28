"""Features of an image that somebody looks at right now, by a worker beside those of the runs.

Mostly they are stored already, as the dispatcher computes those of all images when it has nothing else to do.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from datetime import datetime
from threading import Lock

from app.db.session import Database
from app.errors import Unavailable
from app.jobs.executor import make_executor
from app.jobs.on_demand import OnDemandWorker
from app.jobs.suggestion_tasks import CandidateFacts, features_task
from app.jobs.suggestion_work import begin_features
from app.services.images import get_image
from app.services.suggestion_features import (
    FeatureInputs,
    KnownFeatures,
    feature_inputs,
    known_features,
    store_features,
)
from app.storage import BlobStore

LONGEST_WAIT = 30.0
"""Seconds; what takes longer isn't waited for."""
MOST_AT_ONCE = 8
"""Images under way; who asks for more is told to come again."""

Key = tuple[int, int, str]


class FeatureDesk:
    """Gives the features of an image's candidates. Safe to use from several threads.

    Args:
        database: Where they are stored.
        blobs: Where the images' bytes are.
        max_pixels: Greatest number of pixels that is decoded.
        clock: Gives the time, UTC.
        executors: Makes an executor of so many workers; called again when one broke.
        task: What runs in the worker.
    """

    def __init__(
        self,
        database: Database,
        blobs: BlobStore,
        max_pixels: int,
        clock: Callable[[], datetime],
        *,
        executors: Callable[[int], Executor] = make_executor,
        task: Callable[..., CandidateFacts] = features_task,
    ) -> None:
        self._database = database
        self._blobs = blobs
        self._max_pixels = max_pixels
        self._clock = clock
        self._worker = OnDemandWorker(executors)
        self._task = task
        self._under_way: dict[Key, Future[CandidateFacts]] = {}
        self._lock = Lock()

    def features_of(self, image_id: int) -> KnownFeatures:
        """Return the features of an image's candidates; waits for the worker where they aren't stored.

        Raises:
            NotFound: When there is no such image, it is deleted, or its file is gone.
            Unavailable: When the worker was killed, has too much to do, or takes too long.
            ClearLinesError: When it fails.
        """
        with self._database.read() as session:
            known = known_features(session, get_image(session, image_id))
            if known is not None:
                return known
            inputs = feature_inputs(session, image_id)
        return self._computed(inputs)

    def stop(self) -> None:
        """End the worker at once; whoever waits is told that it was killed."""
        self._worker.stop()

    def _computed(self, inputs: FeatureInputs) -> KnownFeatures:
        key = (inputs.image_id, inputs.revision, inputs.version)
        future = self._begun(key, inputs)
        try:
            facts = future.result(LONGEST_WAIT)
        except TimeoutError:
            raise Unavailable("it takes long", where=inputs.image_name, hint="ask again in a minute") from None
        except (BrokenExecutor, CancelledError):
            raise Unavailable(
                "the process that looked at the candidates was killed",
                where=inputs.image_name,
                hint="most often memory ran out",
            ) from None
        known = KnownFeatures(inputs.segment_ids, facts.features, facts.families, facts.lens_information)
        with self._database.write() as session:
            store_features(session, inputs, known, self._clock())
        return known

    def _begun(self, key: Key, inputs: FeatureInputs) -> Future[CandidateFacts]:
        with self._lock:
            future = self._under_way.get(key)
        if future is not None:
            return future
        content = self._blobs.read(inputs.sha256)  # which may take long, and others ask for other images
        with self._lock:
            future = self._under_way.get(key)
            if future is None:
                if len(self._under_way) >= MOST_AT_ONCE:
                    raise Unavailable("other images are being looked at", hint="try again in a moment")
                future = begin_features(self._worker, self._task, inputs, content, self._max_pixels)
                self._under_way[key] = future
        future.add_done_callback(lambda _: self._forget(key))
        return future

    def _forget(self, key: Key) -> None:
        with self._lock:
            self._under_way.pop(key, None)
