"""Pre-labelling runs."""

from __future__ import annotations

from datetime import datetime
from typing import Any, Literal

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, ErrorInfo, Given, RowId, WorkState


class RunGiven(Given):
    """Parameters of a run; what is left out takes the pipeline's default."""

    model_config = ConfigDict(
        json_schema_extra={"example": {"min_length": 100, "operating_point": "balanced", "camera": "joint"}}
    )

    min_length: float | None = Field(None, ge=1, le=10_000, description="Shortest candidate, px from end to end.")
    operating_point: Literal["recall", "balanced", "precise"] | None = None
    camera: Literal["joint", "per-image"] = Field("joint", description="Whether images of a camera share one lens.")
    discard: bool = Field(False, description="Drop candidates that fail straightness, as the paper does.")
    image_ids: list[RowId] | None = Field(
        None, min_length=1, max_length=100_000, description="Only these images; all of them by default."
    )


class WorkCounts(Answer):
    """Images of a run by state."""

    queued: int = 0
    running: int = 0
    done: int = 0
    failed: int = 0
    cancelled: int = 0


class RunChanges(Answer):
    """What a run changed for decisions made before it."""

    carried: int = Field(0, description="Verdicts that went over to a matching new candidate.")
    kept_unmatched: int = Field(0, description="Kept or ambiguous segments without a match; they stay.")
    already_there: int = Field(0, description="Candidates that an imported or hand-drawn segment covers already.")
    retired: int = Field(0, description="Older candidates that the new ones replaced.")
    discarded: int = Field(
        0, description="Candidates that failed straightness and were dropped, if the run was told so."
    )
    reopened: int = Field(0, description="Images that were done and have new candidates.")


class RunBrief(Answer):
    """A run at a glance."""

    id: int
    status: WorkState
    counts: WorkCounts
    total: int
    created_at: datetime
    finished_at: datetime | None


class CameraResult(Answer):
    """A camera's distortion as the run estimated it."""

    id: int
    name: str
    distortion: dict[str, Any] | None


class RunAnswer(RunBrief):
    """One run of the pipeline over images."""

    parameters: dict[str, Any]
    code_version: str
    error: ErrorInfo | None
    started_at: datetime | None
    deleted_at: datetime | None
    restorable_until: datetime | None = None
    candidates: int
    changes: RunChanges
    seconds_left: float | None = Field(None, description="An estimate from the images done so far.")
    cameras: list[CameraResult]


class ImageName(Answer):
    """Which image."""

    id: int
    name: str


class RunImageAnswer(Answer):
    """The work of a run on one image."""

    image: ImageName
    status: WorkState
    attempts: int
    error: ErrorInfo | None
    milliseconds: float | None
    changes: dict[str, Any] | None


class RunImagePage(Answer):
    """A page of a run's images."""

    items: list[RunImageAnswer]
    next_cursor: str | None
    total: int


class Retried(Answer):
    """How many images were queued again."""

    queued: int
