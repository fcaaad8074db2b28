"""Images of a dataset."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, StringConstraints

from app.api.schemas.base import Answer, ErrorInfo, Given, ReviewState, RowId, VerdictCounts
from app.api.schemas.runs import RunBrief

Label = Annotated[str, StringConstraints(min_length=1, max_length=300, strip_whitespace=True)]
PrelabelState = Literal["none", "queued", "running", "done", "failed", "cancelled"]


class CameraName(Answer):
    """Which camera took an image."""

    id: int
    name: str


class ImageSummary(Answer):
    """An image as lists show it."""

    id: int
    name: str
    file_name: str
    width: int
    height: int
    bits: int
    camera: CameraName
    source: str | None
    sequence: str | None
    assignee: str | None = Field(description="Whose task it is.")
    status: ReviewState
    reason: str | None
    prelabel: PrelabelState
    error: ErrorInfo | None
    candidates: int
    verdicts: VerdictCounts
    created_at: datetime
    deleted_at: datetime | None


class ImagePage(Answer):
    """A page of images."""

    items: list[ImageSummary]
    next_cursor: str | None
    total: int = Field(description="Images that match, on all pages together; see ``total_exact``.")
    total_exact: bool = Field(
        description="Whether that is all; else there are more. By status, pre-labelling, source, sequence, camera and"
        " assignee it always is, and by what has to be looked up image by image up to 1,000."
    )


class DatasetName(Answer):
    """Which dataset."""

    slug: str
    name: str


class ImageDetail(ImageSummary):
    """An image with its neighbours in the dataset and the lens it was seen through."""

    dataset: DatasetName
    previous_id: int | None
    next_id: int | None
    next_open_id: int | None = Field(
        description="The next one to review: open, not another person's task, and no other person has it open."
    )
    position: int
    total: int
    camera_estimate: dict[str, Any] | None
    run: RunBrief | None
    changes: dict[str, Any] | None


class ImageChange(Given):
    """What to change about one image."""

    model_config = ConfigDict(json_schema_extra={"example": {"name": "KITTI/000001", "sequence": "drive 00"}})

    name: Annotated[str, StringConstraints(min_length=1, max_length=500, strip_whitespace=True)] | None = None
    camera: Label | None = None
    source: Label | None = None
    sequence: Label | None = None


class ImagesChange(Given):
    """What to change about many images at once; ``null`` clears source and sequence."""

    model_config = ConfigDict(json_schema_extra={"example": {"ids": [1, 2, 3], "camera": "front left"}})

    ids: list[RowId] = Field(min_length=1, max_length=100_000)
    camera: Label | None = None
    source: Label | None = None
    sequence: Label | None = None


class ImageIds(Given):
    """Which images."""

    model_config = ConfigDict(json_schema_extra={"example": {"ids": [1, 2, 3]}})

    ids: list[RowId] = Field(min_length=1, max_length=100_000)


class Updated(Answer):
    """How many were changed."""

    updated: int


class ExistingImage(Answer):
    """An uploaded file whose content is in the dataset already."""

    name: str
    image_id: int


class FailedFile(Answer):
    """An uploaded file that wasn't taken."""

    name: str
    error: ErrorInfo


class UploadReport(Answer):
    """What became of each uploaded file."""

    added: list[ImageSummary]
    existing: list[ExistingImage]
    failed: list[FailedFile]
    labels: int = Field(0, description="Label files that came with the images.")


class Facet(Answer):
    """A value that occurs among the images, and how often."""

    value: str | None
    count: int


class CameraFacet(Answer):
    """A camera and the number of its images."""

    id: int
    name: str
    count: int


class Facets(Answer):
    """What images can be filtered by."""

    sources: list[Facet]
    sequences: list[Facet]
    assignees: list[Facet]
    cameras: list[CameraFacet]
    status: dict[str, int]
    prelabel: dict[str, int]


class CameraAnswer(Answer):
    """The images that share one lens."""

    id: int
    name: str
    width: int
    height: int
    images: int
    reference: dict[str, Any] | None
    estimate: dict[str, Any] | None


class ReferenceDistortion(Given):
    """A calibration that is known from elsewhere, in OpenCV's convention."""

    K: list[list[float]] = Field(min_length=3, max_length=3)
    D: list[float] = Field(min_length=4, max_length=14)


class CameraChange(Given):
    """What to change about a camera; ``reference: null`` clears it."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "name": "front left",
                "reference": {
                    "K": [[980.0, 0.0, 640.0], [0.0, 980.0, 360.0], [0.0, 0.0, 1.0]],
                    "D": [-0.37, 0.2, 0.001, 0.001, -0.07],
                },
            }
        }
    )

    name: Label | None = None
    reference: ReferenceDistortion | None = None
