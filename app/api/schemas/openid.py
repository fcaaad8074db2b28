"""Signing in with a provider."""

from __future__ import annotations

from typing import Annotated

from pydantic import ConfigDict, Field, SecretStr, StringConstraints

from app.api.schemas.base import Answer, Given


class ProviderAnswer(Answer):
    """A provider that one can sign in with."""

    name: str = Field(description="What the button says after `Sign in with`.")
    start: str = Field(description="Address to go to, with `?next=/PATH`; with `&link=true` for one's own account.")


class OpenIdStart(Given):
    """Where to go on to, and with which invitation."""

    model_config = ConfigDict(json_schema_extra={"example": {"next": "/", "invitation": "..."}})

    next: Annotated[str, StringConstraints(max_length=2000)] = Field(default="/", description="Path to go on to.")
    invitation: SecretStr | None = Field(default=None, max_length=300, description="Secret of an invitation to use.")


class OpenIdStarted(Answer):
    """Where the browser is to go."""

    address: str
