"""How a candidate was found."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.api.schemas.base import Answer

Place = tuple[float, float]


class Piece(Answer):
    """An arc that was fitted to edge points without interruption."""

    start: Place = Field(description="x, y in px.")
    end: Place = Field(description="x, y in px.")
    length: float = Field(description="From start to end, px.")


class Join(Answer):
    """A gap between two pieces that merging closed."""

    start: Place = Field(description="x, y in px.")
    end: Place = Field(description="x, y in px.")
    gap: float = Field(description="From start to end, px.")
    cost: float = Field(description="What the gap counted for, the evidence in the image considered, px.")
    flipped: bool = Field(description="Whether the bright side changes here.")
    round: Literal["following", "flipping", "after extension"] = Field(
        description="Round of merging: along one edge; where the bright side may change; after ends were extended."
    )


class ScorePart(Answer):
    """One feature's part in the score."""

    name: str
    value: float = Field(description="As the score takes it: a logarithm, mostly.")
    weight: float = Field(description="What the value is multiplied by.")
    typical: float = Field(description="Mean value over the image's candidates.")
    measured: float | None = Field(description="What was measured, in the unit.")
    unit: str = Field(description="px, share (of the segment's length), grey levels, or empty.")


class StageHistory(Answer):
    """How a candidate was found. Lists run from its first point to its last."""

    segment_id: int
    image_id: int
    run_id: int = Field(description="The run that found it.")
    pieces: list[Piece] = Field(description="What it was merged from; one piece if it was never broken.")
    joins: list[Join] = Field(description="One less than pieces.")
    extended: tuple[float, float] = Field(description="px added before the first piece and after the last.")
    trimmed: tuple[float, float] = Field(description="px cut off at the start and at the end.")
    score: float = Field(description="Evidence for an edge, 0 to 1: the logistic of intercept + sum(weight * value).")
    score_parts: list[ScorePart]
    intercept: float
