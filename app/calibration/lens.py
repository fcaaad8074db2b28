"""A camera's lens after one of three models, all with coefficients for half diagonals from the image centre.

``brown`` corrects by Brown's polynomial of the measured point, as the ClearLines paper does; ``opencv`` has the same
polynomial of the corrected point, as OpenCV and most calibration tools do; ``division`` divides (Fitzgibbon 2001). The
same lens has other coefficients in each, and none of them follows another one exactly.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.calibration import opencv_direction
from app.calibration.inversion import MapPoints, invert
from app.errors import InvalidInput
from app.vision import brown, division
from app.vision.brown import MINIMUM_DETERMINANT, Mapped
from app.vision.frame import center_of, frame_grid, half_diagonal
from app.vision.lens_fields import numbers_from, size_from

Array = NDArray[np.float64]
Family = Literal["brown", "opencv", "division"]
FAMILY_NAMES: tuple[Family, ...] = get_args(Family)


class LensFamily(NamedTuple):
    """A lens model.

    Attributes:
        names: Of the parameters, in order; the last two are the centre's offset from the image centre.
        map_points: Correction with its Jacobian, in half diagonals.
        map_derivatives: Derivatives of the correction by the parameters.
        derivatives_from: Likewise, given the points that `map_points` found; a model may save work by them.
    """

    names: tuple[str, ...]
    map_points: MapPoints
    map_derivatives: Callable[[Array, Array, Array], tuple[Array, Array]]
    derivatives_from: Callable[[Array, Array, Array, Mapped], tuple[Array, Array]]


BROWN_NAMES = ("k1", "k2", "k3", "p1", "p2", "cx", "cy")


def _brown_derivatives(parameters: Array, x: Array, y: Array, mapped: Mapped) -> tuple[Array, Array]:
    del mapped
    return brown.map_derivatives(parameters, x, y)


def _division_derivatives(parameters: Array, x: Array, y: Array, mapped: Mapped) -> tuple[Array, Array]:
    del mapped
    return division.map_derivatives(parameters, x, y)


FAMILIES: Mapping[Family, LensFamily] = {
    "brown": LensFamily(BROWN_NAMES, brown.map_points, brown.map_derivatives, _brown_derivatives),
    "opencv": LensFamily(
        BROWN_NAMES, opencv_direction.map_points, opencv_direction.map_derivatives, opencv_direction.derivatives_from
    ),
    "division": LensFamily(
        ("k1", "k2", "k3", "cx", "cy"), division.map_points, division.map_derivatives, _division_derivatives
    ),
}


@dataclass(frozen=True)
class CameraLens:
    """A lens for images of one size.

    Attributes:
        family: Its model.
        width: Image width in px.
        height: Image height in px.
        parameters: In the order of the family's names, for lengths in half diagonals.
    """

    family: Family
    width: int
    height: int
    parameters: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.parameters) != len(FAMILIES[self.family].names):
            raise InvalidInput(
                f"{len(self.parameters)} parameters",
                where=f"lens of the model {self.family}",
                expected=", ".join(FAMILIES[self.family].names),
            )

    @classmethod
    def identity(cls, family: Family, width: int, height: int) -> CameraLens:
        """Return the lens of a model that changes nothing."""
        return cls(family, width, height, (0.0,) * len(FAMILIES[family].names))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return FAMILIES[self.family].names

    @property
    def scale(self) -> float:
        """Half the image's diagonal in px, the unit of the coefficients."""
        return half_diagonal(self.width, self.height)

    @property
    def center(self) -> tuple[float, float]:
        """Distortion centre in px."""
        xc, yc = center_of(self.width, self.height)
        cx, cy = self.parameters[-2:]
        return xc + self.scale * cx, yc + self.scale * cy

    def undistort(self, points: ArrayLike) -> Array:
        """Map measured points ``(N, 2)`` in px to corrected ones, float64 ``(N, 2)`` in px; NaN beyond a fold."""
        mapped = FAMILIES[self.family].map_points(np.asarray(self.parameters), *self._normalised(points))
        return self._in_px(mapped.x, mapped.y)

    def jacobian(self, points: ArrayLike) -> Array:
        """Return d(corrected) / d(measured) at points ``(N, 2)`` in px, float64 ``(N, 2, 2)``, no unit."""
        mapped = FAMILIES[self.family].map_points(np.asarray(self.parameters), *self._normalised(points))
        return np.stack([np.stack([mapped.xx, mapped.xy], -1), np.stack([mapped.xy, mapped.yy], -1)], -2)

    def distort(self, points: ArrayLike) -> Array:
        """Map corrected points ``(N, 2)`` in px to measured ones, float64 ``(N, 2)`` in px; NaN where there is none."""
        x, y = self._normalised(points)
        if self.family == "opencv":
            mapped = brown.map_points(np.asarray(self.parameters), x, y)
            reached = opencv_direction.before_fold(np.asarray(self.parameters), x, y)
            return self._in_px(np.where(reached, mapped.x, np.nan), np.where(reached, mapped.y, np.nan))
        return self._in_px(*invert(FAMILIES[self.family].map_points, np.asarray(self.parameters), x, y))

    def is_invertible(self) -> bool:
        """Return whether the correction is one-to-one, with a margin, on the whole frame."""
        grid = frame_grid(self.width, self.height, 49)
        mapped = FAMILIES[self.family].map_points(np.asarray(self.parameters), *self._normalised(grid))
        determinant = mapped.xx * mapped.yy - mapped.xy**2
        # the trace tells a reflection in both axes from a proper map; a comparison with NaN is false
        proper = (determinant > MINIMUM_DETERMINANT) & (mapped.xx + mapped.yy > 0)
        return bool(proper.all())

    def as_dict(self) -> dict[str, Any]:
        """Return the lens as JSON-serialisable fields."""
        return {
            "family": self.family,
            "width": self.width,
            "height": self.height,
            "names": list(self.names),
            "parameters": list(self.parameters),
            "center": list(self.center),
            "scale": self.scale,
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> CameraLens:
        """Return the lens that `as_dict` gave the fields of.

        Raises:
            InvalidInput: If a field is missing or isn't what it should be.
        """
        family = fields.get("family")
        if family not in FAMILY_NAMES:
            raise InvalidInput(f"unknown model {family!r:.40}", where="lens.family", expected=", ".join(FAMILY_NAMES))
        width, height = (size_from(fields, name) for name in ("width", "height"))
        return cls(family, width, height, tuple(numbers_from(fields, "parameters", len(FAMILIES[family].names))))

    def _normalised(self, points: ArrayLike) -> tuple[Array, Array]:
        offset = np.asarray(points, np.float64).reshape(-1, 2) - center_of(self.width, self.height)
        offset /= self.scale
        return offset[:, 0], offset[:, 1]

    def _in_px(self, x: Array, y: Array) -> Array:
        return self.scale * np.stack([x, y], -1) + center_of(self.width, self.height)
