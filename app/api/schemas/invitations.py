"""Invitations, and links to choose a password."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal

from pydantic import ConfigDict, Field, StringConstraints

from app.api.schemas.base import Answer, Given
from app.api.schemas.session import AccountName, Password, Role, SecretGiven

Secret = Annotated[str, StringConstraints(min_length=1, max_length=300)]
Kind = Literal["join", "reset"]


class InvitationGiven(Given):
    """Whom to invite."""

    model_config = ConfigDict(json_schema_extra={"example": {"role": "annotator", "name": "ada", "days": 7}})

    role: Role = Field(description="Of the account that comes of it.")
    name: Annotated[str, StringConstraints(min_length=1, max_length=80)] | None = Field(
        None, description="Of the account; who is invited chooses one when left out."
    )
    days: Annotated[float, Field(gt=0, le=366)] | None = Field(
        None, description="How long it is good; as the server is set when left out."
    )


class InvitationAnswer(Answer):
    """An invitation, or a link to choose a password; the link itself is kept nowhere."""

    id: int
    kind: Kind
    role: Role | None = Field(description="Null for a link to choose a password.")
    name: str | None
    created_by: str | None
    created_at: datetime
    expires_at: datetime
    used_at: datetime | None
    revoked_at: datetime | None
    user_id: int | None = Field(description="Whose password it is for, or whose account came of it.")


class InvitationSecret(Given):
    """What a link ends with."""

    model_config = ConfigDict(json_schema_extra={"example": {"secret": "..."}})

    secret: Secret


class InvitationSeen(Answer):
    """What a link is for."""

    kind: Kind
    role: Role
    name: str | None = Field(description="Null where whoever uses it chooses one.")
    expires_at: datetime


class InvitationAccepted(SecretGiven):
    """Taking an invitation up, or choosing a new password."""

    model_config = ConfigDict(json_schema_extra={"example": {"secret": "...", "name": "ada", "password": "..."}})

    secret: Secret
    name: AccountName | None = Field(None, description="Needed where the invitation leaves it open.")
    password: Password = Field(description="10 to 200 characters, none of the passwords that are guessed first.")
