"""Named places in an array of numbers that are added up over images."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class Layout:
    """What stands where in the last axis of tallies.

    Attributes:
        shapes: Name and shape of each part, in order; ``()`` is one number.

    Example:
        >>> layout = Layout((("tp", ()), ("histogram", (2,))))
        >>> layout.pack({"tp": 3, "histogram": [1, 2]})
        array([3., 1., 2.])
        >>> layout.unpack(np.array([[3.0, 1, 2], [4, 0, 0]]))["tp"]
        array([3., 4.])
    """

    shapes: tuple[tuple[str, tuple[int, ...]], ...]

    @cached_property
    def places(self) -> dict[str, slice]:
        """Where each part lies in the last axis."""
        ends = np.cumsum([int(np.prod(shape)) for _, shape in self.shapes]).tolist()
        return {
            name: slice(begin, end) for (name, _), begin, end in zip(self.shapes, [0, *ends[:-1]], ends, strict=True)
        }

    @property
    def size(self) -> int:
        """K, the length of the last axis."""
        return sum(int(np.prod(shape)) for _, shape in self.shapes)

    def pack(self, parts: Mapping[str, ArrayLike]) -> NDArray[np.float64]:
        """Return parts of one image as float64 ``(K,)``.

        Raises:
            KeyError: When a part is missing.
        """
        return np.concatenate(
            [np.broadcast_to(np.asarray(parts[name], np.float64), shape).ravel() for name, shape in self.shapes]
        )

    def unpack(self, tallies: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Return the parts of tallies ``(..., K)``, each ``(..., *shape)``."""
        return {
            name: tallies[..., self.places[name]].reshape((*tallies.shape[:-1], *shape)) for name, shape in self.shapes
        }
