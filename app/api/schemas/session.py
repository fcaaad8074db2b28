"""Who asks."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field, StringConstraints

from app.api.schemas.base import Answer, Given

Role = Literal["reader", "submitter", "annotator", "maintainer", "owner"]


class Abilities(Answer):
    """What the viewer may do."""

    submit: bool = Field(description="Hand in submissions.")
    label: bool = Field(description="Decide on candidates.")
    maintain: bool = Field(description="Change datasets, runs and splits.")
    see_hidden: bool = Field(description="See what hidden splits conceal.")


class Me(Answer):
    """Who asks, and what they may do."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "name": "ada",
                "role": "submitter",
                "anonymous": False,
                "can": {"submit": True, "label": False, "maintain": False, "see_hidden": False},
            }
        }
    )

    name: str | None = Field(description="Under which what they do is stored; null for an anonymous reader.")
    role: Role
    anonymous: bool = Field(description="Whether they ask without a token.")
    can: Abilities


class TokenGiven(Given):
    """A token to sign in with."""

    model_config = ConfigDict(json_schema_extra={"example": {"token": "cl_..."}})

    token: Annotated[str, StringConstraints(min_length=1, max_length=300)] = Field(
        description="As `clearlines token create` has printed it."
    )
