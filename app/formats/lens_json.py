"""ClearLines' own JSON of a lens, read as a reference: a camera matrix with OpenCV's coefficients.

The file holds the lens in its own model, with coefficients for half diagonals. OpenCV's direction is taken over
exactly; the other models are refitted over the frame, and refused where OpenCV's five coefficients can't hold them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidFile, InvalidInput
from app.vision import brown, division
from app.vision.conversion import OpenCVLens
from app.vision.field import displacement
from app.vision.frame import center_of, frame_grid, half_diagonal
from app.vision.lens_fields import mapping_from, numbers_from, size_from

Array = NDArray[np.float64]

PARAMETERS = {"brown": 7, "opencv": 7, "division": 5}
LONGEST_SHAPE = 50
"""Longer over shorter side; a grid with square cells over a stripe would have millions."""
LARGEST_PARAMETER = 100.0
LIMIT = 0.5
"""px RMS over the frame that a refit may lie from the lens, as in exports."""


def is_lens_json(document: Mapping[Any, Any]) -> bool:
    """Whether a document holds a lens as ClearLines writes it."""
    return isinstance(document.get("lens"), dict) and "family" in document["lens"]


def entry_from_lens(document: Mapping[Any, Any], where: str) -> dict[str, Any]:
    """Return the lens as an entry of ``cameras.json``: width, height, K and D.

    Raises:
        InvalidFile: If a field is missing or isn't what it should be, or five coefficients can't hold the lens.
    """
    family = document["lens"].get("family")
    if family not in tuple(PARAMETERS):
        raise InvalidFile(f"unknown model {family!r:.40}", where=f"{where}: lens", expected=", ".join(PARAMETERS))
    try:
        lens = mapping_from(document, "lens")
        width, height = size_from(lens, "width"), size_from(lens, "height")
        parameters = np.array(numbers_from(lens, "parameters", PARAMETERS[family]))
    except InvalidInput as error:
        raise InvalidFile(error.message, where=f"{where}: lens", expected=error.expected, hint=error.hint) from error
    _require_plausible(width, height, parameters, where)
    scale = half_diagonal(width, height)
    x, y = (np.array(center_of(width, height)) + scale * parameters[-2:]).tolist()
    K = [[scale, 0.0, x], [0.0, scale, y], [0.0, 0.0, 1.0]]
    k1, k2, k3, p1, p2 = (
        parameters[:5] if family == "opencv" else _coefficients(family, parameters, width, height)
    ).tolist()
    D = [k1, k2, p1, p2, k3]
    if family != "opencv":
        _require_close(K, D, family, parameters, (width, height), where)
    return {"width": width, "height": height, "K": K, "D": D}


def _require_plausible(width: int, height: int, parameters: Array, where: str) -> None:
    if max(width, height) > LONGEST_SHAPE * min(width, height):
        raise InvalidFile(
            f"{width} x {height} px is no camera's image", where=f"{where}: lens", expected="width, height"
        )
    if np.abs(parameters).max() > LARGEST_PARAMETER:
        raise InvalidFile(
            "a parameter is too large",
            where=f"{where}: lens",
            expected=f"at most {LARGEST_PARAMETER:g}, half diagonals",
        )


def _corrected(family: str, parameters: Array, width: int, height: int) -> tuple[Array, Array]:
    """Return a grid of the frame and its corrected points, in half diagonals from the distortion centre."""
    measured = (frame_grid(width, height) - center_of(width, height)) / half_diagonal(width, height)
    mapped = (brown if family == "brown" else division).map_points(parameters, *measured.T)
    return measured - parameters[-2:], np.stack([mapped.x, mapped.y], -1) - parameters[-2:]


def _coefficients(family: str, parameters: Array, width: int, height: int) -> Array:
    """Return k1, k2, k3, p1, p2 of the polynomial that carries corrected points to measured ones.

    The corrected image may have any size, so its scale is fitted too; then all is linear. A polynomial of the points
    scaled by s has coefficients that are smaller by s to its degree.
    """
    measured, corrected = _corrected(family, parameters, width, height)
    dx, dy = brown.map_derivatives(np.zeros(7), *corrected.T)
    fields = np.concatenate([np.stack([*dx[:5], corrected[:, 0]], -1), np.stack([*dy[:5], corrected[:, 1]], -1)])
    solution = np.linalg.lstsq(fields, measured.T.ravel(), rcond=1e-12)[0]
    return solution[:5] / max(float(solution[5]), 1e-3) ** np.array([3, 5, 7, 2, 2])


def _require_close(
    K: list[list[float]], D: list[float], family: str, parameters: Array, size: tuple[int, int], where: str
) -> None:
    """Refuse coefficients that lie too far from the lens over the frame."""
    _, corrected = _corrected(family, parameters, *size)
    with np.errstate(all="ignore"):  # beyond a fold OpenCV's iteration ends anywhere
        refitted = OpenCVLens(K, D).undistort(frame_grid(*size))
        error = displacement(corrected * half_diagonal(*size), refitted).rms
    if not error <= LIMIT:
        raise InvalidFile(
            f"OpenCV's coefficients stay {error:.2f} px away from its lens",
            where=f"{where}: lens",
            expected=f"at most {LIMIT:g} px RMS",
            hint="export it for OpenCV, which may take more coefficients, and give that file",
        )
