"""The account page: password, sessions, tokens of one's own; and accounts as admins look after them."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest

from app.services.tokens import create_token

Place = Any
PASSWORD = "seven grey herons"
OTHER = "nine brown otters"


def test_an_account_is_its_holder_s(place: Place) -> None:
    place.add("ada", "submitter")
    browser = place.browser("ada")
    account = browser.get("/api/account").json()
    assert (account["name"], account["email"], account["has_password"]) == ("ada", None, True)
    assert browser.patch("/api/account", json={"email": " ada@example.org "}).json()["email"] == "ada@example.org"
    assert browser.patch("/api/account", json={}).json()["email"] == "ada@example.org"
    assert browser.patch("/api/account", json={"email": "nobody"}).status_code == 422
    assert browser.patch("/api/account", json={"email": None}).json()["email"] is None
    assert browser.patch("/api/account", json={"role": "admin"}).status_code == 422


def test_a_new_password_needs_the_old_one_and_signs_the_other_browsers_out(place: Place) -> None:
    place.add("bea", "reader")
    here, there = place.browser("bea"), place.browser("bea")
    for change in (
        {"new": OTHER},
        {"current": "wrong", "new": OTHER},
        {"current": PASSWORD, "new": "short"},
        {"current": PASSWORD, "new": "password123"},
    ):
        refused = here.post("/api/account/password", json=change)
        assert refused.status_code == 422
        assert PASSWORD not in refused.text
    assert there.get("/api/me").status_code == 200
    assert here.post("/api/account/password", json={"current": PASSWORD, "new": OTHER}).status_code == 204
    assert here.get("/api/me").json()["name"] == "bea"
    assert there.get("/api/me").status_code == 401
    assert place.browser().post("/api/session", json={"name": "bea", "password": PASSWORD}).status_code == 401
    assert place.browser("bea", OTHER).get("/api/me").json()["name"] == "bea"
    assert place.told("user.password_changed")[-1][0] == "bea"


def test_who_has_no_password_yet_chooses_one_without(place: Place) -> None:
    place.add("cleo", "reader")
    browser = place.browser("cleo")
    place.add("dora", "reader", password_hash=None)
    link = place.browser("admin").post(f"/api/users/{place.users['cleo']}/reset").json()
    assert link["address"] == f"http://127.0.0.1:8765/invitation#{link['secret']}"
    assert browser.get("/api/account").json()["has_password"]
    users = {user["name"]: user for user in place.browser("admin").get("/api/users").json()}
    assert (users["cleo"]["has_password"], users["dora"]["has_password"]) == (True, False)


def test_sessions_are_shown_and_ended_one_by_one(place: Place) -> None:
    place.add("eda", "reader")
    here, there = place.browser("eda"), place.browser("eda", agent="Lynx")
    shown = here.get("/api/account/sessions").json()
    assert [(row["agent"], row["address"], row["current"]) for row in shown] == [
        ("Lynx", "testclient", False),
        ("Firefox", "testclient", True),
    ]
    other = place.browser("admin")
    assert other.delete(f"/api/account/sessions/{shown[0]['id']}").status_code == 404
    assert there.get("/api/me").status_code == 200
    assert here.delete(f"/api/account/sessions/{shown[0]['id']}").status_code == 204
    assert there.get("/api/me").status_code == 401
    assert here.delete(f"/api/account/sessions/{shown[0]['id']}").status_code == 404
    assert place.told("session.revoked")[-1][0] == "eda"
    own = here.delete(f"/api/account/sessions/{shown[1]['id']}")
    assert own.status_code == 204
    assert 'clearlines_session=""' in own.headers["set-cookie"]
    assert here.get("/api/me").json()["anonymous"]


def test_a_token_of_one_s_own_is_shown_once_and_may_no_more_than_its_holder(place: Place) -> None:
    person = place.add("fay", "annotator")
    browser = place.browser("fay")
    made = browser.post("/api/account/tokens", json={"label": "cluster", "days": 30}).json()
    program = place.program(made["token"])
    me = program.get("/api/me").json()
    assert (me["name"], me["role"], me["account"]["role"]) == ("fay", "annotator", "annotator")
    assert browser.post("/api/account/tokens", json={"label": "more", "role": "admin"}).status_code == 403
    assert browser.post("/api/account/tokens", json={"label": "cluster"}).status_code == 409
    (shown,) = browser.get("/api/account/tokens").json()
    assert shown == {key: value for key, value in made.items() if key != "token"} | {
        "last_used_at": shown["last_used_at"]
    }
    assert shown["last_used_at"] is not None
    place.browser("admin").patch(f"/api/users/{person}", json={"role": "reader"})
    assert program.get("/api/me").json()["role"] == "reader"
    assert place.browser("reader").delete(f"/api/account/tokens/{made['id']}").status_code == 404
    assert browser.delete(f"/api/account/tokens/{made['id']}").status_code == 204
    assert program.get("/api/me").status_code == 401
    place.later = timedelta(days=1)
    again = place.program(browser.post("/api/account/tokens", json={"label": "cluster", "days": 1}).json()["token"])
    assert again.get("/api/me").status_code == 200
    place.later = timedelta(days=2.1)
    assert again.get("/api/me").status_code == 401


def test_a_token_looks_at_its_account_and_changes_nothing_but_what_it_ends(place: Place) -> None:
    """Whoever finds a token mustn't make another one of it that stays."""
    place.add("gus", "admin")
    made = place.browser("gus").post("/api/account/tokens", json={"label": "lost"}).json()
    program = place.program(made["token"])
    assert program.get("/api/account").json()["name"] == "gus"
    for method, address, given in (
        ("POST", "/api/account/tokens", {"label": "found"}),
        ("POST", "/api/account/password", {"current": PASSWORD, "new": OTHER}),
        ("PATCH", "/api/account", {"email": "x@example.org"}),
    ):
        assert program.request(method, address, json=given).status_code == 403
    assert program.delete(f"/api/account/tokens/{made['id']}").status_code == 204


def test_who_has_no_account_is_told_so(place: Place) -> None:
    with place.server.database.write() as session:
        service = place.program(create_token(session, "service", "admin", place.now(), person=None).text)
    for address in ("/api/account", "/api/account/sessions", "/api/account/tokens"):
        assert place.browser().get(address).status_code == 401
        assert service.get(address).status_code == 404
    assert service.get("/api/me").json()["account"] is None


def test_admins_see_accounts_and_tokens_and_no_secrets(place: Place) -> None:
    place.add("hal", "submitter")
    token = place.browser("hal").post("/api/account/tokens", json={"label": "x"}).json()["token"]
    admin = place.browser("admin")
    users, tokens = admin.get("/api/users"), admin.get("/api/users/tokens")
    hal = next(user for user in users.json() if user["name"] == "hal")
    assert (hal["role"], hal["created_by"], hal["disabled_at"]) == ("submitter", "rita", None)
    assert hal["last_seen_at"] is not None
    (row,) = [each for each in tokens.json() if each["name"] == "hal"]
    assert (row["label"], row["user_id"], row["revoked_at"]) == ("x", place.users["hal"], None)
    assert token not in tokens.text
    assert "argon2" not in users.text + tokens.text
    assert admin.delete(f"/api/users/tokens/{row['id']}").status_code == 204
    assert place.program(token).get("/api/me").status_code == 401
    assert admin.delete(f"/api/users/tokens/{row['id']}").status_code == 404


def test_the_last_admin_can_be_neither_lowered_nor_disabled(place: Place) -> None:
    admin, person = place.browser("admin"), place.users["admin"]
    for user in admin.get("/api/users").json():
        if user["role"] == "admin" and user["id"] != person:
            assert admin.patch(f"/api/users/{user['id']}", json={"disabled": True}).status_code == 200
    for change in ({"role": "maintainer"}, {"disabled": True}):
        assert admin.patch(f"/api/users/{person}", json=change).status_code == 409
    assert admin.get("/api/me").json()["role"] == "admin"
    assert admin.patch("/api/users/999999", json={"role": "reader"}).status_code == 404


@pytest.mark.parametrize("change", [{"role": "king"}, {"name": "x"}, {"email": "x"}])
def test_what_can_t_be_changed_of_an_account(place: Place, change: Any) -> None:
    assert place.browser("admin").patch(f"/api/users/{place.users['reader']}", json=change).status_code == 422


def test_the_audit_says_who_did_what_from_where(place: Place) -> None:
    admin = place.browser("admin")
    person = place.add("ivy", "reader")
    admin.patch(f"/api/users/{person}", json={"role": "submitter"})
    page = admin.get("/api/audit", params={"kind": "user.role", "person": "admin", "limit": 1}).json()
    (line,) = page["items"]
    assert (line["kind"], line["person"], line["address"]) == ("user.role_changed", "admin", "testclient")
    assert line["details"] == {"name": "ivy", "before": "reader", "role": "submitter"}
    whole = admin.get("/api/audit", params={"limit": 2}).json()
    after = admin.get("/api/audit", params={"limit": 2, "cursor": whole["next_cursor"]}).json()
    times = [entry["created_at"] for entry in (*whole["items"], *after["items"])]
    assert times == sorted(times, reverse=True)
    assert len({entry["id"] for entry in (*whole["items"], *after["items"])}) == 4
    assert admin.get("/api/audit", params={"dataset": "nope"}).status_code == 404
    assert admin.get("/api/audit", params={"since": "2025-01-01T00:00:00"}).status_code == 422
    assert admin.get("/api/audit", params={"since": "2525-01-01T00:00:00Z"}).json()["items"] == []
