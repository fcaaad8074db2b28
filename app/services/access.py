"""Who may do what: the one place where that is decided.

Roles form a ladder; each may do what those below it may:

=========== ==========================================================================================
reader      look at what is public
submitter   hand in submissions, and look after their own
annotator   decide on candidates of images that no hidden split uses
maintainer  everything about datasets, runs and splits, and see what hidden splits conceal
admin       the same, and accounts, tokens and the state of the server. In local mode whoever asks, without a login,
            is its one owner and may do that
=========== ==========================================================================================

What hidden splits conceal from everyone below maintainer is told in ``app.services.concealing``; which role each
address of the API needs, in ``app.api.policy``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from app.errors import InvalidInput

Role = Literal["reader", "submitter", "annotator", "maintainer", "admin"]
ROLES: tuple[Role, ...] = get_args(Role)
"""From the least to the most."""


@dataclass(frozen=True)
class Viewer:
    """Who asks.

    Attributes:
        name: The account's or token's name, the owner's own in local mode, ``None`` for an anonymous reader. What this
            viewer does is stored under it.
        role: What it may do.
        anonymous: Whether it asks without an account or token.
        user_id: The account, where there is one.
        web_session_id: The browser's session, where it asks through one.
    """

    name: str | None
    role: Role
    anonymous: bool = False
    user_id: int | None = None
    web_session_id: int | None = None


def lesser_role(one: str, other: str) -> Role:
    """Return the role of two that may less."""
    return next(role for role in ROLES if role in (one, other))


def checked_role(role: str) -> Role:
    """Return the role.

    Raises:
        InvalidInput: When there is none of that name.
    """
    for known in ROLES:
        if known == role:
            return known
    raise InvalidInput(f"there is no role {role!r:.60}", where="role", expected=", ".join(ROLES))


def is_at_least(viewer: Viewer, role: Role) -> bool:
    """Whether the viewer may do what the role may."""
    return ROLES.index(viewer.role) >= ROLES.index(role)


def can_submit(viewer: Viewer) -> bool:
    """Whether the viewer may hand in submissions."""
    return is_at_least(viewer, "submitter")


def can_label(viewer: Viewer) -> bool:
    """Whether the viewer may decide on candidates."""
    return is_at_least(viewer, "annotator")


def can_maintain(viewer: Viewer) -> bool:
    """Whether the viewer may change datasets, runs and splits."""
    return is_at_least(viewer, "maintainer")


def can_administer(viewer: Viewer) -> bool:
    """Whether the viewer may manage accounts and look after the server."""
    return is_at_least(viewer, "admin")


def can_see_hidden(viewer: Viewer) -> bool:
    """Whether the viewer may see what a hidden split conceals: its labels, and what they could be learnt from."""
    return is_at_least(viewer, "maintainer")


def can_see_details(viewer: Viewer, visibility: str) -> bool:
    """Whether the viewer may see more than rounded totals of scores on a split of that visibility."""
    return visibility == "open" or can_see_hidden(viewer)


def owns(viewer: Viewer, person: str | None) -> bool:
    """Whether what is stored under that name is the viewer's own; what nobody's name is on belongs to nobody."""
    return person is not None and viewer.name == person
