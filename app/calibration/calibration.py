"""The result of a calibration, as Python object and as JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens import CameraLens
from app.errors import InvalidInput
from app.vision.brown import Brown
from app.vision.conversion import Refit
from app.vision.field import FieldError
from app.vision.lens_fields import brown_as_dict, brown_from_dict, mapping_from, numbers_from

Array = NDArray[np.float64]

VERSION = 1
MAP_COLUMNS = 24


class Warned(NamedTuple):
    """Something that makes lines tell less than their number suggests.

    Attributes:
        code: near-center, one-image, few-lines, one-band, one-direction, one-sided, weak-higher-terms,
            disagreeing-images, outside-frame, copies or within-noise.
        message: In words.
    """

    code: str
    message: str


class Rung(NamedTuple):
    """A step of the model ladder.

    Attributes:
        family: Lens family.
        released: Names of the parameters that it estimates.
        penalised: Negative logarithm of the marginal likelihood.
        held_out: Mean loss of a line that wasn't fitted; ``None`` where nothing could be left out.
        pred: Expected field error in px RMS.
        accepted: Whether the ladder went on from here.
        reason: Why, or why not.
    """

    family: str
    released: tuple[str, ...]
    penalised: float
    held_out: float | None
    pred: float
    accepted: bool
    reason: str


class CalibrationUncertainty(NamedTuple):
    """How far off the lens may be, px over the frame after the best homography.

    Attributes:
        pred: Expected field error, RMS.
        bound95: The field error lies below it with 95 %.
        correction: Size of the correction: the field error of making none.
        jackknife: What leaving images out says the error is; ``None`` with one image.
        effective_lines: Number of lines of the most telling sort that would tell as much.
    """

    pred: float
    bound95: float
    correction: float
    jackknife: float | None
    effective_lines: float


@dataclass(frozen=True, eq=False)
class DisplacementMap:
    """Figures over a regular grid of the frame, corners included.

    Attributes:
        x: float64 ``(C,)`` px.
        y: float64 ``(R,)`` px.
        shift: float64 ``(R, C)``, px by which points are corrected.
        sigma: Likewise, px: the error of the displacement lies below it with 95 %.
        lines: Likewise, px of line length in the cell.
    """

    x: Array
    y: Array
    shift: Array
    sigma: Array
    lines: Array

    def as_dict(self) -> dict[str, Any]:
        """Return the map as JSON-serialisable fields."""
        return {
            "columns": len(self.x),
            "rows": len(self.y),
            "x": _rounded(self.x, 2),
            "y": _rounded(self.y, 2),
            "shift": _rounded(self.shift, 3),
            "sigma": _rounded(self.sigma, 4),
            "lines": _rounded(self.lines, 1),
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> DisplacementMap:
        """Return the map that `as_dict` gave the fields of."""
        columns, rows = (int(fields.get(name, 0)) for name in ("columns", "rows"))
        shapes = {"x": (columns,), "y": (rows,), **dict.fromkeys(("shift", "sigma", "lines"), (rows, columns))}
        return cls(**{name: _array_from(fields, name, shape) for name, shape in shapes.items()})


class ImageFit(NamedTuple):
    """What an image gave and how well it fits.

    Attributes:
        name: Of the image.
        segments: Number of its lines.
        inliers: Those that are straight under the lens.
        rms: px, of the inliers' residuals; ``None`` without any.
        left_out_shift: px RMS by which the lens would differ without the image; ``None`` with one image.
    """

    name: str
    segments: int
    inliers: int
    rms: float | None
    left_out_shift: float | None


class LineResiduals(NamedTuple):
    """Lines of one image under the lens.

    Attributes:
        segment: int64 ``(U,)``, index of each line that was used.
        probability: float64 ``(U,)``, of being straight.
        rms: float64 ``(U,)`` px, of the points' distances from the line in the measured image.
        maximum: float64 ``(U,)`` px, largest distance.
        length: float64 ``(U,)`` px, chord.
    """

    segment: NDArray[np.int64]
    probability: Array
    rms: Array
    maximum: Array
    length: Array


@dataclass(frozen=True, eq=False)
class Calibration:
    """A camera's lens from its lines, with all that is known of how good it is.

    Attributes:
        lens: The lens.
        released: Names of the estimated parameters.
        covariance: Of these, float64 ``(P, P)``.
        accepted: Whether the lens should be used.
        reasons: Why not, in words.
        warnings: What makes the lines tell less than their number suggests.
        ladder: The models that were tried.
        uncertainty: In px over the frame.
        map: The same place by place.
        counts: ``images``, ``segments`` given, ``used`` in the fit, ``inliers`` among those, and their ``points``.
        noise: px, standard deviation of a point.
        brown: The lens as Brown-Conrady lens of the paper, and what that refit lost.
        images: By image.
        focal: Focal length and principal point as JSON fields; ``None`` until estimated.
        free: The free model as JSON fields; ``None`` until estimated.
        seed: Of the draws of the uncertainty.
        lines: By image; not part of the JSON form.
    """

    lens: CameraLens
    released: tuple[str, ...]
    covariance: Array
    accepted: bool
    reasons: tuple[str, ...]
    warnings: tuple[Warned, ...]
    ladder: tuple[Rung, ...]
    uncertainty: CalibrationUncertainty
    map: DisplacementMap
    counts: Mapping[str, int]
    noise: float
    brown: Refit
    images: tuple[ImageFit, ...]
    focal: Mapping[str, Any] | None = None
    free: Mapping[str, Any] | None = None
    seed: int = 0
    lines: tuple[LineResiduals, ...] = field(default=())

    @property
    def sigma(self) -> dict[str, float]:
        """Standard deviation of each released parameter."""
        return {
            name: float(value) for name, value in zip(self.released, np.sqrt(np.diag(self.covariance)), strict=True)
        }

    @property
    def correlation(self) -> Array:
        """Of the released parameters, float64 ``(P, P)``."""
        sd = np.sqrt(np.diag(self.covariance))
        return self.covariance / np.outer(sd, sd) if sd.size else self.covariance

    def as_dict(self) -> dict[str, Any]:
        """Return the calibration as JSON-serialisable fields, all numbers finite or null."""
        return {
            "version": VERSION,
            "width": self.lens.width,
            "height": self.lens.height,
            "lens": self.lens.as_dict(),
            "released": list(self.released),
            "sigma": self.sigma,
            "correlation": _rounded(self.correlation, 6),
            "covariance": self.covariance.tolist(),
            "accepted": self.accepted,
            "reasons": list(self.reasons),
            "warnings": [warned._asdict() for warned in self.warnings],
            "ladder": [{**rung._asdict(), "released": list(rung.released)} for rung in self.ladder],
            "uncertainty": self.uncertainty._asdict(),
            "map": self.map.as_dict(),
            "counts": dict(self.counts),
            "noise": self.noise,
            "brown": {**brown_as_dict(self.brown.brown), "refit_error": self.brown.error._asdict()},
            "images": [image._asdict() for image in self.images],
            "focal": None if self.focal is None else dict(self.focal),
            "free": None if self.free is None else dict(self.free),
            "seed": self.seed,
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> Calibration:
        """Return the calibration that `as_dict` gave the fields of, without the lines.

        Raises:
            InvalidInput: If a field is missing or isn't what it should be.
        """
        if not isinstance(fields, Mapping) or fields.get("version") != VERSION:
            raise InvalidInput("not a calibration of this version", where="version", expected=str(VERSION))
        try:
            brown = mapping_from(fields, "brown")
            released = tuple(map(str, fields["released"]))
            return cls(
                lens=CameraLens.from_dict(mapping_from(fields, "lens")),
                released=released,
                covariance=_array_from(fields, "covariance", (len(released), len(released))),
                accepted=bool(fields["accepted"]),
                reasons=tuple(map(str, fields["reasons"])),
                warnings=tuple(Warned(**warned) for warned in fields["warnings"]),
                ladder=tuple(Rung(**{**rung, "released": tuple(rung["released"])}) for rung in fields["ladder"]),
                uncertainty=CalibrationUncertainty(**mapping_from(fields, "uncertainty")),
                map=DisplacementMap.from_dict(mapping_from(fields, "map")),
                counts=dict(mapping_from(fields, "counts")),
                noise=numbers_from(fields, "noise", 1)[0],
                brown=Refit(_brown_from(brown), FieldError(**mapping_from(brown, "refit_error"))),
                images=tuple(ImageFit(**image) for image in fields["images"]),
                focal=fields.get("focal"),
                free=fields.get("free"),
                seed=int(fields.get("seed", 0)),
            )
        except (KeyError, TypeError, ValueError) as error:
            raise InvalidInput(f"not a calibration: {error}", where="calibration") from None


def _brown_from(fields: Mapping[str, Any]) -> Brown:
    return brown_from_dict(fields)


def _array_from(fields: Mapping[str, Any], name: str, shape: tuple[int, ...]) -> Array:
    values = np.asarray(fields.get(name), np.float64)
    if (values.shape != shape and values.size + int(np.prod(shape)) > 0) or not np.isfinite(values).all():
        raise InvalidInput("not usable", where=name, expected=" x ".join(map(str, shape)) + " finite numbers")
    return values.reshape(shape)


def _rounded(values: Array, digits: int) -> list[Any]:
    return np.round(values, digits).tolist()
