"""The result of a calibration, as it is stored: lengths in px, places with x to the right and y down."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.api.schemas.base import Answer

Grid = list[list[float | None]]


class LensAnswer(Answer):
    """A lens; parameters are for lengths in half diagonals from the image centre."""

    family: Literal["brown", "opencv", "division"]
    width: int
    height: int
    names: list[str]
    parameters: list[float]
    center: tuple[float, float]
    scale: float = Field(description="Half the diagonal.")


class CalibrationWarning(Answer):
    """Something that makes the lines tell less than their number suggests."""

    code: str
    message: str


class LadderStep(Answer):
    """A model that was tried."""

    family: str
    released: list[str]
    penalised: float
    held_out: float | None
    pred: float | None
    accepted: bool
    reason: str


class LensUncertainty(Answer):
    """How far off the lens may be, over the frame after the best homography."""

    pred: float
    bound95: float
    correction: float
    jackknife: float | None
    effective_lines: float


class DisplacementMap(Answer):
    """Figures over a grid of the frame, row by row."""

    columns: int
    rows: int
    x: list[float]
    y: list[float]
    shift: Grid = Field(description="Length of the correction.")
    sigma: Grid = Field(description="95 % bound of its error.")
    lines: Grid = Field(description="Length of lines in the cell.")


class CalibrationCounts(Answer):
    """What was used."""

    images: int
    segments: int
    used: int
    inliers: int
    points: int


class FieldErrorAnswer(Answer):
    """A difference over the frame."""

    rms: float
    maximum: float


class BrownAnswer(Answer):
    """The lens in the parameters of the paper, and what that refit lost."""

    width: int
    height: int
    center: tuple[float, float]
    scale: float
    k: list[float]
    p: list[float]
    refit_error: FieldErrorAnswer


class ImageFit(Answer):
    """What an image gave."""

    name: str
    segments: int
    inliers: int
    rms: float | None
    left_out_shift: float | None


class VanishingPoint(Answer):
    """A direction that lines of an image share, unit length in camera coordinates."""

    image: str
    direction: tuple[float, float, float]
    lines: int


class FocalAnswer(Answer):
    """Focal length and principal point of the undistorted image, or why they can't be told."""

    observable: bool
    focal_length: float | None
    sigma: float | None
    principal_point: tuple[float, float] | None
    principal_point_sigma: tuple[float, float] | None
    reason: str | None
    images: int
    vanishing_points: list[VanishingPoint]


class FreeModelAnswer(Answer):
    """What a smooth field on top of the lens would add: what the lens misses."""

    used: bool
    lines: int
    needed: int
    reason: str | None
    columns: int
    rows: int
    x: list[float]
    y: list[float]
    dx: Grid
    dy: Grid
    sigmas: Grid = Field(description="Standard deviation of its length at the same places.")
    rms: float | None
    sigma: float | None


class CalibrationResult(Answer):
    """A camera's lens from its lines, with all that is known of how good it is."""

    version: int
    width: int
    height: int
    lens: LensAnswer
    released: list[str]
    sigma: dict[str, float]
    correlation: list[list[float]]
    covariance: list[list[float]]
    accepted: bool
    reasons: list[str]
    warnings: list[CalibrationWarning]
    ladder: list[LadderStep]
    uncertainty: LensUncertainty
    map: DisplacementMap
    counts: CalibrationCounts
    noise: float
    brown: BrownAnswer
    images: list[ImageFit]
    focal: FocalAnswer | None
    free: FreeModelAnswer | None
    seed: int


class LensDifference(Answer):
    """How far the lens is from the camera's reference, after the best homography; null where either folds."""

    columns: int
    rows: int
    x: list[float]
    y: list[float]
    dx: Grid
    dy: Grid
    rms: float
    maximum: float
    inner_rms: float


class ExportOption(Answer):
    """Whether, and how exactly, a format holds the lens."""

    format: str
    title: str
    file_name: str
    model: str | None
    error: FieldErrorAnswer | None
    allowed: bool
    reason: str | None


class IntrinsicsAnswer(Answer):
    """Focal length and principal point that exports state."""

    focal_length: float
    principal_point: tuple[float, float]
    source: Literal["given", "estimated", "nominal"]


class ExportOverview(Answer):
    """The formats a lens can be written in."""

    intrinsics: IntrinsicsAnswer
    formats: list[ExportOption]
