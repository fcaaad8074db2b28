"""Accounts, as their holders and as admins see them."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

from pydantic import ConfigDict, Field, StringConstraints

from app.api.schemas.base import Answer, Given
from app.api.schemas.session import OwnAccount, Password, Role, SecretGiven

Email = Annotated[str, StringConstraints(max_length=320)]
Days = Annotated[float, Field(gt=0, le=36_500, description="Good for so many days.")]


class IdentityAnswer(Answer):
    """A provider that one can sign in with."""

    id: int
    issuer: str = Field(description="Address of the provider.")
    created_at: datetime = Field(description="When it was linked.")


class AccountAnswer(OwnAccount):
    """The account of whoever asks."""

    created_at: datetime
    identities: list[IdentityAnswer] = Field(description="Providers that are linked to it, the first one first.")


class AccountChange(Given):
    """What to change of one's account; what is left out stays."""

    model_config = ConfigDict(json_schema_extra={"example": {"email": "ada@example.org"}})

    email: Email | None = Field(None, description="Only you and admins see it; null or nothing forgets it.")


class PasswordChange(SecretGiven):
    """A new password."""

    model_config = ConfigDict(json_schema_extra={"example": {"current": "...", "new": "..."}})

    current: Password | None = Field(None, description="Left out only where there is none yet.")
    new: Password = Field(description="10 to 200 characters, none of the passwords that are guessed first.")


class SessionAnswer(Answer):
    """A browser that is signed in."""

    id: int
    created_at: datetime
    expires_at: datetime
    last_used_at: datetime = Field(description="To some minutes.")
    address: str | None = Field(description="Of the network that it signed in from.")
    agent: str | None = Field(description="What the browser said it is.")
    current: bool = Field(description="Whether it is this one.")


class OwnTokenGiven(Given):
    """A token to make for a program of one's own."""

    model_config = ConfigDict(json_schema_extra={"example": {"label": "cluster", "role": "submitter", "days": 90}})

    label: Annotated[str, StringConstraints(min_length=1, max_length=200)] = Field(description="What it is for.")
    role: Role | None = Field(None, description="At most your own, which it is when left out.")
    days: Days | None = None


class OwnToken(Answer):
    """A token of one's own; the token itself is kept nowhere."""

    id: int
    label: str
    role: Role = Field(description="It never may more than the account may at that time.")
    created_at: datetime
    expires_at: datetime | None
    last_used_at: datetime | None = Field(description="To some minutes.")


class NewOwnToken(OwnToken):
    """A token at the one moment when it is shown."""

    token: str


class UserAnswer(OwnAccount):
    """An account as admins see it."""

    created_at: datetime
    created_by: str | None
    disabled_at: datetime | None
    last_seen_at: datetime | None = Field(description="To some minutes.")


class UserChange(Given):
    """What to change of somebody's account; what is left out stays."""

    model_config = ConfigDict(json_schema_extra={"example": {"role": "annotator"}})

    role: Role | None = None
    disabled: bool | None = Field(None, description="True ends their sessions, tokens and links at once, and for good.")
    email: Email | None = Field(None, description="Null or nothing forgets it.")


class AnyToken(Answer):
    """A token of a service, or of somebody's own, as admins see it."""

    id: int
    name: str = Field(description="Of the service or the person; what it is used for is stored under it.")
    user_id: int | None = Field(description="Null for a service.")
    label: str | None
    role: Role
    created_at: datetime
    expires_at: datetime | None
    revoked_at: datetime | None
    last_used_at: datetime | None


class LinkMade(Answer):
    """A link at the one moment when it is shown."""

    id: int
    secret: str
    address: str = Field(description="To be given to whom it is for; whoever has it can use it, once.")
    expires_at: datetime
