"""What a viewer is told about themselves."""

from __future__ import annotations

from app.api.schemas.session import Abilities, Me, OwnAccount
from app.db.models import User
from app.services.access import Viewer, can_administer, can_label, can_maintain, can_see_hidden, can_submit
from app.settings import Settings


def me_of(settings: Settings, viewer: Viewer, user: User | None) -> Me:
    """Return who a viewer is, and what they may do.

    Args:
        settings: Of the server.
        viewer: Who asks.
        user: Their account, where they have one.
    """
    can = Abilities(
        submit=can_submit(viewer),
        label=can_label(viewer),
        maintain=can_maintain(viewer),
        see_hidden=can_see_hidden(viewer),
        admin=can_administer(viewer),
    )
    return Me(
        name=viewer.name,
        role=viewer.role,
        anonymous=viewer.anonymous,
        account=None if user is None else OwnAccount.model_validate(user),
        hosted=settings.anonymous != "admin",
        can=can,
    )
