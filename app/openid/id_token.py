"""Identity tokens: checked as OpenID Connect Core 1.0, section 3.1.3.7, says."""

from __future__ import annotations

import hmac
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from joserfc import jwt
from joserfc.errors import JoseError
from joserfc.jwk import KeySet

from app.errors import Unauthenticated
from app.openid.identified import Identified

ALGORITHMS = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "Ed25519", "EdDSA")
"""Signatures with a public key; none, and those with a shared secret, aren't among them."""
LEEWAY = 60.0
"""By how much clocks may differ, in s."""
LONGEST_SUBJECT = 255


@dataclass(frozen=True)
class Expected:
    """What an identity token must say.

    Attributes:
        issuer: Who made it.
        client_id: Whom it is for.
        nonce: What was asked with.
        algorithms: What it may be signed with.
    """

    issuer: str
    client_id: str
    nonce: str
    algorithms: Sequence[str] = ALGORITHMS


def identified_by(text: str, keys: KeySet, expected: Expected, now: datetime) -> Identified:
    """Return whom a token identifies.

    Args:
        text: The token.
        keys: The provider's.
        expected: What it must say.
        now: When.

    Raises:
        Unauthenticated: When it isn't signed by the provider, or was made for another one, another request or another
            time.
    """
    claims = _signed_claims(text, keys, [name for name in expected.algorithms if name in ALGORITHMS])
    _require(claims.get("iss") == expected.issuer, "another provider made it")
    audience = claims.get("aud")
    audiences = [audience] if isinstance(audience, str) else audience if isinstance(audience, list) else []
    _require(expected.client_id in audiences, "it was made for another service")
    is_only_ours = len(audiences) == 1 and "azp" not in claims
    _require(is_only_ours or claims.get("azp") == expected.client_id, "it was made for another service")
    time = now.timestamp()
    _require(_number(claims, "exp") > time - LEEWAY, "it has expired")
    _require(_number(claims, "iat") < time + LEEWAY, "it is of another time")
    nonce = claims.get("nonce")
    is_asked = isinstance(nonce, str) and hmac.compare_digest(nonce.encode(), expected.nonce.encode())
    _require(is_asked, "it answers another request")
    subject = claims.get("sub")
    _require(isinstance(subject, str) and 0 < len(subject) <= LONGEST_SUBJECT, "it names nobody")
    return Identified(expected.issuer, str(subject), name_of(claims), email_of(claims))


def _signed_claims(text: str, keys: KeySet, algorithms: list[str]) -> Mapping[str, Any]:
    try:
        return jwt.decode(text, keys, algorithms=algorithms).claims
    except (JoseError, ValueError) as error:
        raise _refusal("its signature is not the provider's") from error


def _require(is_so: bool, reason: str) -> None:
    if not is_so:
        raise _refusal(reason)


def _refusal(reason: str) -> Unauthenticated:
    return Unauthenticated(f"the provider's answer can't be trusted: {reason}", where="id_token", hint="sign in again")


def _number(claims: Mapping[str, Any], name: str) -> float:
    value = claims.get(name)
    _require(isinstance(value, (int, float)) and not isinstance(value, bool), f"{name} is missing")
    return float(value or 0)


def name_of(claims: Mapping[str, Any]) -> str | None:
    """Return the name to begin with; of an email the part before the @, as the rest is nobody's business."""
    for name in ("preferred_username", "name", "email"):
        value = claims.get(name)
        if isinstance(value, str) and (chosen := value.partition("@")[0].strip()):
            return chosen
    return None


def email_of(claims: Mapping[str, Any]) -> str | None:
    """Return the email where the provider has verified it."""
    email = claims.get("email")
    return email if isinstance(email, str) and claims.get("email_verified") is True else None
