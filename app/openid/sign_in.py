"""One server's part in signing in with a provider: begins flows, and ends each of them once."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from datetime import datetime

from joserfc.jwk import OctKey

from app.errors import Unauthenticated
from app.openid.flow import Flow, require_state
from app.openid.identified import Identified
from app.openid.provider import ClientRegistration, Provider
from app.openid.sealing import seal, sealing_key, unseal


@dataclass
class OpenIdSignIn:
    """Signing in with one provider.

    Attributes:
        name: What people know the provider as.
        provider: The provider.
    """

    name: str
    provider: Provider
    _key: OctKey = field(init=False, repr=False)
    _answered: dict[str, float] = field(default_factory=dict, init=False, repr=False)
    _lock: threading.Lock = field(default_factory=threading.Lock, init=False, repr=False)

    def __post_init__(self) -> None:
        self._key = sealing_key(self.provider.registration.client_secret)

    def begin(self, flow: Flow) -> tuple[str, str]:
        """Return where the browser goes, and what it keeps meanwhile."""
        return self.provider.address_for(flow), seal(flow, self._key)

    def flow_of(self, kept: str, state: str, now: datetime) -> Flow:
        """Return the flow that an answer belongs to; another answer to it isn't taken.

        Args:
            kept: What the browser kept.
            state: What the provider sent back with it.
            now: When.

        Raises:
            Unauthenticated: When the browser didn't begin it, or it has ended.
        """
        flow = unseal(kept, self._key, now)
        require_state(flow, state)
        with self._lock:
            self._answered = {other: end for other, end in self._answered.items() if end > now.timestamp()}
            if flow.state in self._answered:
                raise Unauthenticated("this answer was used already", where="state", hint="sign in once more")
            self._answered[flow.state] = flow.expires
        return flow

    def identify(self, flow: Flow, code: str, issuer: str | None, now: datetime) -> Identified:
        """Return whom the provider has identified.

        Args:
            flow: From `flow_of`.
            code: From the provider, by way of the browser.
            issuer: Who says that it has answered, where it does (RFC 9207).
            now: When.

        Raises:
            Unauthenticated: When it can't be trusted.
            Unavailable: When the provider doesn't answer.
        """
        if issuer is not None and issuer != self.provider.registration.issuer:
            raise Unauthenticated("another provider has answered", where="iss")
        return self.provider.identify(flow, code, now)

    def close(self) -> None:
        """Close the connections to the provider."""
        self.provider.close()


def open_id_sign_in(name: str, issuer: str, client_id: str, client_secret: str) -> OpenIdSignIn:
    """Return the sign-in with a provider; it isn't asked before somebody signs in."""
    return OpenIdSignIn(name, Provider(ClientRegistration(issuer, client_id, client_secret)))
