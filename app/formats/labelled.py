"""What a file holds beyond the points: straightness, verdict, reason, origin and id of each segment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidSegments
from app.verdicts import REASONS, VERDICTS
from app.vision.segments import Segments

ORIGINS = ("pipeline", "manual", "import")


@dataclass(frozen=True, eq=False)
class LabelledSegments:
    """Segments of one image with what is known of each.

    Attributes:
        segments: Points, offsets and, where known, scores.
        straightness: float32 ``(S,)`` in [0, 1], probability of being straight under the lens; ``None`` if unknown.
        verdicts: One of `VERDICTS` or ``None`` per segment; ``None`` if no segment has one.
        origins: One of `ORIGINS` or ``None`` per segment; ``None`` if no segment has one.
        ids: Identity of each segment in the system it comes from; ``None`` if no segment has one.
        reasons: Why a rejected segment is rejected, one of `REASONS` or ``None`` per segment; ``None`` if none has one.

    Raises:
        InvalidSegments: If a field hasn't one value per segment, a value isn't one of the known words, or a segment
            that isn't rejected has a reason.
    """

    segments: Segments
    straightness: NDArray[np.float32] | None = None
    verdicts: tuple[str | None, ...] | None = None
    origins: tuple[str | None, ...] | None = None
    ids: tuple[str | None, ...] | None = None
    reasons: tuple[str | None, ...] | None = None

    def __post_init__(self) -> None:
        count = len(self.segments)
        if self.straightness is not None:
            object.__setattr__(self, "straightness", np.ascontiguousarray(self.straightness, dtype=np.float32))
        for name in ("straightness", "verdicts", "origins", "ids", "reasons"):
            values = getattr(self, name)
            if values is not None and len(values) != count:
                raise InvalidSegments(f"{len(values)} {name} for {count} segments", where=name, expected=str(count))
        for name, known in (("verdicts", VERDICTS), ("origins", ORIGINS), ("reasons", REASONS)):
            for index, value in enumerate(getattr(self, name) or ()):
                if value is not None and value not in known:
                    raise InvalidSegments(
                        f"{value!r} is not known", where=f"segment {index}, {name}", expected=", ".join(known)
                    )
        verdicts = self.verdicts or (None,) * count
        for index, (reason, verdict) in enumerate(zip(self.reasons or (), verdicts, strict=False)):
            if reason is not None and verdict != "reject":
                raise InvalidSegments(
                    f"the reason {reason!r} is for nothing",
                    where=f"segment {index}, reasons",
                    expected="a reason with the verdict 'reject' alone",
                )

    def __len__(self) -> int:
        return len(self.segments)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, LabelledSegments):
            return NotImplemented
        mine, theirs = self.straightness, other.straightness
        same_straightness = (mine is None) == (theirs is None) and (
            mine is None or theirs is None or np.array_equal(mine, theirs)
        )
        words = (self.verdicts, self.origins, self.ids, self.reasons) == (
            other.verdicts,
            other.origins,
            other.ids,
            other.reasons,
        )
        return same_straightness and words and self.segments == other.segments

    __hash__ = None  # type: ignore[assignment]

    def select(self, chosen: ArrayLike) -> LabelledSegments:
        """Return the chosen segments with their fields: a boolean mask ``(S,)`` or indices, in the order given."""
        index = np.asarray(chosen)
        index = np.flatnonzero(index) if index.dtype == bool else index.astype(np.int64)

        def pick(values: tuple[str | None, ...] | None) -> tuple[str | None, ...] | None:
            return None if values is None else tuple(values[int(i)] for i in index)

        return LabelledSegments(
            self.segments.select(index),
            None if self.straightness is None else self.straightness[index],
            pick(self.verdicts),
            pick(self.origins),
            pick(self.ids),
            pick(self.reasons),
        )

    def with_verdict(self, *verdicts: str) -> LabelledSegments:
        """Return the segments of these verdicts; one without a verdict counts as ``undecided``."""
        given: Sequence[str | None] = self.verdicts or (None,) * len(self)
        return self.select(np.array([(verdict or "undecided") in verdicts for verdict in given], dtype=bool))
