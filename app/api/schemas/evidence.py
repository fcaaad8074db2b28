"""What speaks for and against a candidate."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.api.schemas.base import Answer


class Evidence(Answer):
    """Evidence along a segment, from its first point to its last; at most 400 places of each list."""

    segment_id: int
    image_id: int
    along: list[float] = Field(description="Arc length at each place, px.")
    deviation: list[float] = Field(
        description="Distance from the segment's straight line under the lens, px of the image as stored."
    )
    step: list[float] = Field(description="Brightness to the right of the way minus to the left, grey levels.")
    lens: Literal["accepted", "refused", "none"] = Field(
        description="Unless accepted, straight means straight in the image as it is."
    )
    residual: float = Field(description="RMS of the deviation, px.")
    maximum: float = Field(description="Largest deviation, px.")
    noise: float = Field(description="Standard deviation of the points across the edge, px.")
    length: float = Field(description="Arc length, px.")
    contrast: float = Field(description="Median size of the step, grey levels.")
    evenness: float = Field(description="Lower quartile of the step's size over its median, 0 to 1.")
    polarity: float = Field(description="Share of points whose bright side is the usual one, 0.5 to 1.")
    score: float | None
    straightness: float | None
