"""``clearlines token``: the names and roles under which people and programs ask a server."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta

from rich.console import Console
from rich.table import Table

from app.clock import utc_now
from app.commands.stores import opened_stores
from app.db.models import Token
from app.services.tokens import NewToken, create_token, list_tokens, revoke_token
from app.settings import Settings


def make_token(settings: Settings, name: str, role: str, *, days: float | None = None) -> NewToken:
    """Make a token in the database of a data folder; a server at work knows it at once.

    Args:
        settings: Say where the database is.
        name: Of its holder.
        role: What it may do.
        days: How long it is good; without end when left out.

    Raises:
        ClearLinesError: As `app.services.tokens.create_token`.
    """
    lifetime = None if days is None else timedelta(days=days)
    with opened_stores(settings) as (database, _), database.write() as session:
        return create_token(session, name, role, utc_now(), lifetime=lifetime, person=settings.person)


def end_token(settings: Settings, name: str) -> None:
    """Revoke a token.

    Raises:
        NotFound: When no living token has the name.
    """
    with opened_stores(settings) as (database, _), database.write() as session:
        revoke_token(session, name, utc_now(), person=settings.person)


def print_tokens(settings: Settings, console: Console) -> None:
    """List all tokens, people's own too: names, roles and times; the tokens themselves are kept nowhere."""
    with opened_stores(settings) as (database, _), database.read() as session:
        tokens = list_tokens(session)
    if not tokens:
        console.print("there are no tokens; clearlines token create NAME --role ROLE makes one")
        return
    console.print(_table(tokens, utc_now()))


def _table(tokens: Sequence[Token], now: datetime) -> Table:
    table = Table(box=None, pad_edge=False)
    for column in ("name", "role", "state", "made", "expires", "last used", "label"):
        table.add_column(column)
    for token in tokens:
        table.add_row(
            token.name,
            token.role,
            _state(token, now),
            _day(token.created_at),
            _day(token.expires_at),
            _day(token.last_used_at),
            token.label or "",
        )
    return table


def _state(token: Token, now: datetime) -> str:
    if token.revoked_at is not None:
        return "revoked"
    return "expired" if token.expires_at is not None and token.expires_at <= now else "good"


def _day(time: datetime | None) -> str:
    return "-" if time is None else time.strftime("%Y-%m-%d")
