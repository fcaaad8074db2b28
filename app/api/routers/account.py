"""The account of whoever asks: address, password, where they are signed in, tokens of their own."""

from __future__ import annotations

from datetime import timedelta

from fastapi import APIRouter, Request, Response, status
from sqlalchemy.orm import Session

from app.api.cookies import forget_secrets
from app.api.deps import AccountId, ActorDep, Now, Reader, Server, ServerDep, SignedIn, ViewerDep
from app.api.problems import answers
from app.api.schemas.accounts import (
    AccountAnswer,
    AccountChange,
    IdentityAnswer,
    NewOwnToken,
    OwnToken,
    OwnTokenGiven,
    PasswordChange,
    SessionAnswer,
)
from app.api.schemas.base import RowId
from app.api.schemas.session import OwnAccount
from app.api.throttle import client_address
from app.db.models import User
from app.errors import Conflict, InvalidInput, Unauthenticated
from app.services import accounts, web_sessions
from app.services.account_tokens import end_token, list_own_tokens, make_own_token
from app.services.identities import list_identities, unlink_identity
from app.services.passwords import checked_password

router = APIRouter(prefix="/account", tags=["account"], responses=answers(404))


@router.get("")
def read_account(session: Reader, user_id: AccountId) -> AccountAnswer:
    """Return your account."""
    return _account(session, user_id)


@router.patch("")
def change_account(
    server: ServerDep, actor: ActorDep, now: Now, user_id: SignedIn, given: AccountChange
) -> AccountAnswer:
    """Change where you can be reached."""
    with server.database.write() as session:
        if "email" in given.model_fields_set:
            accounts.change_email(session, user_id, given.email, now, actor)
        return _account(session, user_id)


@router.post("/password", status_code=status.HTTP_204_NO_CONTENT, responses=answers(409, 429))
def change_password(
    server: ServerDep,
    viewer: ViewerDep,
    actor: ActorDep,
    now: Now,
    user_id: SignedIn,
    request: Request,
    given: PasswordChange,
) -> Response:
    """Choose another password, which ends all your sessions but this one."""
    with server.database.read() as session:
        user = accounts.get_account(session, user_id)
    stored = user.password_hash
    if stored is not None:
        _require_right(server, user, stored, given, client_address(request.scope))
    password = checked_password(given.new.get_secret_value(), user.name, "new")
    password_hash = server.passwords.hash_of(password)
    with server.database.write() as session:
        user = accounts.get_account(session, user_id, lock=True)
        if user.password_hash != stored:
            raise Conflict("the password was changed at the same moment", hint="reload and try again")
        kept = viewer.web_session_id
        accounts.change_password(session, user, password_hash, now, actor, kind="user.password_changed", keep=kept)
    return Response(status_code=status.HTTP_204_NO_CONTENT)


@router.delete("/identities/{identity_id}", status_code=status.HTTP_204_NO_CONTENT, responses=answers(409))
def unlink(server: ServerDep, actor: ActorDep, now: Now, user_id: SignedIn, identity_id: RowId) -> Response:
    """Unlink a provider, with which you don't sign in any more. The only way to sign in stays."""
    with server.database.write() as session:
        unlink_identity(session, user_id, identity_id, now, actor)
    return Response(status_code=status.HTTP_204_NO_CONTENT)


@router.get("/sessions")
def list_sessions(
    server: ServerDep, viewer: ViewerDep, session: Reader, now: Now, user_id: AccountId
) -> list[SessionAnswer]:
    """List where you are signed in, the latest first."""
    rows = web_sessions.list_sessions(session, user_id, now, web_sessions.session_rules(server.settings))
    return [
        SessionAnswer(
            id=row.id,
            created_at=row.created_at,
            expires_at=row.expires_at,
            last_used_at=row.last_used_at,
            address=row.address,
            agent=row.agent,
            current=row.id == viewer.web_session_id,
        )
        for row in rows
    ]


@router.delete("/sessions/{session_id}", status_code=status.HTTP_204_NO_CONTENT)
def end_session(
    server: ServerDep, viewer: ViewerDep, actor: ActorDep, now: Now, user_id: AccountId, session_id: RowId
) -> Response:
    """Sign one of your browsers out, this one too."""
    with server.database.write() as session:
        web_sessions.end_session(session, user_id, session_id, now, actor, "session.revoked")
    response = Response(status_code=status.HTTP_204_NO_CONTENT)
    if session_id == viewer.web_session_id:
        forget_secrets(response)
    return response


@router.get("/tokens")
def list_tokens(session: Reader, user_id: AccountId) -> list[OwnToken]:
    """List your tokens, the latest first."""
    return [OwnToken.model_validate(token) for token in list_own_tokens(session, user_id)]


@router.post("/tokens", status_code=status.HTTP_201_CREATED, responses=answers(409))
def make_token(server: ServerDep, actor: ActorDep, now: Now, user_id: SignedIn, given: OwnTokenGiven) -> NewOwnToken:
    """Make a token for a program of yours. It is shown this once, and never may more than you may at that time."""
    lifetime = None if given.days is None else timedelta(days=given.days)
    with server.database.write() as session:
        token, text = make_own_token(session, user_id, given.label, now, actor, role=given.role, lifetime=lifetime)
    return NewOwnToken(**OwnToken.model_validate(token).model_dump(), token=text)


@router.delete("/tokens/{token_id}", status_code=status.HTTP_204_NO_CONTENT)
def revoke_token(server: ServerDep, actor: ActorDep, now: Now, user_id: AccountId, token_id: RowId) -> Response:
    """Revoke one of your tokens."""
    with server.database.write() as session:
        end_token(session, token_id, now, actor, user_id=user_id)
    return Response(status_code=status.HTTP_204_NO_CONTENT)


def _account(session: Session, user_id: int) -> AccountAnswer:
    user = accounts.get_account(session, user_id)
    own = OwnAccount.model_validate(user).model_dump()
    identities = [IdentityAnswer.model_validate(identity) for identity in list_identities(session, user_id)]
    return AccountAnswer(**own, created_at=user.created_at, identities=identities)


def _require_right(server: Server, user: User, stored: str, given: PasswordChange, address: str) -> None:
    """Refuse a wrong password, which counts as a failed sign-in."""
    try:
        with server.throttle.signing_in(user.name_key, address, is_known=True):  # to the session that asks
            current = "" if given.current is None else given.current.get_secret_value()
            server.passwords.require_right(current, stored)
    except Unauthenticated as error:
        raise InvalidInput("this isn't your current password", where="current") from error
