"""The three kinds of work of a submission: its upload is validated, its images are scored, their scores added up.

As with the work of runs, a result is stored in one transaction, and storing it again, or after the submission was
withdrawn, changes nothing.
"""

from __future__ import annotations

from collections.abc import Hashable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any

from app.errors import NotFound
from app.evaluation.submission_scoring import ImageRecord
from app.jobs.scoring_tasks import Validated
from app.jobs.stores import Stores
from app.jobs.work import Tasks, Work
from app.services.blobs import add_blob_row
from app.services.score_storing import store_images, store_totals
from app.services.scoring_attempts import charge_submission, put_submission_back
from app.services.scoring_claims import PartClaim, TotalsClaim, ValidationClaim
from app.services.scoring_inputs import images_to_score, recorded_images
from app.services.split_images import expected_images
from app.services.submission_states import ValidContent, accept, fail_or_retry, refuse
from app.services.truths import MEDIA_TYPE


@dataclass(frozen=True)
class SubmissionWork(Work):
    """What the three kinds have in common: they are charged to the submission and go back to its queue."""

    claim: ValidationClaim | PartClaim | TotalsClaim

    @property
    def attempts(self) -> int:
        """See ``Work``."""
        return self.claim.claim.attempts

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            fail_or_retry(session, self.claim.claim, error, now, max_attempts=stores.max_attempts)

    def again(self, stores: Stores, now: datetime) -> Work | None:
        """See ``Work``."""
        with stores.database.write() as session:
            claim = charge_submission(session, self.claim.claim, now)
        return None if claim is None else replace(self, claim=replace(self.claim, claim=claim))

    def put_back(self, stores: Stores) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            put_submission_back(session, self.claim.claim)


@dataclass(frozen=True)
class ValidateWork(SubmissionWork):
    """Read an upload and check everything in it."""

    claim: ValidationClaim

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("validate", self.claim.claim.submission_id)

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        with stores.database.read() as session:
            images = expected_images(session, self.claim.split_version_id)
        return executor.submit(
            tasks.validate,
            stores.blobs.read(self.claim.upload_sha256),
            self.claim.upload_name,
            images,
            stores.submission_limits,
            stores.task_limits,
        )

    def store(self, stores: Stores, result: Validated, now: datetime) -> None:
        """See ``Work``."""
        sha256 = stores.blobs.put(result.content)
        found = ValidContent(
            sha256,
            result.submission_hash,
            result.images,
            result.segments,
            result.points,
            result.has_scores,
            result.missing,
            result.warnings,
        )
        with stores.database.write() as session:
            add_blob_row(session, sha256, len(result.content), MEDIA_TYPE, now)
            accept(session, self.claim.claim, found, now)

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            refuse(session, self.claim.claim, error, now)


@dataclass(frozen=True)
class ScoreWork(SubmissionWork):
    """Score some images of a submission."""

    claim: PartClaim

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("score", self.claim.score_id, self.claim.images)

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        truth, segments = stores.sets.read(self.claim.truth_sha256), stores.sets.read(self.claim.segments_sha256)
        with stores.database.read() as session:
            images = images_to_score(session, self.claim.images, truth, segments, self.claim.min_length)
        return executor.submit(tasks.score, images, self.claim.min_length, stores.task_limits)

    def store(self, stores: Stores, result: list[ImageRecord], now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            store_images(session, self.claim.score_id, dict(zip(self.claim.images, result, strict=True)), now)


@dataclass(frozen=True)
class TotalWork(SubmissionWork):
    """Add up the images of a submission, with intervals."""

    claim: TotalsClaim

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("total", self.claim.score_id)

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        truth, segments = stores.sets.read(self.claim.truth_sha256), stores.sets.read(self.claim.segments_sha256)
        with stores.database.read() as session:
            ids, records = recorded_images(session, self.claim.score_id)
            images = images_to_score(session, ids, truth, segments, self.claim.min_length)
        if not images:
            raise NotFound("none of the images is scored")
        return executor.submit(tasks.total, images, records, stores.task_limits)

    def store(self, stores: Stores, result: dict[str, Any], now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            store_totals(session, self.claim.score_id, result, now)
