"""What a person may choose about the detection; every other constant lives beside its stage."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Literal, get_args

from app.errors import InvalidInput

OperatingPoint = Literal["recall", "balanced", "precise"]

# Sobel 3x3 without normalisation: a step of 255 grey levels has a norm of at most 4 * 255 * sqrt(2)
_LARGEST_GRADIENT = 1443.0

_BOUNDS: dict[str, tuple[float, float]] = {
    "min_length": (10.0, 100_000.0),
    "low_threshold": (1.0, _LARGEST_GRADIENT),
    "high_threshold": (1.0, _LARGEST_GRADIENT),
    "clahe_clip": (1.0, 40.0),
    "clahe_tile": (16.0, 4096.0),
    "sigma": (0.3, 5.0),
}


@dataclass(frozen=True)
class DetectionParameters:
    """Parameters of `app.vision.detect`.

    Attributes:
        min_length: Shortest segment returned, distance of its end points in px.
        low_threshold: Gradient norm (3x3 Sobel without normalisation, grey levels) that an edge goes on at.
        high_threshold: Gradient norm that an edge must reach somewhere.
        clahe_clip: Clip limit of the contrast-limited equalisation, in multiples of a flat histogram.
        clahe_tile: Side of an equalisation tile in px.
        sigma: Standard deviation in px of the blur before thresholding.
        operating_point: ``"recall"`` keeps more candidates, ``"precise"`` fewer, ``"balanced"`` is between.

    Raises:
        InvalidInput: On a value of the wrong kind or out of range.
    """

    min_length: float = 100.0
    low_threshold: float = 30.0
    high_threshold: float = 60.0
    clahe_clip: float = 2.0
    clahe_tile: float = 96.0
    sigma: float = 0.6
    operating_point: OperatingPoint = "balanced"

    def __post_init__(self) -> None:
        for name, bounds in _BOUNDS.items():
            object.__setattr__(self, name, _number(name, getattr(self, name), *bounds))
        if self.low_threshold > self.high_threshold:
            raise InvalidInput(
                f"low_threshold {self.low_threshold:g} is above high_threshold {self.high_threshold:g}",
                where="low_threshold",
                expected="low_threshold <= high_threshold",
            )
        if self.operating_point not in get_args(OperatingPoint):
            raise InvalidInput(
                f"{self.operating_point!r} is no operating point",
                where="operating_point",
                expected=", ".join(get_args(OperatingPoint)),
            )

    def as_dict(self) -> dict[str, Any]:
        """Return the parameters as JSON-serialisable fields."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> DetectionParameters:
        """Build parameters from fields; those left out keep their default.

        Raises:
            InvalidInput: On a name that doesn't exist, or a value of the wrong kind or out of range.
        """
        if not isinstance(values, Mapping):
            raise InvalidInput("the parameters are no mapping", where="parameters", expected="name: value pairs")
        known = [field.name for field in fields(cls)]
        for name in values:
            if name not in known:
                raise InvalidInput(f"no parameter {name!r}", where="parameters", expected=", ".join(known))
        return cls(**values)


def _number(name: str, value: object, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InvalidInput(f"{value!r} is not a finite number", where=name, expected=f"{low:g} to {high:g}")
    if not low <= value <= high:
        raise InvalidInput(f"{value:g} is out of range", where=name, expected=f"{low:g} to {high:g}")
    return float(value)
