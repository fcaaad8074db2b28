"""Methods."""

from __future__ import annotations

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, Given
from app.api.schemas.submissions import MethodKind, SubmissionAnswer


class MethodAnswer(Answer):
    """A detector, with what was submitted for it."""

    slug: str
    name: str
    kind: MethodKind
    description: str | None
    code_url: str | None
    paper_url: str | None
    person: str | None
    anonymous: bool
    mine: bool
    submissions: list[SubmissionAnswer]


class MethodChange(Given):
    """What to change of a method; ``anonymous: false`` reveals whose it is, for good."""

    model_config = ConfigDict(json_schema_extra={"example": {"code_url": "https://example.org/code"}})

    name: str | None = Field(None, min_length=1, max_length=200)
    description: str | None = Field(None, max_length=20_000)
    code_url: str | None = Field(None, max_length=2_000)
    paper_url: str | None = Field(None, max_length=2_000)
    anonymous: bool | None = None
