"""What all schemas share."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Verdict = Literal["keep", "reject", "ambiguous", "undecided"]
RejectReason = Literal["car", "lane_marking", "curved", "shadow", "other"]
Recall = Literal["complete", "nearly", "incomplete"]
WorkState = Literal["queued", "running", "done", "failed", "cancelled"]
ReviewState = Literal["open", "done", "discarded"]
Origin = Literal["pipeline", "manual", "import"]
RowId = Annotated[int, Field(ge=1, le=2**31 - 1)]  # what an id column of every database holds


class Given(BaseModel):
    """A request body: unknown fields are refused, so that a misspelt one isn't silently ignored."""

    model_config = ConfigDict(extra="forbid", str_strip_whitespace=True)


class Answer(BaseModel):
    """An answer, made from the objects that services return."""

    model_config = ConfigDict(from_attributes=True)


class VerdictCounts(Answer):
    """Current candidates by verdict."""

    keep: int = 0
    reject: int = 0
    ambiguous: int = 0
    undecided: int = 0


class ReviewCounts(Answer):
    """Images by review status."""

    open: int = 0
    done: int = 0
    discarded: int = 0


class ErrorInfo(Answer):
    """Why one thing of many failed."""

    code: str
    message: str
    where: str | None = None
    expected: str | None = None
    hint: str | None = None
