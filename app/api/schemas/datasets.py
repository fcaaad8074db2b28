"""Datasets."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

from pydantic import ConfigDict, Field, StringConstraints

from app.api.schemas.base import Answer, Given, ReviewCounts, VerdictCounts
from app.api.schemas.people import Rules
from app.api.schemas.runs import RunBrief

DatasetName = Annotated[str, StringConstraints(min_length=1, max_length=200, strip_whitespace=True)]

CardText = Annotated[str, StringConstraints(max_length=20_000)]


class DatasetGiven(Given):
    """A dataset to be made."""

    model_config = ConfigDict(json_schema_extra={"example": {"name": "Downtown, spring"}})

    name: DatasetName = Field(description="Shown everywhere; the slug of its address is made from it.")


class DatasetChange(Given):
    """What to change of a dataset; a field that is left out stays, ``null`` clears one."""

    model_config = ConfigDict(
        json_schema_extra={"example": {"description": "Two drives through the city", "licence": "CC BY 4.0"}}
    )

    name: DatasetName | None = None
    description: CardText | None = None
    licence: CardText | None = Field(default=None, description="Under which the images and labels are.")
    citation: CardText | None = Field(default=None, description="How to cite it; plain text or BibTeX.")
    guidelines: CardText | None = Field(default=None, description="What annotators read; Markdown.")
    rules: Rules | None = Field(default=None, description="All of them; `null` for the defaults.")


class DatasetAnswer(Answer):
    """A named set of images, with how far it is."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "slug": "downtown-spring",
                "name": "Downtown, spring",
                "created_at": "2026-05-04T09:30:00Z",
                "deleted_at": None,
                "restorable_until": None,
                "images": 85,
                "reviewed": {"open": 80, "done": 4, "discarded": 1},
                "prelabelled": 85,
                "candidates": 12480,
                "verdicts": {"keep": 310, "reject": 402, "ambiguous": 3, "undecided": 11765},
                "latest_run": None,
                "cover": [1, 2, 3, 4],
            }
        }
    )

    slug: str
    name: str
    created_at: datetime
    deleted_at: datetime | None
    restorable_until: datetime | None
    images: int
    reviewed: ReviewCounts
    prelabelled: int = Field(description="Images with candidates or labels.")
    candidates: int
    verdicts: VerdictCounts
    latest_run: RunBrief | None
    cover: list[int] = Field(description="Up to four images to show for it.")


class Deleted(Answer):
    """What was deleted can be restored for a while."""

    deleted: int
    restorable_until: datetime


class Restored(Answer):
    """How many came back."""

    restored: int
