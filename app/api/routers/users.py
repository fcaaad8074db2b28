"""Accounts and tokens, as admins look after them."""

from __future__ import annotations

from datetime import timedelta

from fastapi import APIRouter, Request, Response, status

from app.api.deps import ActorDep, Now, Reader, ServerDep
from app.api.links import link_made
from app.api.problems import answers
from app.api.schemas.accounts import AnyToken, LinkMade, UserAnswer, UserChange
from app.api.schemas.base import RowId
from app.services import accounts
from app.services.account_tokens import end_token
from app.services.invitations import offer_reset
from app.services.tokens import list_tokens

router = APIRouter(prefix="/users", tags=["users"])


@router.get("")
def list_users(session: Reader) -> list[UserAnswer]:
    """List all accounts by name, disabled ones too."""
    return [UserAnswer.model_validate(user) for user in accounts.list_accounts(session)]


@router.patch("/{user_id}", responses=answers(404, 409))
def change_user(server: ServerDep, actor: ActorDep, now: Now, user_id: RowId, given: UserChange) -> UserAnswer:
    """Change somebody's role or address, disable their account or enable it again. The last admin stays one."""
    with server.database.write() as session:
        if given.role is not None:
            accounts.change_role(session, user_id, given.role, now, actor)
        if given.disabled is not None:
            switch = accounts.disable_account if given.disabled else accounts.enable_account
            switch(session, user_id, now, actor)
        if "email" in given.model_fields_set:
            accounts.change_email(session, user_id, given.email, now, actor)
        return UserAnswer.model_validate(accounts.get_account(session, user_id))


@router.post("/{user_id}/reset", status_code=status.HTTP_201_CREATED, responses=answers(404, 409))
def reset_password(server: ServerDep, actor: ActorDep, now: Now, user_id: RowId, request: Request) -> LinkMade:
    """Make a link that lets somebody choose a new password, once; earlier ones end."""
    lifetime = timedelta(days=server.settings.invitation_days)
    with server.database.write() as session:
        made = offer_reset(session, user_id, now, actor, lifetime=lifetime)
    return link_made(request, made)


@router.get("/tokens")
def list_all_tokens(session: Reader) -> list[AnyToken]:
    """List the tokens of services and of people by name, revoked ones too."""
    return [AnyToken.model_validate(token) for token in list_tokens(session)]


@router.delete("/tokens/{token_id}", status_code=status.HTTP_204_NO_CONTENT, responses=answers(404))
def revoke_any_token(server: ServerDep, actor: ActorDep, now: Now, token_id: RowId) -> Response:
    """Revoke a token of a service or of somebody's own."""
    with server.database.write() as session:
        end_token(session, token_id, now, actor)
    return Response(status_code=status.HTTP_204_NO_CONTENT)
