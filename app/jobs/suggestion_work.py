"""The work for suggestions: features of an image's candidates, and a model of a dataset's decisions.

Nobody waits for either, so the dispatcher begins them when there is nothing else to do, one at a time.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Hashable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from app.jobs.on_demand import OnDemandWorker
from app.jobs.stores import Stores
from app.jobs.suggestion_learning import Trained
from app.jobs.suggestion_tasks import CandidateFacts
from app.review.features import FEATURES
from app.services.suggestion_examples import training_examples
from app.services.suggestion_features import FeatureInputs, KnownFeatures, store_features
from app.services.suggestion_training import TrainingDue, fail_training, store_model

if TYPE_CHECKING:
    from app.jobs.work import Tasks, Work

logger = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class FeaturesWork:
    """Describe an image's candidates."""

    inputs: FeatureInputs
    attempts: int = 1

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("features", self.inputs.image_id)

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        content = stores.blobs.read(self.inputs.sha256)
        return begin_features(executor, tasks.features, self.inputs, content, stores.max_pixels)

    def store(self, stores: Stores, result: CandidateFacts, now: datetime) -> None:
        """See ``Work``."""
        known = KnownFeatures(self.inputs.segment_ids, result.features, result.families, result.lens_information)
        with stores.database.write() as session:
            store_features(session, self.inputs, known, now)

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """Store that nothing is known, so that it isn't tried again before the candidates change."""
        logger.warning("the candidates of %s can't be described: %s", self.inputs.image_name, error["message"])
        count = len(self.inputs.segment_ids)
        unknown = np.full((count, len(FEATURES)), np.nan, np.float32)
        self.store(stores, CandidateFacts(unknown, np.full(count, -1, np.int64), np.zeros(count)), now)

    def again(self, stores: Stores, now: datetime) -> Work | None:
        """See ``Work``."""
        del stores, now
        return replace(self, attempts=self.attempts + 1)

    def put_back(self, stores: Stores) -> None:
        """Nothing to do: the rows say that it is still to be done."""


@dataclass(frozen=True)
class TrainWork:
    """Learn from a dataset's decisions."""

    due: TrainingDue
    attempts: int = 1

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("train", self.due.dataset_id)

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        with stores.database.read() as session:
            examples = training_examples(session, self.due.dataset_id)
        return executor.submit(tasks.train, examples.features, examples.kept, examples.image_index)

    def store(self, stores: Stores, result: Trained, now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            store_model(session, self.due, result.version, result.parameters, result.report, now)

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """See ``Work``."""
        del now
        with stores.database.write() as session:
            fail_training(session, self.due, error)

    def again(self, stores: Stores, now: datetime) -> Work | None:
        """See ``Work``."""
        del stores, now
        return replace(self, attempts=self.attempts + 1)

    def put_back(self, stores: Stores) -> None:
        """Nothing to do: the rows say that it is still to be done."""


def begin_features(
    executor: Executor | OnDemandWorker,
    task: Callable[..., CandidateFacts],
    inputs: FeatureInputs,
    content: bytes,
    max_pixels: int,
) -> Future[CandidateFacts]:
    """Have a worker describe an image's candidates.

    Args:
        executor: Where the worker is.
        task: ``features_task``.
        inputs: The candidates and what is known of them.
        content: The image file.
        max_pixels: Greatest number of pixels that is decoded.
    """
    return executor.submit(
        task,
        content,
        inputs.image_name,
        inputs.segments,
        inputs.size,
        residuals=inputs.residuals,
        straightness=inputs.straightness,
        distortion=inputs.distortion,
        before=inputs.before,
        after=inputs.after,
        max_pixels=max_pixels,
    )
