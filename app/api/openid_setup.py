"""The provider that the settings name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.errors import InvalidInput
from app.settings import Settings

if TYPE_CHECKING:
    from app.openid.sign_in import OpenIdSignIn


def configured_sign_in(settings: Settings) -> OpenIdSignIn | None:
    """Return the sign-in with the provider of the settings; ``None`` without one, and where nobody signs in.

    Raises:
        InvalidInput: When the libraries for it aren't installed, or the provider has no TLS.
    """
    issuer, client_id, secret = settings.openid_issuer, settings.openid_client_id, settings.openid_client_secret
    if issuer is None or client_id is None or secret is None or settings.anonymous == "admin":
        return None
    try:
        from app.openid.sign_in import open_id_sign_in
    except ModuleNotFoundError as error:
        raise InvalidInput(
            f"{error.name} isn't installed", where="openid_issuer", hint="pip install 'clearlines[oidc]'"
        ) from error
    return open_id_sign_in(settings.openid_name, issuer, client_id, secret.get_secret_value())
