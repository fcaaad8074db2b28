"""One attempt to sign in: what the provider's answer is compared with."""

from __future__ import annotations

import base64
import hashlib
import hmac
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.errors import Unauthenticated

LIFETIME = timedelta(minutes=10)


@dataclass(frozen=True)
class Flow:
    """One attempt to sign in, from its start to the answer of the provider.

    Attributes:
        state: What the provider sends back with its answer.
        nonce: What the identity token must hold.
        verifier: What shows the provider that the code comes from whoever asked for it (PKCE, RFC 7636).
        expires: Until when, in s since the epoch.
        next: Path to go on to.
        redirect: Where the provider sends the browser back to.
        invitation: Secret of the invitation that is to be used.
        user_id: Account that the identity is to be linked with.
    """

    state: str
    nonce: str
    verifier: str
    expires: float
    next: str
    redirect: str
    invitation: str | None = None
    user_id: int | None = None

    @property
    def challenge(self) -> str:
        """What the provider is told of the verifier (RFC 7636, section 4.2, S256)."""
        digest = hashlib.sha256(self.verifier.encode()).digest()
        return base64.urlsafe_b64encode(digest).rstrip(b"=").decode()


def new_flow(
    now: datetime, *, next_path: str, redirect: str, invitation: str | None = None, user_id: int | None = None
) -> Flow:
    """Begin an attempt."""
    state, nonce, verifier = (secrets.token_urlsafe(32) for _ in range(3))
    expires = (now + LIFETIME).timestamp()
    return Flow(state, nonce, verifier, expires, next_path, redirect, invitation, user_id)


def require_state(flow: Flow, state: str) -> None:
    """Refuse an answer to another question.

    Raises:
        Unauthenticated: When the provider's answer isn't to this flow.
    """
    if not hmac.compare_digest(flow.state.encode(), state.encode()):
        raise not_begun()


def not_begun() -> Unauthenticated:
    """Return the error of an answer that no flow of this browser belongs to."""
    return Unauthenticated(
        "this browser didn't begin to sign in here, or too long ago", where="state", hint="sign in once more"
    )
