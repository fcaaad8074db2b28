"""Invitations, and links to choose a password."""

from __future__ import annotations

from datetime import timedelta

from fastapi import APIRouter, Request, Response, status

from app.api.deps import ActorDep, Now, Reader, ServerDep
from app.api.entrance import EntranceDep, let_in
from app.api.links import link_made
from app.api.problems import answers
from app.api.schemas.accounts import LinkMade
from app.api.schemas.base import RowId
from app.api.schemas.invitations import (
    InvitationAccepted,
    InvitationAnswer,
    InvitationGiven,
    InvitationSecret,
    InvitationSeen,
)
from app.api.schemas.session import Me
from app.services import invitations
from app.services.entering import accept

router = APIRouter(prefix="/invitations", tags=["invitations"])


@router.get("")
def list_invitations(session: Reader) -> list[InvitationAnswer]:
    """List the latest invitations and links, used and expired ones too, the latest first."""
    return [InvitationAnswer.model_validate(row) for row in invitations.list_invitations(session)]


@router.post("", status_code=status.HTTP_201_CREATED, responses=answers(409))
def invite(server: ServerDep, actor: ActorDep, now: Now, request: Request, given: InvitationGiven) -> LinkMade:
    """Make a link that makes an account, once. It is shown this once."""
    lifetime = timedelta(days=given.days or server.settings.invitation_days)
    with server.database.write() as session:
        made = invitations.invite(session, given.role, now, actor, lifetime=lifetime, name=given.name)
    return link_made(request, made)


@router.delete("/{invitation_id}", status_code=status.HTTP_204_NO_CONTENT, responses=answers(404))
def revoke_invitation(server: ServerDep, actor: ActorDep, now: Now, invitation_id: RowId) -> Response:
    """End an invitation or link that nobody has used."""
    with server.database.write() as session:
        invitations.revoke_invitation(session, invitation_id, now, actor)
    return Response(status_code=status.HTTP_204_NO_CONTENT)


@router.post("/look", responses=answers(404))
def look_at_invitation(session: Reader, now: Now, given: InvitationSecret) -> InvitationSeen:
    """Return what a link is for, while it is good."""
    return InvitationSeen.model_validate(invitations.look_at(session, given.secret, now))


@router.post("/accept", responses=answers(404, 409))
def accept_invitation(
    server: ServerDep, entrance: EntranceDep, request: Request, response: Response, given: InvitationAccepted
) -> Me:
    """Make the account that a link is for, or choose its new password, and sign in."""
    password = given.password.get_secret_value()
    user, made = accept(entrance, given.secret, given.name, password, reserved=(server.settings.person,))
    return let_in(request, response, user, made)
