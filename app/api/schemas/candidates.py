"""Predictions imported as candidates."""

from __future__ import annotations

from pydantic import Field

from app.api.schemas.base import Answer
from app.api.schemas.submissions import LeftOutFile


class CandidatesImported(Answer):
    """What became of predictions."""

    images: int = Field(description="Images that there were predictions for.")
    added: int
    duplicates: int = Field(description="Not taken: the image has a candidate there, or had this very one.")
    reopened: int = Field(description="Images that were done and wait for verdicts again.")
    left_out: list[LeftOutFile] = Field(description="Files that weren't read.")
