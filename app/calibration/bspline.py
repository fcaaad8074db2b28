"""Cubic B-splines on a regular grid of knots over the frame: basis, bending energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SplineGrid:
    """Knots of a scalar field over the frame, at equal distances, one of them beyond each border.

    Attributes:
        width: Image width in px.
        height: Image height in px.
        columns: Coefficients along the width, at least 4.
        rows: Coefficients along the height, at least 4.
    """

    width: int
    height: int
    columns: int
    rows: int

    @property
    def size(self) -> int:
        """Number of coefficients of one field."""
        return self.columns * self.rows

    def basis(self, points: ArrayLike) -> Array:
        """Return the value of every basis function at points ``(N, 2)`` in px, float64 ``(N, rows * columns)``.

        Points beyond the frame count as on its border.
        """
        x, y = np.asarray(points, np.float64).reshape(-1, 2).T
        across = _basis(x / max(self.width - 1, 1), self.columns)
        down = _basis(y / max(self.height - 1, 1), self.rows)
        return (down[:, :, None] * across[:, None, :]).reshape(len(x), -1)

    def energy(self) -> Array:
        """Return the quadratic form of the bending energy of a thin plate, float64 ``(size, size)``.

        It is the mean over the frame of ``f_xx^2 + 2 f_xy^2 + f_yy^2`` in units of half the frame's diagonal, exact by
        Gauss's rule in every cell (Duchon 1977; Green and Silverman 1994).
        """
        half = np.hypot(self.width, self.height) / 2
        across = _products(self.columns, max(self.width - 1, 1) / half)
        down = _products(self.rows, max(self.height - 1, 1) / half)
        return np.asarray(
            np.kron(down[0], across[2]) + 2 * np.kron(down[1], across[1]) + np.kron(down[2], across[0]), np.float64
        )


def grid_for(width: int, height: int, longest: int = 10) -> SplineGrid:
    """Return a grid of nearly square cells: `longest` coefficients along the longer side, at least 5 along the other.

    Args:
        width: Image width in px.
        height: Image height in px.
        longest: Coefficients along the longer side.
    """
    cells = longest - 3
    other = max(5, round(cells * min(width, height) / max(width, height)) + 3)
    columns, rows = (longest, other) if width >= height else (other, longest)
    return SplineGrid(width, height, columns, rows)


def _basis(share: Array, number: int) -> Array:
    """Return the uniform cubic B-splines at shares of the side in [0, 1], float64 ``(N, number)``."""
    place = np.clip(share, 0.0, 1.0) * (number - 3)
    cell = np.minimum(place.astype(np.int64), number - 4)
    values = np.zeros((len(place), number))
    rows = np.arange(len(place))
    for offset, value in enumerate(_pieces(place - cell)):
        values[rows, cell + offset] = value
    return values


def _pieces(t: Array) -> tuple[Array, Array, Array, Array]:
    """Return the four cubics that are not 0 at a share t of a cell (de Boor 1978)."""
    s = 1 - t
    return s**3 / 6, (3 * t**3 - 6 * t**2 + 4) / 6, (3 * s**3 - 6 * s**2 + 4) / 6, t**3 / 6


def _slopes(t: Array) -> tuple[Array, Array, Array, Array]:
    s = 1 - t
    return -(s**2) / 2, (9 * t**2 - 12 * t) / 6, -(9 * s**2 - 12 * s) / 6, t**2 / 2


def _curvatures(t: Array) -> tuple[Array, Array, Array, Array]:
    s = 1 - t
    return s, 3 * t - 2, 3 * s - 2, t


def _products(number: int, length: float) -> tuple[Array, Array, Array]:
    """Return mean products of the basis, its first and its second derivatives along a side of a given length."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    t, heavy = (nodes + 1) / 2, weights / 2
    cells = number - 3
    step = length / cells
    forms: list[Array] = []
    for order, pieces in enumerate((_pieces, _slopes, _curvatures)):
        values = np.stack(pieces(t)) / step**order
        local = (values * heavy) @ values.T / cells
        form = np.zeros((number, number))
        for cell in range(cells):
            form[cell : cell + 4, cell : cell + 4] += local
        forms.append(form)
    return forms[0], forms[1], forms[2]
