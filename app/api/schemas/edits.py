"""Edits of segments by hand, and the tracing of edges."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal
from uuid import UUID

from pydantic import ConfigDict, Field, FiniteFloat, model_validator

from app.api.schemas.base import Answer, Given, ReviewState, RowId, VerdictCounts

EditKind = Literal["trace", "cut", "join", "extend", "trim"]
Place = tuple[FiniteFloat, FiniteFloat]
Polyline = Annotated[list[Place], Field(min_length=2, max_length=50_000)]


class TraceGiven(Given):
    """Two to twenty points along an edge, or a segment to extend."""

    model_config = ConfigDict(json_schema_extra={"example": {"points": [[120.0, 88.5], [610.0, 93.0]]}})

    points: Annotated[list[Place], Field(min_length=2, max_length=20)] | None = Field(
        None, description="Clicked points that follow each other along the edge, px."
    )
    reach: float = Field(8.0, gt=0, le=64, description="How far beside a point the edge may lie, px.")
    straight: bool = Field(False, description="The line through the points as drawn, whether an edge is there or not.")
    segment_id: RowId | None = Field(None, description="A segment of the image, in place of points.")
    extend: bool = Field(False, description="Follow the segment's edge beyond both ends.")

    @model_validator(mode="after")
    def _either(self) -> TraceGiven:
        if (self.points is None) == (self.segment_id is None) or self.extend != (self.segment_id is not None):
            raise ValueError("give either points, or a segment_id with extend")
        return self


class TraceAnswer(Answer):
    """An edge as traced; nothing is stored."""

    points: list[Place] = Field(description="Measured points in order, px.")
    length: float = Field(description="Arc length, px.")
    residual: float = Field(description="RMS deviation from straight after undistortion, px.")


class EditGiven(Given):
    """Segments replaced by others. Without `adds` the server makes them of what is replaced."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "client_id": "0c4e1b7a-5f0e-4a53-9a0c-0d1f5b7e2c11",
                "kind": "trace",
                "replaces": [],
                "adds": [[[120.0, 88.5], [365.0, 90.8], [610.0, 93.0]]],
            }
        }
    )

    client_id: UUID = Field(description="Made by the client; sending the same one again changes nothing.")
    kind: EditKind
    replaces: list[RowId] = Field(default_factory=list, max_length=2, description="Ids of current segments that go.")
    adds: Annotated[list[Polyline], Field(min_length=1, max_length=2)] | None = Field(
        None, description="The segments that come, px. A trace needs them; every other kind can do without."
    )
    at: Place | None = Field(None, description="Where to cut, or up to where to trim the nearer end, px.")
    seen: int | None = Field(
        None, ge=0, description="Id of the image's last decision that is known: later ones of others aren't overruled."
    )


class EditAnswer(Answer):
    """An edit of an image."""

    id: int
    image_id: int
    client_id: str = Field(description="The group of its decisions: undo and redo name it as their target.")
    kind: EditKind
    person: str | None
    replaced: list[int]
    added: list[int]
    created_at: datetime
    undone_at: datetime | None


class EditStored(EditAnswer):
    """An edit, and what its image is like afterwards."""

    revision: int
    verdicts: VerdictCounts
    status: ReviewState
    last_decision_id: int


class EditsAnswer(Answer):
    """All edits of an image, oldest first, undone ones too."""

    edits: list[EditAnswer]
