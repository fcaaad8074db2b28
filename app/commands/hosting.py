"""What must be there before others can reach a server."""

from __future__ import annotations

from app.commands.stores import opened_stores
from app.errors import Forbidden
from app.services.accounts import has_admin
from app.settings import Settings


def require_admin(settings: Settings) -> None:
    """Refuse to be reached by others while there is nobody who may let them in.

    Raises:
        Forbidden: When no account that isn't disabled has the role admin.
        ClearLinesError: As `app.commands.stores.opened_stores`.
    """
    with opened_stores(settings) as (database, _), database.read() as session:
        if has_admin(session):
            return
    how = f"--host {settings.host}" if settings.public_url is None else f"--public-url {settings.public_url}"
    raise Forbidden(
        "others could reach it, and there is no account yet that may let them in",
        where=how,
        expected="an account with the role admin",
        hint="clearlines user create NAME --role admin makes one, with the same --data or settings; alone on this "
        "machine none is needed: leave the option out, and from elsewhere use ssh -L 8765:127.0.0.1:8765 HOST",
    )
