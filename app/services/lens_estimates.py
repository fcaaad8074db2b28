"""The joint lens of each camera, once a run has finished its images, and the straightness of the candidates under it.

The steps that are left follow from the rows alone, each is stored in one transaction and storing one twice changes
nothing: a server that dies in between goes on where it was. A run counts as running until no step is left.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import and_, exists, select, update
from sqlalchemy.orm import Session

from app.db.models import Camera, CameraEstimate, Image, Run, RunImage, Segment, SegmentState
from app.errors import ClearLinesError
from app.services.candidates import is_current, refresh_counts, verdict_of_segment
from app.services.carrying import stored_polyline
from app.services.run_queue import UNFINISHED, unsettled_runs
from app.services.tallies import states_of_runs
from app.vision.segments import Segments

MOST_LENS_IMAGES = 200
"""Images that one estimate reads, spread evenly over the camera's: more add hours of pickling, but no accuracy."""


@dataclass(frozen=True)
class EstimateStep:
    """A camera whose lens is to be estimated from a run's images."""

    run_id: int
    camera_id: int
    width: int
    height: int


@dataclass(frozen=True)
class JudgeStep:
    """An image whose candidates are to be judged under a camera's estimate."""

    run_image_id: int
    image_id: int
    camera_estimate_id: int


def pending_estimates(session: Session, run_ids: Collection[int] | None = None) -> list[EstimateStep]:
    """Return the cameras whose images a run has finished, but whose lens it hasn't estimated.

    Args:
        session: Any session.
        run_ids: Of these runs; of all whose images are finished when left out.
    """
    runs = _joint_runs(session) if run_ids is None else run_ids
    # camera by camera, of which there are few: asked after each result, it mustn't read all of the run's images
    finished = (
        exists()
        .where(Image.camera_id == Camera.id, RunImage.image_id == Image.id)
        .where(RunImage.run_id == Run.id, RunImage.status == "done")
        .correlate(Run, Camera)
    )
    rows = session.execute(
        select(Run.id, Camera.id, Camera.width, Camera.height)
        .join(Camera, Camera.dataset_id == Run.dataset_id)
        .outerjoin(CameraEstimate, and_(CameraEstimate.run_id == Run.id, CameraEstimate.camera_id == Camera.id))
        .where(Run.id.in_(runs), CameraEstimate.id.is_(None), finished)
        .order_by(Run.id, Camera.id)
    )
    return [EstimateStep(*row) for row in rows]


def pending_judgements(session: Session, limit: int, run_ids: Collection[int] | None = None) -> list[JudgeStep]:
    """Return images with a finished detection and an estimate of their camera that they weren't judged under yet.

    Args:
        session: Any session.
        limit: At most so many.
        run_ids: Of these runs; of all whose images are finished when left out.
    """
    runs = _joint_runs(session) if run_ids is None else run_ids
    rows = session.execute(
        select(RunImage.id, RunImage.image_id, CameraEstimate.id)
        .join(Image, Image.id == RunImage.image_id)
        .join(
            CameraEstimate, and_(CameraEstimate.run_id == RunImage.run_id, CameraEstimate.camera_id == Image.camera_id)
        )
        .where(
            RunImage.run_id.in_(runs),
            RunImage.status == "done",
            RunImage.camera_estimate_id.is_(None),
            RunImage.error.is_(None),
        )
        .order_by(RunImage.id)
        .limit(limit)
    )
    return [JudgeStep(*row) for row in rows]


def lens_segments_of(session: Session, step: EstimateStep) -> list[bytes]:
    """Return the npz bytes that a camera's lens is estimated from, one entry for each image used."""
    ids = session.scalars(
        select(RunImage.id)
        .join(Image, Image.id == RunImage.image_id)
        .where(
            RunImage.run_id == step.run_id,
            RunImage.status == "done",
            RunImage.lens_segments.is_not(None),
            Image.camera_id == step.camera_id,
            Image.width == step.width,
            Image.height == step.height,
        )
        .order_by(RunImage.id)
    ).all()
    if len(ids) > MOST_LENS_IMAGES:
        ids = [ids[int(index)] for index in np.linspace(0, len(ids) - 1, MOST_LENS_IMAGES)]
    stored = session.scalars(select(RunImage.lens_segments).where(RunImage.id.in_(ids)).order_by(RunImage.id))
    return [content for content in stored if content is not None]


def candidates_to_judge(session: Session, step: JudgeStep) -> tuple[Segments, dict[str, Any]]:
    """Return a run's candidates in an image, and the distortion they are to be judged under."""
    stored = session.scalars(
        select(Segment.points).where(Segment.run_image_id == step.run_image_id).order_by(Segment.id)
    ).all()
    distortion = session.scalar(select(CameraEstimate.distortion).where(CameraEstimate.id == step.camera_estimate_id))
    return Segments.from_list([stored_polyline(points) for points in stored]), distortion or {}


def store_estimate(session: Session, step: EstimateStep, distortion: dict[str, Any], now: datetime) -> bool:
    """Store a camera's lens; False when the run has one already, is over or gone."""
    run = session.get(Run, step.run_id, with_for_update=True)
    known = select(CameraEstimate.id).where(
        CameraEstimate.run_id == step.run_id, CameraEstimate.camera_id == step.camera_id
    )
    if run is None or run.status != "running" or session.scalar(known) is not None:
        return False
    if session.get(Camera, step.camera_id) is None:
        return False
    session.add(
        CameraEstimate(
            run_id=step.run_id,
            camera_id=step.camera_id,
            distortion=distortion,
            accepted=bool(distortion["accepted"]),
            created_at=now,
        )
    )
    return True


def store_straightness(
    session: Session,
    step: JudgeStep,
    straightness: NDArray[np.float32],
    residuals: NDArray[np.float32],
    now: datetime,
) -> bool:
    """Store how straight an image's candidates are under its camera's lens.

    Where the run discards what fails, undecided candidates below 0.5 are retired in the same transaction.

    Args:
        session: A writing session.
        step: Which image, and under which estimate.
        straightness: float32 ``(S,)`` in [0, 1], in the order of ``candidates_to_judge``.
        residuals: float32 ``(S,)``, px.
        now: Time of the change.

    Returns:
        False, with nothing changed, when the image was judged already or the estimate is gone.
    """
    image = session.get(Image, step.image_id, with_for_update=True)
    row = session.get(RunImage, step.run_image_id, with_for_update=True)
    estimate = session.get(CameraEstimate, step.camera_estimate_id)
    if image is None or row is None or estimate is None or row.status != "done" or row.camera_estimate_id is not None:
        return False
    ids = session.scalars(select(Segment.id).where(Segment.run_image_id == row.id).order_by(Segment.id)).all()
    values = zip(ids, straightness.tolist(), residuals.tolist(), strict=True)
    if ids:
        session.execute(
            update(Segment), [{"id": key, "straightness": level, "residual": px} for key, level, px in values]
        )
    row.camera_estimate_id = estimate.id
    image.revision += 1
    run = session.get_one(Run, row.run_id)
    if run.parameters.get("discard"):
        _retire_failing(session, row, now)
        refresh_counts(session, [image.id])
    return True


def give_up_judging(session: Session, step: JudgeStep, error: dict[str, Any]) -> None:
    """Leave an image's candidates without straightness, with the reason; the run goes on without."""
    row = session.get(RunImage, step.run_image_id, with_for_update=True)
    if row is not None and row.status == "done" and row.camera_estimate_id is None:
        row.error = error


def finish_settled_runs(session: Session, now: datetime) -> list[int]:
    """Finish the runs that nothing is left to do for; return their ids."""
    finished: list[int] = []
    for run in unsettled_runs(session):
        joint = run.parameters.get("camera") == "joint"
        if joint and (pending_estimates(session, [run.id]) or pending_judgements(session, 1, [run.id])):
            continue
        session.refresh(run, with_for_update=True)
        counts = states_of_runs(session, [run.id])[run.id]
        if run.status not in UNFINISHED or any(counts.get(state) for state in UNFINISHED):
            continue  # cancelled, or retried, by someone else in between
        failed_alone = bool(counts.get("failed")) and not counts.get("done")
        run.status = "failed" if failed_alone else "done"
        run.error = _error_of_all(session, run, counts["failed"]) if failed_alone else None
        run.started_at = run.started_at or now
        run.finished_at = now
        finished.append(run.id)
    return finished


def _retire_failing(session: Session, row: RunImage, now: datetime) -> None:
    failing = session.scalars(
        select(Segment.id)
        .outerjoin(SegmentState, SegmentState.segment_id == Segment.id)
        .where(
            Segment.run_image_id == row.id,
            is_current(),
            verdict_of_segment() == "undecided",
            Segment.straightness < 0.5,
        )
    ).all()
    if failing:
        session.execute(update(Segment), [{"id": key, "retired_at": now} for key in failing])
    row.changes = {**(row.changes or {}), "discarded": len(failing)}


def _joint_runs(session: Session) -> list[int]:
    return [run.id for run in unsettled_runs(session) if run.parameters.get("camera") == "joint"]


def _error_of_all(session: Session, run: Run, number: int) -> dict[str, Any]:
    first = session.scalar(
        select(RunImage.error)
        .where(RunImage.run_id == run.id, RunImage.status == "failed")
        .order_by(RunImage.id)
        .limit(1)
    )
    reason = (first or {}).get("message", "unknown")
    message = f"none of its {number} images could be pre-labelled" if number > 1 else "its only image failed"
    return ClearLinesError(f"{message}: {reason}", hint="each image's reason is in the run's list").as_dict()
