"""Focal length and principal point that a file states; lines alone don't fix them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, Protocol

from app.calibration.lens import CameraLens
from app.errors import InvalidInput
from app.vision.frame import center_of, half_diagonal

Source = Literal["given", "estimated", "nominal"]

SHORTEST, LONGEST = 0.02, 1000.0
"""Focal lengths in half diagonals that are taken; outside no coefficient of a file would be of a usable size."""
FARTHEST = 20.0
"""Half diagonals that the principal point may lie from the image centre."""

SOURCES: dict[Source, str] = {
    "given": "given by a person",
    "estimated": "estimated from vanishing points of straight lines",
    "nominal": "nominal, NOT measured: half the image diagonal, so that angles and distances have no meaning",
}


@dataclass(frozen=True)
class Intrinsics:
    """Camera matrix of the undistorted image, with square pixels and no skew.

    Attributes:
        focal_length: px.
        principal_point: px, pixel centre at integers.
        source: Where the focal length is from.
    """

    focal_length: float
    principal_point: tuple[float, float]
    source: Source

    def __post_init__(self) -> None:
        if not math.isfinite(self.focal_length) or self.focal_length <= 0:
            raise InvalidInput(f"{self.focal_length}", where="focal length", expected="a positive length in px")
        if not all(math.isfinite(value) for value in self.principal_point):
            raise InvalidInput("not finite", where="principal point", expected="x and y in px")

    @property
    def told(self) -> str:
        """Where the focal length is from, as a phrase."""
        return SOURCES[self.source]

    def require_plausible(self, lens: CameraLens) -> None:
        """Refuse numbers that belong to no camera of the lens's image size.

        Raises:
            InvalidInput: If the focal length or the principal point is far out of range.
        """
        unit = lens.scale
        if not SHORTEST * unit <= self.focal_length <= LONGEST * unit:
            raise InvalidInput(
                f"{self.focal_length:g} px",
                where="focal length",
                expected=f"{SHORTEST * unit:.3g} to {LONGEST * unit:.3g} px for {lens.width} x {lens.height} px",
            )
        xc, yc = center_of(lens.width, lens.height)
        x, y = self.principal_point
        if math.hypot(x - xc, y - yc) > FARTHEST * unit:
            raise InvalidInput(f"{x:g}, {y:g} px", where="principal point", expected="a point in or near the image")


class EstimatedFocal(Protocol):
    """A focal length estimated from vanishing points, or that there is none."""

    @property
    def focal_length(self) -> float | None:
        """px, or None where the images don't tell."""
        ...


def nominal_intrinsics(width: int, height: int, center: tuple[float, float] | None = None) -> Intrinsics:
    """Return a stand-in for a focal length that nobody knows: half the image diagonal.

    Args:
        width: Image width in px.
        height: Image height in px.
        center: Principal point in px; the lens's distortion centre suits every format best. The image centre if absent.
    """
    return Intrinsics(half_diagonal(width, height), center or center_of(width, height), "nominal")


def choose_intrinsics(
    lens: CameraLens,
    *,
    focal_length: float | None = None,
    principal_point: tuple[float, float] | None = None,
    estimate: EstimatedFocal | None = None,
) -> Intrinsics:
    """Return the best intrinsics that are known: what a person gave, else what was estimated, else nominal ones.

    A principal point that nobody gave is the distortion centre: the optical axis passes through both, lines tell that
    one more closely than vanishing points tell the other, and every format is closest to the lens with it.

    Args:
        lens: The lens.
        focal_length: As given by a person, px.
        principal_point: As given by a person, px.
        estimate: From vanishing points.

    Raises:
        InvalidInput: If a given number is none.
    """
    x, y = principal_point or lens.center
    point = float(x), float(y)
    if focal_length is not None:
        return Intrinsics(float(focal_length), point, "given")
    if estimate is not None and estimate.focal_length is not None:
        return Intrinsics(float(estimate.focal_length), point, "estimated")
    return nominal_intrinsics(lens.width, lens.height, point)
