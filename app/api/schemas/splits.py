"""Splits, their versions and their images."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal

from pydantic import AwareDatetime, ConfigDict, Field, StringConstraints

from app.api.schemas.base import Answer, Given, RowId

SplitName = Annotated[str, StringConstraints(min_length=1, max_length=200)]
Description = Annotated[str, StringConstraints(max_length=20_000)]
DailyLimit = Annotated[int, Field(ge=1, le=100_000, description="Submissions per person and day.")]
Visibility = Literal["open", "hidden"]


class SplitGiven(Given):
    """A split to be frozen from a dataset's labels."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "name": "Downtown test",
                "min_length": 100,
                "visibility": "hidden",
                "description": "85 images of the downtown drives",
                "closes_at": "2026-12-01T00:00:00Z",
                "daily_limit": 5,
                "image_ids": None,
            }
        }
    )

    name: SplitName
    min_length: float = Field(default=0.0, ge=0, le=100_000, description="Shorter labels are ignored; arc length, px.")
    visibility: Visibility = "open"
    description: Description | None = None
    closes_at: AwareDatetime | None = Field(default=None, description="From then on no submission is taken.")
    daily_limit: DailyLimit | None = Field(default=None, description="20 on open, 5 on hidden splits when left out.")
    image_ids: Annotated[list[RowId], Field(min_length=1, max_length=100_000)] | None = Field(
        default=None, description="All images whose review is done when left out."
    )


class SplitChange(Given):
    """What to change of a split; a field that is left out stays, ``null`` clears one."""

    model_config = ConfigDict(json_schema_extra={"example": {"name": "Downtown test 2026", "closes_at": None}})

    name: SplitName | None = None
    description: Description | None = None
    closes_at: AwareDatetime | None = None
    daily_limit: DailyLimit | None = None


class VersionGiven(Given):
    """Labels to be frozen anew."""

    model_config = ConfigDict(json_schema_extra={"example": {"image_ids": None}})

    image_ids: Annotated[list[RowId], Field(min_length=1, max_length=100_000)] | None = Field(
        default=None, description="The images of the newest version that are still there when left out."
    )


class SplitDataset(Answer):
    """The dataset that a split was made from."""

    slug: str
    name: str


class SplitVersionAnswer(Answer):
    """One frozen truth."""

    number: int
    truth_hash: str = Field(description="SHA-256 of names, labels and minimum length.")
    images: int
    labels: int | None = Field(description="Labels to be found; null where a hidden split conceals it.")
    ambiguous: int | None
    created_at: datetime


class SplitAbilities(Answer):
    """What the viewer can do on a split."""

    submit: bool
    maintain: bool
    see_details: bool = Field(description="See more of scores than rounded totals.")


class LabelsSince(Answer):
    """What became of the labels since the newest version was frozen."""

    changed: list[str] = Field(description="Images whose labels differ now.")
    gone: list[str] = Field(description="Images that the dataset has no longer.")


class SplitAnswer(Answer):
    """Frozen labels that detectors are compared on."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "slug": "downtown-test",
                "name": "Downtown test",
                "description": None,
                "dataset": {"slug": "downtown-spring", "name": "Downtown, spring"},
                "visibility": "open",
                "min_length": 100.0,
                "protocol": "clearlines-v2",
                "protocol_version": "1",
                "closes_at": None,
                "closed": False,
                "daily_limit": 20,
                "created_at": "2026-05-04T09:30:00Z",
                "deleted_at": None,
                "version": {
                    "number": 1,
                    "truth_hash": "0f343b0931126a20f133d67c2b018a3b5b1f6a7d1c6d6c2a0c3e4b7a9f3e2d10",
                    "images": 85,
                    "labels": 2210,
                    "ambiguous": 31,
                    "created_at": "2026-05-04T09:30:00Z",
                },
                "versions": [],
                "submissions": 4,
                "can": {"submit": True, "maintain": False, "see_details": True},
                "labels_since": None,
            }
        }
    )

    slug: str
    name: str
    description: str | None
    dataset: SplitDataset | None = Field(description="Null when it is gone, or concealed.")
    visibility: Visibility
    min_length: float
    protocol: str
    protocol_version: str
    closes_at: datetime | None
    closed: bool
    daily_limit: int
    created_at: datetime
    deleted_at: datetime | None
    version: SplitVersionAnswer
    versions: list[SplitVersionAnswer]
    submissions: int = Field(description="Public ones with a score.")
    can: SplitAbilities
    labels_since: LabelsSince | None = Field(
        default=None, description="For maintainers who ask for this one split: whether its labels changed since."
    )


class SplitImageAnswer(Answer):
    """An image that detectors run on."""

    id: int = Field(description="Of the split's image, not of the dataset's.")
    name: str = Field(description="What its file of segments is called, without extension.")
    width: int
    height: int
    source: str | None
    sequence: str | None
    original: str = Field(description="Address of the file as it was uploaded.")
    display: str
    thumbnail: str


class SplitImagePage(Answer):
    """Some images of a split."""

    items: list[SplitImageAnswer]
    next_cursor: str | None
    total: int
