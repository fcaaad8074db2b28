"""The three kinds of work of a run: what each sends to a worker, and how its result is stored.

A result is stored in one transaction. Storing it again, or after someone cancelled the run, changes nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any, Protocol

from app.calibration.work_order import CalibrationFound
from app.db.models import Image
from app.evaluation.submission_scoring import ImageRecord
from app.jobs.calibration_tasks import calibrate_task
from app.jobs.scoring_tasks import Validated, score_task, total_task, validate_task
from app.jobs.stores import Stores
from app.jobs.suggestion_learning import Trained, train_task
from app.jobs.suggestion_tasks import CandidateFacts, features_task
from app.jobs.tasks import DetectionResult, Judgement, detect_task, estimate_task, judge_task
from app.services.carrying import match_to_current
from app.services.detections import FoundCandidates, store_detection
from app.services.lens_estimates import (
    EstimateStep,
    JudgeStep,
    candidates_to_judge,
    give_up_judging,
    lens_segments_of,
    store_estimate,
    store_straightness,
)
from app.services.run_parameters import RunParameters
from app.services.run_queue import Claim, charge_attempt, fail_image, put_back
from app.vision.distortion import estimate_distortion


@dataclass(frozen=True)
class Tasks:
    """The functions that run in a worker; module-level, so that they can be named across a process border."""

    detect: Callable[..., DetectionResult] = detect_task
    estimate: Callable[..., dict[str, Any]] = estimate_task
    judge: Callable[..., Judgement] = judge_task
    validate: Callable[..., Validated] = validate_task
    score: Callable[..., list[ImageRecord]] = score_task
    total: Callable[..., dict[str, Any]] = total_task
    features: Callable[..., CandidateFacts] = features_task
    train: Callable[..., Trained] = train_task
    calibrate: Callable[..., CalibrationFound] = calibrate_task


class Work(Protocol):
    """Something to do in a worker."""

    @property
    def key(self) -> Hashable:
        """Equal for equal work."""
        ...

    @property
    def attempts(self) -> int:
        """How often it was begun, this time included."""
        ...

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """Send it to a worker."""
        ...

    def store(self, stores: Stores, result: Any, now: datetime) -> None:
        """Store what the worker gave."""
        ...

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """Store why it can't be done."""
        ...

    def again(self, stores: Stores, now: datetime) -> Work | None:
        """Return the same work at its next attempt; ``None`` when nobody wants it any more."""
        ...

    def put_back(self, stores: Stores) -> None:
        """Leave it for another time, as if it hadn't been begun."""
        ...


@dataclass(frozen=True)
class DetectWork:
    """Detect one image's candidates."""

    claim: Claim

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("detect", self.claim.run_image_id)

    @property
    def attempts(self) -> int:
        """See ``Work``."""
        return self.claim.attempts

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        parameters = RunParameters.from_dict(self.claim.parameters)
        return executor.submit(
            tasks.detect,
            stores.blobs.read(self.claim.sha256),
            self.claim.image_name,
            parameters.detection.as_dict(),
            alone=parameters.camera == "per-image",
            discard=parameters.discard,
            max_pixels=stores.max_pixels,
        )

    def store(self, stores: Stores, result: DetectionResult, now: datetime) -> None:
        """See ``Work``."""
        judged = result.judgement
        found = FoundCandidates(
            result.candidates,
            result.lens_segments,
            result.milliseconds,
            None if judged is None else judged.straightness,
            None if judged is None else judged.residuals,
            result.distortion,
        )
        with stores.database.read() as session:
            image = session.get(Image, self.claim.image_id)
            matching = None if image is None else match_to_current(session, image, found.segments)
        with stores.database.write() as session:
            store_detection(session, self.claim, found, now, matching=matching)

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            fail_image(session, self.claim, error, now)

    def again(self, stores: Stores, now: datetime) -> Work | None:
        """See ``Work``."""
        with stores.database.write() as session:
            claim = charge_attempt(session, self.claim, now)
        return None if claim is None else DetectWork(claim)

    def put_back(self, stores: Stores) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            put_back(session, [self.claim])


@dataclass(frozen=True)
class EstimateWork:
    """Estimate the lens that a camera's images share."""

    step: EstimateStep
    attempts: int = 1

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("estimate", self.step.run_id, self.step.camera_id)

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        with stores.database.read() as session:
            segments = lens_segments_of(session, self.step)
        return executor.submit(tasks.estimate, segments, (self.step.width, self.step.height))

    def store(self, stores: Stores, result: dict[str, Any], now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            store_estimate(session, self.step, result, now)

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """Store a refused estimate with the reason, so that the run can end."""
        refused = estimate_distortion([], (self.step.width, self.step.height)).as_dict()
        self.store(stores, {**refused, "reasons": [error["message"]]}, now)

    def again(self, stores: Stores, now: datetime) -> Work | None:
        """See ``Work``."""
        del stores, now
        return replace(self, attempts=self.attempts + 1)

    def put_back(self, stores: Stores) -> None:
        """Nothing to do: the rows say that it is still to be done."""


@dataclass(frozen=True)
class JudgeWork:
    """Judge the straightness of an image's candidates under its camera's lens."""

    step: JudgeStep
    attempts: int = 1

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("judge", self.step.run_image_id)

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        with stores.database.read() as session:
            candidates, distortion = candidates_to_judge(session, self.step)
        return executor.submit(tasks.judge, candidates, distortion)

    def store(self, stores: Stores, result: Judgement, now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            store_straightness(session, self.step, result.straightness, result.residuals, now)

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """See ``Work``."""
        del now
        with stores.database.write() as session:
            give_up_judging(session, self.step, error)

    def again(self, stores: Stores, now: datetime) -> Work | None:
        """See ``Work``."""
        del stores, now
        return replace(self, attempts=self.attempts + 1)

    def put_back(self, stores: Stores) -> None:
        """Nothing to do: the rows say that it is still to be done."""
