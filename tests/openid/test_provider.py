"""What a provider tells of itself, its keys that change, and codes that it is asked about."""

from __future__ import annotations

import base64
import socket
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime
from typing import Any
from urllib.parse import parse_qs, urlsplit

import pytest
from joserfc import jwt
from joserfc.jwk import RSAKey

from app.errors import InvalidInput, Unauthenticated, Unavailable
from app.openid.flow import Flow, new_flow
from app.openid.provider import FAILED_FOR, ClientRegistration, Provider

REDIRECT = "https://lines.example.org/api/session/openid/callback"


@pytest.fixture
def provider(small_provider: Any) -> Iterator[Provider]:
    provider = Provider(ClientRegistration(small_provider.issuer, "clearlines", "a secret:/+"))
    yield provider
    provider.close()


@pytest.fixture
def flow(now: datetime) -> Flow:
    return new_flow(now, next_path="/", redirect=REDIRECT)


def token(issuer: str, flow: Flow, key: RSAKey, now: datetime, **more: Any) -> dict[str, Any]:
    seconds = int(now.timestamp())
    claims = {"iss": issuer, "aud": "clearlines", "sub": "alice-1", "nonce": flow.nonce, "iat": seconds}
    text = jwt.encode({"alg": "RS256", "kid": key.kid}, {**claims, "exp": seconds + 300, **more}, key)
    return {"id_token": text, "access_token": "to ask more", "token_type": "Bearer"}


def test_the_browser_is_sent_with_state_nonce_and_the_challenge_of_pkce(
    provider: Provider, small_provider: Any, flow: Flow
) -> None:
    address = urlsplit(provider.address_for(flow))
    assert f"{address.scheme}://{address.netloc}" == small_provider.issuer
    asked = {name: values[0] for name, values in parse_qs(address.query).items()}
    assert asked == {
        "tenant": "1",
        "response_type": "code",
        "client_id": "clearlines",
        "redirect_uri": REDIRECT,
        "scope": "openid profile email",
        "state": flow.state,
        "nonce": flow.nonce,
        "code_challenge": flow.challenge,
        "code_challenge_method": "S256",
    }
    assert flow.verifier not in address.query


def test_the_challenge_is_that_of_the_example_in_rfc_7636() -> None:
    flow = Flow("", "", "dBjftJeZ4CVP-mB92K27uhbUJU1p1r_wW1gFWFOEjXk", 0.0, "/", REDIRECT)
    assert flow.challenge == "E9Melhoa2OwvFrEMTJguCHaoeK1t8URWbuGJSstw-cM"


def test_a_code_is_exchanged_with_the_verifier_and_our_secret(
    provider: Provider, small_provider: Any, flow: Flow, key: RSAKey, now: datetime
) -> None:
    small_provider.answer = (200, token(small_provider.issuer, flow, key, now, preferred_username="Alice"))
    assert provider.identify(flow, "the code", now).name == "Alice"
    (form,) = small_provider.forms
    assert form["code_verifier"] == [flow.verifier]
    assert form["redirect_uri"] == [REDIRECT]
    assert base64.b64decode(form["authorization"][0].split()[1]) == b"clearlines:a%20secret%3A%2F%2B"


def test_what_it_tells_of_itself_is_asked_once(
    provider: Provider, small_provider: Any, flow: Flow, key: RSAKey, now: datetime
) -> None:
    small_provider.answer = (200, token(small_provider.issuer, flow, key, now, name="Alice"))
    for _ in range(3):
        provider.identify(flow, "code", now)
    assert small_provider.asked == ["/.well-known/openid-configuration", "/keys"]


def test_a_key_that_is_new_is_fetched_and_one_that_is_gone_no_longer_good(
    provider: Provider, small_provider: Any, flow: Flow, key: RSAKey, other_key: RSAKey, now: datetime
) -> None:
    small_provider.answer = (200, token(small_provider.issuer, flow, key, now, name="Alice"))
    provider.identify(flow, "code", now)
    small_provider.keys = [other_key]
    small_provider.answer = (200, token(small_provider.issuer, flow, other_key, now, name="Alice"))
    assert provider.identify(flow, "code", now).subject == "alice-1"
    small_provider.answer = (200, token(small_provider.issuer, flow, key, now, name="Alice"))
    with pytest.raises(Unauthenticated, match="signature"):
        provider.identify(flow, "code", now)


def test_name_and_email_are_asked_for_where_the_token_leaves_them_out(
    provider: Provider, small_provider: Any, flow: Flow, key: RSAKey, now: datetime
) -> None:
    small_provider.told = {"userinfo_endpoint": f"{small_provider.issuer}/person"}
    small_provider.answer = (200, token(small_provider.issuer, flow, key, now))
    small_provider.person = {"sub": "alice-1", "name": "Alice", "email": "a@example.org", "email_verified": True}
    found = provider.identify(flow, "code", now)
    assert (found.name, found.email) == ("Alice", "a@example.org")
    small_provider.person = {"sub": "mallory", "name": "Mallory"}
    assert provider.identify(flow, "code", now).name is None


def test_a_provider_that_is_down_is_not_asked_again_at_once(small_provider: Any, flow: Flow) -> None:
    seconds = 0.0
    provider = Provider(ClientRegistration(small_provider.issuer, "c", "s"), clock=lambda: seconds)
    small_provider.told = {"issuer": "https://another.example"}
    for _ in range(3):
        with pytest.raises(Unavailable, match="calls itself otherwise"):
            provider.address_for(flow)
    assert len(small_provider.asked) == 1
    small_provider.told = {}
    seconds = FAILED_FOR
    assert provider.address_for(flow).startswith(small_provider.issuer)
    provider.close()


def test_while_one_waits_for_a_provider_that_hangs_the_others_are_told(
    flow: Flow, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.openid.provider.PATIENCE", 0.01)
    with socket.create_server(("127.0.0.1", 0)) as silent, ThreadPoolExecutor(1) as pool:
        provider = Provider(ClientRegistration(f"http://127.0.0.1:{silent.getsockname()[1]}", "c", "s"))
        first = pool.submit(provider.address_for, flow)
        asking, _ = silent.accept()
        with pytest.raises(Unavailable, match="doesn't answer"):
            provider.address_for(flow)
        assert not first.done()
        asking.close()
        with pytest.raises(Unavailable, match="can't be reached"):
            first.result()
        provider.close()


@pytest.mark.parametrize(
    ("answer", "error"),
    [
        ((400, {"error": "invalid_grant"}), Unauthenticated),
        ((401, {}), Unauthenticated),
        ((500, {}), Unavailable),
        ((302, {}), Unavailable),
        ((200, {}), Unavailable),
        ((200, {"id_token": 5}), Unavailable),
        ((200, {"id_token": "x" * 2**21}), Unavailable),
    ],
    ids=["used", "refused", "broken", "elsewhere", "nothing", "number", "endless"],
)
def test_another_answer_lets_nobody_in(
    provider: Provider, small_provider: Any, flow: Flow, now: datetime, answer: Any, error: type[Exception]
) -> None:
    small_provider.answer = answer
    with pytest.raises(error):
        provider.identify(flow, "code", now)


def test_one_that_calls_itself_otherwise_is_not_asked_further(
    provider: Provider, small_provider: Any, flow: Flow
) -> None:
    small_provider.told = {"issuer": "https://evil.example"}
    with pytest.raises(Unavailable, match="otherwise"):
        provider.address_for(flow)


def test_one_that_nobody_answers_for_is_told(flow: Flow) -> None:
    provider = Provider(ClientRegistration("http://127.0.0.1:9", "clearlines", "secret"))
    with pytest.raises(Unavailable, match="reached"):
        provider.address_for(flow)
    provider.close()


@pytest.mark.parametrize("issuer", ["http://id.example.org", "ftp://127.0.0.1", "id.example.org", ""])
def test_one_without_tls_is_taken_on_this_machine_alone(issuer: str) -> None:
    with pytest.raises(InvalidInput, match="TLS"):
        Provider(ClientRegistration(issuer, "clearlines", "secret"))
