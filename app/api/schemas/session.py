"""Who asks."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field, SecretStr, StringConstraints

from app.api.schemas.base import Answer, Given

Role = Literal["reader", "submitter", "annotator", "maintainer", "admin"]
Password = Annotated[SecretStr, Field(min_length=1, max_length=1_000)]
AccountName = Annotated[str, StringConstraints(min_length=1, max_length=200)]


class SecretGiven(Given):
    """A body with a password in it, whose outer spaces belong to it."""

    model_config = ConfigDict(str_strip_whitespace=False)


class Abilities(Answer):
    """What the viewer may do."""

    submit: bool = Field(description="Hand in submissions.")
    label: bool = Field(description="Decide on candidates.")
    maintain: bool = Field(description="Change datasets, runs and splits.")
    see_hidden: bool = Field(description="See what hidden splits conceal.")
    admin: bool = Field(description="Manage accounts, and look after the server.")


class OwnAccount(Answer):
    """The account of whoever asks."""

    id: int
    name: str
    email: str | None
    role: Role = Field(description="Of the account; a token of it may do less.")
    has_password: bool = Field(description="Whether it can be signed in to with a name and a password.")


class Me(Answer):
    """Who asks, and what they may do."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "name": "ada",
                "role": "submitter",
                "anonymous": False,
                "account": {"id": 7, "name": "ada", "email": None, "role": "submitter", "has_password": True},
                "hosted": True,
                "can": {"submit": True, "label": False, "maintain": False, "see_hidden": False, "admin": False},
            }
        }
    )

    name: str | None = Field(description="Under which what they do is stored; null for an anonymous reader.")
    role: Role
    anonymous: bool = Field(description="Whether they ask without an account or token.")
    account: OwnAccount | None = Field(description="Null for a service's token, and for who asks without any.")
    hosted: bool = Field(description="Whether people sign in here; in local mode whoever asks is the owner.")
    can: Abilities


class TokenGiven(Given):
    """A token to sign in with."""

    model_config = ConfigDict(json_schema_extra={"example": {"token": "cl_..."}})

    token: Annotated[str, StringConstraints(min_length=1, max_length=300)] = Field(
        description="As it was shown when it was made."
    )


class PasswordGiven(SecretGiven):
    """A name and a password to sign in with."""

    model_config = ConfigDict(json_schema_extra={"example": {"name": "ada", "password": "..."}})

    name: AccountName = Field(description="Of the account; its case doesn't matter.")
    password: Password
