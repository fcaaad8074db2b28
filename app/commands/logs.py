"""The server's log: as the settings say, and without what they keep secret."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sqlalchemy import make_url
from sqlalchemy.exc import ArgumentError

from app.logs import Redaction, configure_logs
from app.settings import Settings

SECRET_WORDS = ("key", "secret", "token", "password")
SHORTEST = 4
"""What is shorter isn't looked for: it would be found in half of all words."""


def start_log(settings: Settings) -> None:
    """Begin to write the log to standard error."""
    configure_logs(settings.log_format, settings.logged, redaction=Redaction(secrets_of(settings)))


def secrets_of(settings: Settings) -> frozenset[str]:
    """Return what no log may hold."""
    found = {secret.get_secret_value() for secret in (settings.openid_client_secret, settings.metrics_token) if secret}
    if settings.database_url is not None:
        try:
            password = make_url(settings.database_url).password
        except ArgumentError:
            password = None
        found.add(password or "")
    found.update(_secret_values(settings.blob_options))
    return frozenset(text for text in found if len(text) >= SHORTEST)


def _secret_values(options: Mapping[str, Any]) -> set[str]:
    found: set[str] = set()
    for name, value in options.items():
        if isinstance(value, Mapping):
            found |= _secret_values(value)
        elif isinstance(value, str) and any(word in name.lower() for word in SECRET_WORDS):
            found.add(value)
    return found
