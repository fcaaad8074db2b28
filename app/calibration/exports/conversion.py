"""A lens as a format holds it."""

from __future__ import annotations

from dataclasses import dataclass

from app.calibration.exports.frame_sample import ConversionError


@dataclass(frozen=True)
class Conversion:
    """A lens as a format holds it.

    Attributes:
        model: As the format calls it.
        coefficients: In the format's order and units.
        error: How far it lies from our lens.
        notes: What else a reader must know, one sentence each.
        focal_length: Of the file's camera matrix in px; None if it has none, or the stated one.
        principal_point: Of the file's camera matrix in px; None if it has none, or the stated one.
    """

    model: str
    coefficients: tuple[float, ...]
    error: ConversionError
    notes: tuple[str, ...] = ()
    focal_length: float | None = None
    principal_point: tuple[float, float] | None = None
