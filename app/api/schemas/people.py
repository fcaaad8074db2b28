"""Several people: names, leases, tasks, and what a dataset's annotators are asked."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal
from uuid import UUID

from pydantic import ConfigDict, Field, StringConstraints

from app.api.schemas.base import Answer, Given, RowId

PersonName = Annotated[str, StringConstraints(min_length=1, max_length=80)]


class LeaseGiven(Given):
    """A page that has an image open; to be sent again every 20 s."""

    model_config = ConfigDict(json_schema_extra={"example": {"client_id": "1f0cc3f2-9d0e-4b4e-8a45-5d7d1e1a2b3c"}})

    client_id: UUID = Field(description="Of the page, made by it.")
    take_over: bool = Field(False, description="Hold the image although another person does.")


class Present(Answer):
    """Someone who has the image open."""

    person: str | None
    since: datetime
    mine: bool = Field(description="Whether it is you, on whatever page.")


class LeaseAnswer(Answer):
    """Who has an image open."""

    holder: Present | None = Field(description="Who is at it; the others are to wait, or take it over.")
    expires_at: datetime = Field(description="Until when this page counts as present.")
    present: list[Present]


class AssignGiven(Given):
    """Whose task images are to be."""

    model_config = ConfigDict(json_schema_extra={"example": {"people": ["Mara", "Jon"], "mode": "shares"}})

    people: list[PersonName] = Field(max_length=100, description="For `to` one, or none to take images back.")
    mode: Literal["shares", "to"] = Field(description="Equal shares that keep a drive together, or all to one person.")
    image_ids: Annotated[list[RowId], Field(min_length=1, max_length=100_000)] | None = Field(
        None, description="All open images that are nobody's task when left out."
    )


class Share(Answer):
    """How many images a person was given."""

    person: str
    images: int


class Assigned(Answer):
    """What was assigned."""

    people: list[Share]


class PersonAnswer(Answer):
    """One who has images to review, or decided on some."""

    person: str
    assigned: int
    done: int = Field(description="Of those assigned.")
    decisions: int


class Rules(Given):
    """What is asked of annotators."""

    model_config = ConfigDict(from_attributes=True, json_schema_extra={"example": {"second_share": 0.1}})

    second_share: float = Field(0.0, ge=0, le=1, description="Of the images: reviewed blindly by a second person.")
    ask_recall: bool = Field(False, description="Ask how complete the labels are when an image is done.")


class GuidelinesAnswer(Answer):
    """What annotators read and are asked."""

    guidelines: str | None = Field(description="Markdown.")
    rules: Rules
