"""Calibrations of cameras: what asks for one, how far it is, its lines, images and advice."""

from __future__ import annotations

from datetime import datetime
from typing import Literal

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, ErrorInfo, Given, WorkState
from app.api.schemas.calibration_results import CalibrationResult
from app.api.schemas.images import CameraAnswer, DatasetName

CalibrationSource = Literal["labels", "candidates"]
LensFamily = Literal["brown", "opencv", "division"]


class CalibrationGiven(Given):
    """What a camera's lens is to be estimated from."""

    model_config = ConfigDict(json_schema_extra={"example": {"source": "labels", "family": None}})

    source: CalibrationSource = Field(
        "labels",
        description="Lines that people kept; or all candidates but rejected ones, by how straight they are.",
    )
    family: LensFamily | None = Field(None, description="The lens model; the one that fits best if left out.")


class CalibrationProgress(Answer):
    """How far the work is."""

    stage: str
    done: int
    total: int


class CalibrationScope(Answer):
    """What a calibration read, of what there was."""

    segments: int = Field(0, description="Lines read.")
    images_available: int = Field(0, description="Images of the camera that had lines.")
    segments_available: int = Field(0, description="Their lines.")
    most_images: int = Field(0, description="More images than these aren't read, but some spread evenly over all.")
    most_segments: int = Field(0, description="Of more lines than these, the shorter ones of each image are left out.")


class CalibrationSummary(Answer):
    """What lists show of a result; lengths in px."""

    accepted: bool
    family: LensFamily
    released: list[str] = Field(description="Parameters that were estimated.")
    reasons: list[str] = Field(description="Why it isn't accepted.")
    warnings: list[str] = Field(description="Codes of what makes the lines tell less than their number suggests.")
    pred: float = Field(description="Expected error over the frame, RMS.")
    bound95: float = Field(description="The error lies below it with 95 %.")
    correction: float = Field(description="Size of the correction.")
    noise: float = Field(description="Standard deviation of a point.")
    inliers: int = Field(description="Lines that are straight under the lens.")


class CalibrationBrief(Answer):
    """A calibration without its maps."""

    id: int
    camera_id: int
    person: str | None
    source: CalibrationSource
    family: LensFamily | None = Field(description="As asked for; null for the best one.")
    status: WorkState
    attempts: int
    progress: CalibrationProgress | None
    parameters: CalibrationScope
    summary: CalibrationSummary | None
    error: ErrorInfo | None
    code_version: str
    n_images: int
    n_segments: int
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    deleted_at: datetime | None
    restorable_until: datetime | None


class CalibrationAnswer(CalibrationBrief):
    """A calibration with its result; null before it is done."""

    result: CalibrationResult | None


class CalibrationPage(Answer):
    """A page of a camera's calibrations."""

    items: list[CalibrationBrief]
    next_cursor: str | None
    total: int


class CameraDetail(CameraAnswer):
    """A camera with its calibrations. ``estimate`` is what the newest run estimated from raw candidates."""

    dataset: DatasetName
    kept_lines: int
    candidates: int
    images_labelled: int = Field(description="Images with kept lines.")
    latest_calibration_id: int | None = Field(description="The newest finished one.")
    latest_calibration: CalibrationBrief | None
    active_calibration: CalibrationBrief | None
    decisions_since: int = Field(
        description="Lines that are kept now and weren't for the latest calibration, or the other way round."
    )


class CalibrationLine(Answer):
    """A line and how far it is from straight under the lens, px."""

    segment_id: int
    image_id: int
    image: str | None = Field(description="Its name; null where the image is gone.")
    rms: float | None
    maximum: float | None
    length: float
    probability: float
    box: tuple[float, float, float, float] | None = Field(description="x0, y0, x1, y1; null where it is gone.")
    state: Literal["current", "replaced", "gone"] = Field(description="What became of the segment since.")


class CalibrationLinePage(Answer):
    """A page of a calibration's lines."""

    items: list[CalibrationLine]
    next_cursor: str | None
    total: int


class CalibrationImage(Answer):
    """An image that a calibration read."""

    image_id: int
    name: str
    segments: int
    inliers: int
    rms: float | None
    left_out_shift: float | None = Field(description="px RMS by which the lens would differ without it.")
    is_there: bool = Field(description="Whether it is an image of the camera still.")


class ImageLine(Answer):
    """A line as measured and with the lens taken out; px, at most 33 points each."""

    segment_id: int
    rms: float | None
    probability: float
    measured: list[tuple[float, float]]
    undistorted: list[tuple[float, float]]


class ImageLines(Answer):
    """The lines of one image, before and after, in pictures of the same size."""

    image_id: int
    width: int
    height: int
    scale: float = Field(description="px of the undistorted picture per px of the corrected image.")
    offset: tuple[float, float] = Field(description="Place of the corrected image's origin in that picture, px.")
    lines: list[ImageLine]


class AdviceCell(Answer):
    """A place in the frame where more lines would help; px."""

    x: float
    y: float
    column: int
    row: int
    sigma_now: float
    sigma_with: float = Field(description="With five more lines of 150 px there.")
    halves: bool


class AdviceImage(Answer):
    """An image that nobody has labelled, and what its candidates would tell."""

    image_id: int
    name: str
    gain: float = Field(description="Expected reduction of the predicted error, px.")


class Advice(Answer):
    """Where more lines would help most, and the images to label next; best first."""

    cells: list[AdviceCell]
    images: list[AdviceImage]
