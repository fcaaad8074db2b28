"""Edge-segments: the one type that crosses every border (vision, files, database, evaluation)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidSegments


@dataclass(frozen=True, eq=False)
class Segments:
    """Ordered chains of sub-pixel edge points of one image.

    Segment ``s`` is ``points[offsets[s]:offsets[s + 1]]``.

    Attributes:
        points: float32 ``(N, 2)``, x right and y down in px, pixel centre at integer coordinates.
        offsets: int64 ``(S + 1,)``, from 0 to N, rising by at least 1.
        scores: float32 ``(S,)`` in [0, 1], evidence for an edge; ``None`` where nothing is known.

    Raises:
        InvalidSegments: On a wrong shape, points that aren't finite, or offsets that don't cover the points.
    """

    points: NDArray[np.float32]
    offsets: NDArray[np.int64]
    scores: NDArray[np.float32] | None = None

    def __post_init__(self) -> None:
        points = np.ascontiguousarray(self.points, dtype=np.float32)
        offsets = np.ascontiguousarray(self.offsets, dtype=np.int64)
        if points.ndim != 2 or points.shape[1] != 2:
            raise InvalidSegments(f"points have shape {points.shape}", where="points", expected="(N, 2)")
        if offsets.ndim != 1 or offsets.size == 0 or offsets[0] != 0 or offsets[-1] != len(points):
            raise InvalidSegments(
                "offsets don't cover the points",
                where="offsets",
                expected=f"(S + 1,) integers from 0 to {len(points)}",
            )
        if (np.diff(offsets) < 1).any():
            empty = int(np.flatnonzero(np.diff(offsets) < 1)[0])
            raise InvalidSegments("a segment has no points", where=f"segment {empty}", expected="rising offsets")
        if not np.isfinite(points).all():
            row = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
            segment = int(np.searchsorted(offsets, row, side="right") - 1)
            raise InvalidSegments(
                "a coordinate is not finite", where=f"segment {segment}, point {row - offsets[segment]}"
            )
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "offsets", offsets)
        if self.scores is not None:
            scores = np.ascontiguousarray(self.scores, dtype=np.float32)
            if scores.shape != (len(offsets) - 1,):
                raise InvalidSegments(
                    f"scores have shape {scores.shape}", where="scores", expected=f"({len(offsets) - 1},)"
                )
            object.__setattr__(self, "scores", scores)

    @classmethod
    def empty(cls) -> Segments:
        """Return no segments, with no scores."""
        return cls(np.zeros((0, 2), np.float32), np.zeros(1, np.int64), np.zeros(0, np.float32))

    @classmethod
    def from_list(cls, polylines: Iterable[ArrayLike], scores: ArrayLike | None = None) -> Segments:
        """Join polylines, each ``(n, 2)`` or ``(n, 1, 2)`` in px, in the order given."""
        arrays = [np.asarray(polyline, dtype=np.float32).reshape(-1, 2) for polyline in polylines]
        offsets = np.concatenate([[0], np.cumsum([len(array) for array in arrays], dtype=np.int64)]).astype(np.int64)
        points = np.concatenate(arrays) if arrays else np.zeros((0, 2), np.float32)
        return cls(points, offsets, None if scores is None else np.asarray(scores, dtype=np.float32))

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, index: int) -> NDArray[np.float32]:
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        index %= len(self)
        return self.points[self.offsets[index] : self.offsets[index + 1]]

    def __iter__(self) -> Iterator[NDArray[np.float32]]:
        return (self[index] for index in range(len(self)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Segments):
            return NotImplemented
        same_scores = (self.scores is None) == (other.scores is None) and (
            self.scores is None or other.scores is None or np.array_equal(self.scores, other.scores)
        )
        return same_scores and np.array_equal(self.points, other.points) and np.array_equal(self.offsets, other.offsets)

    __hash__ = None  # type: ignore[assignment]

    @property
    def counts(self) -> NDArray[np.int64]:
        """Points per segment, int64 ``(S,)``."""
        return np.diff(self.offsets)

    @property
    def segment_of_point(self) -> NDArray[np.int64]:
        """Index of the segment that each point belongs to, int64 ``(N,)``."""
        return np.repeat(np.arange(len(self), dtype=np.int64), self.counts)

    def lengths(self) -> NDArray[np.float64]:
        """Arc length of each segment in px, float64 ``(S,)``."""
        steps = np.hypot(*np.diff(self.points.astype(np.float64), axis=0).T) if len(self.points) > 1 else np.zeros(0)
        steps = np.append(steps, 0.0)
        steps[self.offsets[1:] - 1] = 0.0  # the step from one segment to the next is no length
        sums = np.bincount(self.segment_of_point, weights=steps[: len(self.points)], minlength=len(self))
        return sums.astype(np.float64)

    def extents(self) -> NDArray[np.float64]:
        """Distance of each segment's end points in px, float64 ``(S,)``."""
        ends = self.points[self.offsets[1:] - 1].astype(np.float64) - self.points[self.offsets[:-1]]
        return np.hypot(ends[:, 0], ends[:, 1])

    def boxes(self) -> NDArray[np.float32]:
        """Smallest boxes ``(x0, y0, x1, y1)`` in px, float32 ``(S, 4)``."""
        if not len(self):
            return np.zeros((0, 4), np.float32)
        low = np.minimum.reduceat(self.points, self.offsets[:-1], axis=0)
        high = np.maximum.reduceat(self.points, self.offsets[:-1], axis=0)
        return np.concatenate([low, high], axis=1)

    def select(self, chosen: ArrayLike) -> Segments:
        """Return the chosen segments: a boolean mask ``(S,)`` or indices, in the order given."""
        index: NDArray[Any] = np.asarray(chosen)
        index = np.flatnonzero(index) if index.dtype == bool else index.astype(np.int64)
        starts, counts = self.offsets[:-1][index], self.counts[index]
        offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        rows = np.arange(offsets[-1]) + np.repeat(starts - offsets[:-1], counts)
        return Segments(self.points[rows], offsets, None if self.scores is None else self.scores[index])
