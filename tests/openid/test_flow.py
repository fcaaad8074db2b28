"""Flows: sealed in the browser, bound to it, good for one answer."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest

from app.api.own_paths import own_path
from app.errors import Unauthenticated
from app.openid.flow import Flow, new_flow
from app.openid.provider import ClientRegistration, Provider
from app.openid.sealing import LONGEST, seal, sealing_key, unseal
from app.openid.sign_in import OpenIdSignIn

KEY = sealing_key("secret")


@pytest.fixture
def flow(now: datetime) -> Flow:
    return new_flow(now, next_path="/datasets", redirect="https://a/b", invitation="an invitation", user_id=5)


def sign_in() -> OpenIdSignIn:
    return OpenIdSignIn("Example", Provider(ClientRegistration("https://id.example.org", "clearlines", "secret")))


def test_a_flow_comes_back_whole_and_nothing_of_it_can_be_read(flow: Flow, now: datetime) -> None:
    text = seal(flow, KEY)
    assert unseal(text, KEY, now) == flow
    assert "an invitation" not in text
    assert flow.verifier not in text


def test_the_longest_flow_fits_into_a_cookie(now: datetime) -> None:
    redirect = f"https://{'lines.' * 20}example.org/api/session/openid/callback"
    flow = new_flow(now, next_path="/" + "a" * 1999, redirect=redirect, invitation="i" * 43, user_id=5)
    assert own_path(flow.next) == flow.next
    text = seal(flow, KEY)
    assert len(text) < LONGEST
    assert unseal(text, KEY, now) == flow


def test_no_two_flows_have_anything_in_common(now: datetime, flow: Flow) -> None:
    other = new_flow(now, next_path="/", redirect="https://a/b")
    assert len({flow.state, flow.nonce, flow.verifier, other.state, other.nonce, other.verifier}) == 6


def test_another_server_that_knows_the_secret_opens_it_and_nobody_else_does(flow: Flow, now: datetime) -> None:
    assert unseal(seal(flow, KEY), sealing_key("secret"), now) == flow
    with pytest.raises(Unauthenticated):
        unseal(seal(flow, sealing_key("another")), KEY, now)


@pytest.mark.parametrize("text", ["", "a.b.c.d.e", "x" * 5000, "é", "eyJhbGciOiJub25lIn0.."])
def test_what_is_no_sealed_flow_is_refused(text: str, now: datetime) -> None:
    with pytest.raises(Unauthenticated):
        unseal(text, KEY, now)


def test_a_flow_that_was_changed_is_refused(flow: Flow, now: datetime) -> None:
    text = seal(flow, KEY)
    for place in (5, len(text) // 2, len(text) - 3):
        changed = text[:place] + ("A" if text[place] != "A" else "B") + text[place + 1 :]
        with pytest.raises(Unauthenticated):
            unseal(changed, KEY, now)


def test_a_flow_is_good_for_ten_minutes(flow: Flow, now: datetime) -> None:
    text = seal(flow, KEY)
    assert unseal(text, KEY, now + timedelta(minutes=10) - timedelta(seconds=1)) == flow
    with pytest.raises(Unauthenticated):
        unseal(text, KEY, now + timedelta(minutes=10))


def test_an_answer_is_taken_once_by_the_browser_that_asked(flow: Flow, now: datetime) -> None:
    server = sign_in()
    kept = seal(flow, KEY)
    with pytest.raises(Unauthenticated, match="didn't begin"):
        server.flow_of(kept, "another state", now)
    with pytest.raises(Unauthenticated, match="didn't begin"):
        server.flow_of("", flow.state, now)
    assert server.flow_of(kept, flow.state, now) == flow
    with pytest.raises(Unauthenticated, match="used already"):
        server.flow_of(kept, flow.state, now)


def test_an_answer_of_another_provider_is_refused(flow: Flow, now: datetime) -> None:
    with pytest.raises(Unauthenticated, match="another provider"):
        sign_in().identify(flow, "code", "https://evil.example", now)
