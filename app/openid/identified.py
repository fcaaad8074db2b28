"""Whom a provider has identified."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Identified:
    """Whom the provider has identified.

    Attributes:
        issuer: The provider.
        subject: Its name for the person, which never changes.
        name: What they want to be called; a hint.
        email: Theirs, where the provider has verified it.
    """

    issuer: str
    subject: str
    name: str | None
    email: str | None
