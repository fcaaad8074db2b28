"""What is told of the focal length and the principal point, or why nothing is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from app.errors import InvalidInput


@dataclass(frozen=True)
class FoundDirection:
    """A vanishing point that was used.

    Attributes:
        image: Its name.
        direction: Unit vector in the camera's axes: x right, y down, z ahead.
        lines: Number of lines that point there.
    """

    image: str
    direction: tuple[float, float, float]
    lines: int

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON-serialisable fields."""
        return {"image": self.image, "direction": list(self.direction), "lines": self.lines}


@dataclass(frozen=True)
class FocalEstimate:
    """What the images tell of the pinhole that the undistorted image follows; square pixels, no skew.

    Attributes:
        observable: Whether they tell the focal length.
        focal_length: px; ``None`` where they don't.
        sigma: px, its standard deviation.
        principal_point: px; ``None`` where it is no better known than before.
        principal_point_sigma: px, its standard deviations.
        reason: Why the focal length isn't observable, in words.
        images: Number of images that told.
        vanishing_points: Those that were used.
    """

    observable: bool
    focal_length: float | None = None
    sigma: float | None = None
    principal_point: tuple[float, float] | None = None
    principal_point_sigma: tuple[float, float] | None = None
    reason: str | None = None
    images: int = 0
    vanishing_points: tuple[FoundDirection, ...] = field(default=())

    def as_dict(self) -> dict[str, Any]:
        """Return the estimate as JSON-serialisable fields."""
        return {
            "observable": self.observable,
            "focal_length": self.focal_length,
            "sigma": self.sigma,
            "principal_point": None if self.principal_point is None else list(self.principal_point),
            "principal_point_sigma": None if self.principal_point_sigma is None else list(self.principal_point_sigma),
            "reason": self.reason,
            "images": self.images,
            "vanishing_points": [each.as_dict() for each in self.vanishing_points],
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> FocalEstimate:
        """Return the estimate that `as_dict` gave the fields of.

        Raises:
            InvalidInput: If a field is missing or isn't what it should be.
        """
        try:
            point, sigma = fields["principal_point"], fields["principal_point_sigma"]
            return cls(
                observable=bool(fields["observable"]),
                focal_length=None if fields["focal_length"] is None else float(fields["focal_length"]),
                sigma=None if fields["sigma"] is None else float(fields["sigma"]),
                principal_point=None if point is None else (float(point[0]), float(point[1])),
                principal_point_sigma=None if sigma is None else (float(sigma[0]), float(sigma[1])),
                reason=None if fields["reason"] is None else str(fields["reason"]),
                images=int(fields["images"]),
                vanishing_points=tuple(
                    FoundDirection(
                        str(each["image"]),
                        (float(each["direction"][0]), float(each["direction"][1]), float(each["direction"][2])),
                        int(each["lines"]),
                    )
                    for each in fields["vanishing_points"]
                ),
            )
        except (KeyError, TypeError, ValueError, IndexError) as error:
            raise InvalidInput(f"no estimate of a focal length: {error!r:.80}", where="focal") from error
