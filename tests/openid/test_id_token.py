"""Identity tokens: the one that is good is taken, and each that could be somebody else's is refused."""

from __future__ import annotations

import base64
import hmac
import json
from datetime import datetime
from typing import Any

import pytest
from joserfc import jwt
from joserfc.jwk import KeySet, RSAKey

from app.errors import Unauthenticated
from app.openid.id_token import Expected, identified_by

ISSUER = "https://id.example.org"
EXPECTED = Expected(ISSUER, "clearlines", "the nonce")


def claims_of(now: datetime, **changed: Any) -> dict[str, Any]:
    seconds = int(now.timestamp())
    good = {
        "iss": ISSUER,
        "aud": "clearlines",
        "sub": "alice-1",
        "nonce": "the nonce",
        "iat": seconds,
        "exp": seconds + 300,
    }
    return {name: value for name, value in {**good, **changed}.items() if value is not None}


def signed(claims: dict[str, Any], key: RSAKey) -> str:
    return jwt.encode({"alg": "RS256", "kid": key.kid}, claims, key)


def test_a_good_token_tells_who_it_is(key: RSAKey, now: datetime) -> None:
    told = {"preferred_username": "Alice", "email": "alice@example.org", "email_verified": True}
    found = identified_by(signed(claims_of(now, **told), key), KeySet([key]), EXPECTED, now)
    assert (found.issuer, found.subject, found.name) == (ISSUER, "alice-1", "Alice")
    assert found.email == "alice@example.org"


@pytest.mark.parametrize("verified", [False, None, "true"])
def test_an_email_that_the_provider_has_not_verified_is_nobody_s(key: RSAKey, now: datetime, verified: Any) -> None:
    claims = claims_of(now, email="alice@example.org", email_verified=verified)
    found = identified_by(signed(claims, key), KeySet([key]), EXPECTED, now)
    assert found.email is None
    assert found.name == "alice"


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"nonce": "another nonce"}, "answers another request"),
        ({"nonce": None}, "answers another request"),
        ({"nonce": 5}, "answers another request"),
        ({"iss": "https://evil.example"}, "another provider made it"),
        ({"iss": f"{ISSUER}/"}, "another provider made it"),
        ({"aud": "another service"}, "made for another service"),
        ({"aud": []}, "made for another service"),
        ({"aud": None}, "made for another service"),
        ({"aud": ["clearlines", "another service"]}, "made for another service"),
        ({"aud": ["clearlines", "another service"], "azp": "another service"}, "made for another service"),
        ({"azp": "another service"}, "made for another service"),
        ({"exp": None}, "exp is missing"),
        ({"exp": "tomorrow"}, "exp is missing"),
        ({"exp": True}, "exp is missing"),
        ({"iat": None}, "iat is missing"),
        ({"sub": None}, "names nobody"),
        ({"sub": ""}, "names nobody"),
        ({"sub": "x" * 256}, "names nobody"),
    ],
)
def test_a_token_that_says_something_else_is_refused(
    key: RSAKey, now: datetime, changed: dict[str, Any], reason: str
) -> None:
    with pytest.raises(Unauthenticated, match=reason):
        identified_by(signed(claims_of(now, **changed), key), KeySet([key]), EXPECTED, now)


@pytest.mark.parametrize(
    ("seconds", "good"), [(-59, True), (-60, False), (-3600, False), (300, True)], ids=["leeway", "over", "old", "new"]
)
def test_a_token_is_good_until_it_expires_and_a_minute_more(
    key: RSAKey, now: datetime, seconds: int, good: bool
) -> None:
    text = signed(claims_of(now, exp=int(now.timestamp()) + seconds), key)
    if good:
        assert identified_by(text, KeySet([key]), EXPECTED, now).subject == "alice-1"
    else:
        with pytest.raises(Unauthenticated, match="expired"):
            identified_by(text, KeySet([key]), EXPECTED, now)


def test_a_token_of_the_future_is_refused(key: RSAKey, now: datetime) -> None:
    with pytest.raises(Unauthenticated, match="another time"):
        identified_by(signed(claims_of(now, iat=int(now.timestamp()) + 61), key), KeySet([key]), EXPECTED, now)


def encoded(content: dict[str, Any]) -> str:
    return base64.urlsafe_b64encode(json.dumps(content).encode()).rstrip(b"=").decode()


def test_a_token_without_signature_is_refused(key: RSAKey, now: datetime) -> None:
    for header in ({"alg": "none"}, {"alg": "None", "kid": key.kid}, {"kid": key.kid}):
        with pytest.raises(Unauthenticated, match="signature"):
            identified_by(f"{encoded(header)}.{encoded(claims_of(now))}.", KeySet([key]), EXPECTED, now)


def test_a_token_signed_with_the_public_key_as_if_it_were_a_secret_is_refused(key: RSAKey, now: datetime) -> None:
    unsigned = f"{encoded({'alg': 'HS256', 'kid': key.kid})}.{encoded(claims_of(now))}"
    digest = hmac.digest(key.as_pem(private=False), unsigned.encode(), "sha256")
    text = f"{unsigned}.{base64.urlsafe_b64encode(digest).rstrip(b'=').decode()}"
    expected = Expected(ISSUER, "clearlines", "the nonce", ("RS256", "HS256", "none"))
    with pytest.raises(Unauthenticated, match="signature"):
        identified_by(text, KeySet([key]), expected, now)


def test_a_token_signed_by_somebody_else_is_refused(key: RSAKey, other_key: RSAKey, now: datetime) -> None:
    mine = signed(claims_of(now), other_key)
    with pytest.raises(Unauthenticated, match="signature"):
        identified_by(mine, KeySet([key]), EXPECTED, now)
    as_if = jwt.encode({"alg": "RS256", "kid": key.kid}, claims_of(now), other_key)
    with pytest.raises(Unauthenticated, match="signature"):
        identified_by(as_if, KeySet([key]), EXPECTED, now)


def test_a_token_that_was_changed_is_refused(key: RSAKey, now: datetime) -> None:
    head, _, signature = signed(claims_of(now), key).split(".")
    with pytest.raises(Unauthenticated, match="signature"):
        identified_by(f"{head}.{encoded(claims_of(now, sub='bob'))}.{signature}", KeySet([key]), EXPECTED, now)


@pytest.mark.parametrize("text", ["", "a", "a.b", "a.b.c", "....", "é.é.é"])
def test_what_is_no_token_is_refused(key: RSAKey, now: datetime, text: str) -> None:
    with pytest.raises(Unauthenticated, match="signature"):
        identified_by(text, KeySet([key]), EXPECTED, now)
