"""Providers that are linked to an account: unlinked by its holder alone, and never the only way in."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from sqlalchemy import select

from app.clock import utc_now
from app.db.models import Event, User
from app.db.session import Database
from app.errors import Conflict, NotFound
from app.openid.identified import Identified
from app.services.accounts import account_named
from app.services.events import Actor
from app.services.identities import link_identified, list_identities, unlink_identity, user_of

Add = Callable[..., User]
HERE = Actor("ada", "10.0.0.7")


def found(subject: str) -> Identified:
    return Identified("https://login.example.org", subject, None, None)


def test_the_only_way_in_stays_until_there_is_a_password(database: Database, add: Add) -> None:
    add(database, "ada", password_hash=None)
    add(database, "bea")
    with database.write() as session:
        ada, bea = (account_named(session, name).id for name in ("ada", "bea"))
        for subject in ("1", "2"):
            link_identified(session, ada, found(subject), utc_now(), HERE)
        first, second = (identity.id for identity in list_identities(session, ada))
        with pytest.raises(NotFound):
            unlink_identity(session, bea, first, utc_now(), Actor("bea"))
        unlink_identity(session, ada, first, utc_now(), HERE)
        with pytest.raises(NotFound, match="no provider is linked"):
            unlink_identity(session, ada, first, utc_now(), HERE)
        with pytest.raises(Conflict, match="only way to sign in"):
            unlink_identity(session, ada, second, utc_now(), HERE)
        assert user_of(session, found("1")) is None
        account_named(session, "ada").password_hash = "$argon2id$"
        unlink_identity(session, ada, second, utc_now(), HERE)
        assert not list_identities(session, ada)
        told = session.scalars(select(Event).where(Event.kind == "user.unlinked")).all()
        assert [(event.person, event.details["issuer"]) for event in told] == [("ada", "https://login.example.org")] * 2
