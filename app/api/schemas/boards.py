"""Leaderboards."""

from __future__ import annotations

from datetime import datetime

from pydantic import Field

from app.api.schemas.base import Answer
from app.api.schemas.submissions import MethodKind, SplitName, Totals


class BoardMethod(Answer):
    """A method as the board names it."""

    slug: str
    name: str
    kind: MethodKind
    code_url: str | None
    paper_url: str | None


class BoardRow(Answer):
    """The best submission of a method. Its rank is an interval: from ``rank_low`` to ``rank_high``."""

    rank_low: int | None = Field(description="Absent on rows that aren't ranked: ceilings.")
    rank_high: int | None
    tied_with: list[str] = Field(description="Slugs of the methods that the images can't tell from this one.")
    method: BoardMethod
    submission_id: int | None
    label: str | None
    person: str | None
    scored_at: datetime | None
    totals: Totals
    warning: str | None = Field(description="What to know of the official-v1 columns.")


class BoardAnswer(Answer):
    """The board of a split version."""

    split: SplitName
    version: int
    protocol: str
    protocol_version: str
    draws: int
    level: float
    rows: list[BoardRow]
