"""Tokens that people make for programs of their own: with a label, and never more rights than they have themselves."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Token
from app.errors import Conflict, Forbidden, NotFound
from app.services.access import Role, checked_role, lesser_role
from app.services.accounts import get_account
from app.services.events import Actor, record_account_event
from app.services.given import checked_name
from app.services.link_revoking import revoke_links_by
from app.services.tokens import checked_lifetime, hash_of, new_text

MOST_TOKENS = 100


def make_own_token(
    session: Session,
    user_id: int,
    label: str,
    now: datetime,
    actor: Actor,
    *,
    role: Role | None = None,
    lifetime: timedelta | None = None,
) -> tuple[Token, str]:
    """Make a token of a person's own; it ends with their account, and never may more than they may at that time.

    Args:
        session: A writing session.
        user_id: Whose it is.
        label: What it is for; no other living one of theirs has it.
        now: When.
        actor: Who makes it.
        role: At most theirs; theirs when left out.
        lifetime: How long it is good; without end when left out.

    Returns:
        Its row, and its text, which is kept nowhere.

    Raises:
        InvalidInput: When label, role or lifetime can't be.
        Forbidden: When the role is above theirs.
        Conflict: When a living token of theirs has the label, they have very many, or the account is disabled.
    """
    user = get_account(session, user_id, lock=True)
    if user.disabled_at is not None:  # at this very moment
        raise Conflict("the account is disabled")
    label = checked_name(label, "label")
    role_given = checked_role(role or user.role)
    if lesser_role(role_given, user.role) != role_given:
        raise Forbidden(f"a token can't do more than you: {user.role}", where="role", expected=f"at most {user.role}")
    own = list_own_tokens(session, user_id)
    if any(token.label == label for token in own):
        raise Conflict(f"you have a token labelled {label} already", where="label", hint="revoke that one first")
    if len(own) >= MOST_TOKENS:
        raise Conflict(f"you have {len(own)} tokens", expected=f"at most {MOST_TOKENS}", hint="revoke some")
    lifetime = checked_lifetime(lifetime)
    text = new_text()
    token = Token(
        user_id=user.id,
        name=user.name,
        label=label,
        role=role_given,
        sha256=hash_of(text),
        created_at=now,
        expires_at=None if lifetime is None else now + lifetime,
    )
    session.add(token)
    session.flush()
    record_account_event(session, "token.created", now, actor, name=user.name, label=label, role=role_given)
    return token, text


def list_own_tokens(session: Session, user_id: int) -> Sequence[Token]:
    """Return somebody's tokens that aren't revoked, expired ones too, the latest first."""
    query = select(Token).where(Token.user_id == user_id, Token.revoked_at.is_(None))
    return session.scalars(query.order_by(Token.id.desc())).all()


def end_token(session: Session, token_id: int, now: datetime, actor: Actor, *, user_id: int | None = None) -> None:
    """Revoke a token by its id.

    Args:
        session: A writing session.
        token_id: Its id.
        now: When.
        actor: Who does it.
        user_id: Whose it must be; anybody's, and a service's too, when left out.

    Raises:
        NotFound: When there is no such token, or it is revoked.
    """
    mine = [] if user_id is None else [Token.user_id == user_id]
    query = select(Token).where(Token.id == token_id, Token.revoked_at.is_(None), *mine)
    token = session.scalars(query.with_for_update()).one_or_none()
    if token is None:
        raise NotFound(f"there is no token {token_id}", hint="it may be revoked already")
    token.revoked_at = now
    session.flush()
    if token.user_id is None:
        revoke_links_by(session, token.name, now)
    label = {} if token.label is None else {"label": token.label}
    record_account_event(session, "token.revoked", now, actor, name=token.name, **label)
