"""How often one may ask: counted by account and address, told in each answer, refused with when to try again."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.api.throttle import Throttle, client_address
from app.errors import InvalidInput, TooMany, Unauthenticated
from app.settings import Settings
from tests.api.hosting.conftest import HOME, Serve, token_for


def hosted_settings(**given: Any) -> Settings:
    return Settings(data_dir=Path("nowhere"), public_url=HOME, **given)


def fail(throttle: Throttle, account: str | None, address: str) -> None:
    with pytest.raises(Unauthenticated), throttle.signing_in(account, address):
        raise Unauthenticated("no")


def test_failed_sign_ins_are_counted_by_account_and_by_address() -> None:
    failures: list[int] = []
    throttle = Throttle(hosted_settings(sign_in_limit="2/minute"), on_failure=lambda: failures.append(1))
    fail(throttle, "Ada", "192.0.2.1")
    fail(throttle, "ADA", "192.0.2.2")
    with pytest.raises(TooMany, match="sign-ins") as refused, throttle.signing_in("ada", "192.0.2.3"):
        pytest.fail("it was looked at")
    assert 0 < refused.value.details["retry_after"] <= 60
    fail(throttle, "bob", "192.0.2.1")
    with pytest.raises(TooMany), throttle.signing_in("carol", "192.0.2.1"):
        pytest.fail("it was looked at")
    with throttle.signing_in("carol", "192.0.2.9"):
        pass
    assert len(failures) == 3


def test_a_stranger_keeps_nobody_out_who_was_there_before() -> None:
    throttle = Throttle(hosted_settings(sign_in_limit="1/minute"))
    fail(throttle, "ada", "192.0.2.1")
    with throttle.signing_in("ada", "192.0.2.2", is_known=True):
        pass
    with pytest.raises(Unauthenticated), throttle.signing_in("ada", "192.0.2.2", is_known=True):
        raise Unauthenticated("no")
    with pytest.raises(TooMany), throttle.signing_in("ada", "192.0.2.2", is_known=True):
        pytest.fail("it was looked at")


def test_what_succeeds_or_fails_otherwise_is_not_counted() -> None:
    throttle = Throttle(hosted_settings(sign_in_limit="1/minute"))
    for _ in range(3):
        with throttle.signing_in("ada", "192.0.2.1"):
            pass
        with pytest.raises(ValueError, match="else"), throttle.signing_in("ada", "192.0.2.1"):
            raise ValueError("something else")


def test_guesses_sent_at_once_are_no_more_than_those_sent_one_by_one() -> None:
    throttle = Throttle(hosted_settings(sign_in_limit="3/minute"))
    looked_at: list[int] = []
    refused = threading.Semaphore(0)
    go_on = threading.Event()

    def look() -> None:
        looked_at.append(1)
        go_on.wait(30)
        raise Unauthenticated("no")

    def guess() -> None:
        try:
            with throttle.signing_in("ada", "192.0.2.1"):
                look()
        except Unauthenticated:
            pass
        except TooMany:
            refused.release()

    threads = [threading.Thread(target=guess) for _ in range(8)]
    for thread in threads:
        thread.start()
    assert all(refused.acquire(timeout=30) for _ in range(5))
    go_on.set()
    for thread in threads:
        thread.join(30)
    assert len(looked_at) == 3


def test_in_local_mode_nothing_is_counted() -> None:
    throttle = Throttle(Settings(sign_in_limit="1/minute", request_limit="1/minute", upload_limit="1/minute"))
    for _ in range(3):
        fail(throttle, "ada", "127.0.0.1")
        assert throttle.request("a") is None
        assert throttle.upload("a") is None
        throttle.refused("a")
        throttle.require_known("a")


def test_where_accounts_are_required_wrong_passwords_are_counted_on_a_loopback_address_too() -> None:
    throttle = Throttle(Settings(anonymous_role="reader", sign_in_limit="1/minute"))
    fail(throttle, "ada", "192.0.2.1")
    with pytest.raises(TooMany), throttle.signing_in("ada", "192.0.2.2"):
        pytest.fail("it was looked at")


def test_a_limit_that_cannot_be_read_names_its_setting() -> None:
    with pytest.raises(InvalidInput) as refused:
        Throttle(hosted_settings(upload_limit="often"))
    assert refused.value.where == "upload_limit: often"


@pytest.mark.parametrize(
    ("client", "address"),
    [
        (("192.0.2.1", 5), "192.0.2.1"),
        (("2001:db8:1:2:3:4:5:6", 5), "2001:db8:1:2::/64"),
        (("::ffff:192.0.2.1", 5), "192.0.2.1"),
        (("fe80::1%eth0", 5), "fe80::/64"),
        (("testclient", 5), "testclient"),
        (None, "unknown"),
    ],
)
def test_an_address_is_that_of_a_customer(client: Any, address: str) -> None:
    assert client_address({"client": client}) == address


@pytest.fixture(scope="module")
def strict(serve: Serve) -> TestClient:
    return serve(request_limit="4/minute;1000/hour", upload_limit="1/hour")


def test_each_answer_tells_how_many_are_left_and_the_last_when_to_ask_again(strict: TestClient) -> None:
    ada = token_for(strict, "ada", "maintainer")
    left = [strict.get("/api/me", headers=ada).headers["ratelimit"].partition(";")[2] for _ in range(4)]
    assert [part.partition(";")[0] for part in left] == ["r=3", "r=2", "r=1", "r=0"]
    refused = strict.get("/api/me", headers=ada)
    assert refused.status_code == 429
    assert refused.headers["content-type"] == "application/problem+json"
    assert refused.json()["code"] == "too-many"
    assert 0 < int(refused.headers["retry-after"]) <= 60
    bob = token_for(strict, "bob", "reader")
    assert strict.get("/api/me", headers=bob).headers["ratelimit-policy"] == '"requests";q=4;w=60'
    assert "ratelimit" not in strict.get("/api/health").headers
    for _ in range(6):
        assert strict.get("/api/health", headers=ada).status_code == 200


def test_uploads_have_a_limit_of_their_own(strict: TestClient) -> None:
    carol = token_for(strict, "carol", "maintainer")
    strict.post("/api/datasets", json={"name": "carol's"}, headers=carol)
    statuses = [
        strict.post("/api/datasets/carol-s/images", files=[("files", ("a.png", b"0"))], headers=carol).status_code
        for _ in range(2)
    ]
    assert statuses[0] != 429
    assert statuses[1] == 429


def test_who_sends_tokens_that_are_not_good_is_not_looked_at_for_a_while(serve: Serve) -> None:
    client = serve(request_limit="3/minute")
    wrong = {"authorization": "Bearer cl_guessed"}
    assert [client.get("/api/me", headers=wrong).status_code for _ in range(4)] == [401, 401, 401, 429]
    assert client.get("/api/health").status_code == 200
