"""Invitations and reset links as browsers use them."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

from app.api.cookies import SESSION_COOKIE

Place = Any
PASSWORD = "nine brown otters"


def test_an_invitation_leads_to_an_account_that_is_signed_in(place: Place) -> None:
    admin, guest = place.browser("admin"), place.browser()
    made = admin.post("/api/invitations", json={"role": "annotator"}).json()
    assert made["address"] == f"http://127.0.0.1:8765/invitation#{made['secret']}"
    seen = guest.post("/api/invitations/look", json={"secret": made["secret"]}).json()
    assert (seen["kind"], seen["role"], seen["name"]) == ("join", "annotator", None)
    accepted = guest.post(
        "/api/invitations/accept", json={"secret": made["secret"], "name": "Noa", "password": PASSWORD}
    )
    assert (accepted.json()["name"], accepted.json()["role"]) == ("Noa", "annotator")
    assert all(word in accepted.headers["set-cookie"] for word in (SESSION_COOKIE, "HttpOnly", "SameSite=strict"))
    assert guest.get("/api/me").json()["name"] == "Noa"
    assert guest.post("/api/invitations/look", json={"secret": made["secret"]}).status_code == 404
    (row,) = [row for row in admin.get("/api/invitations").json() if row["id"] == made["id"]]
    assert (row["kind"], row["created_by"], row["user_id"]) == ("join", "admin", accepted.json()["account"]["id"])
    assert row["used_at"] is not None
    assert made["secret"] not in admin.get("/api/invitations").text
    told = [person for person, _, details in place.told("invitation.used") if details["invitation"] == made["id"]]
    assert told == ["Noa"]


def test_unknown_expired_revoked_and_used_ones_answer_the_same(place: Place) -> None:
    admin, guest = place.browser("admin"), place.browser()
    secrets = [admin.post("/api/invitations", json={"role": "reader", "days": 2}).json() for _ in range(2)]
    assert admin.delete(f"/api/invitations/{secrets[0]['id']}").status_code == 204
    assert admin.delete(f"/api/invitations/{secrets[0]['id']}").status_code == 404
    used = admin.post("/api/invitations", json={"role": "reader", "name": "Otis"}).json()
    given = {"secret": used["secret"], "password": PASSWORD}
    assert place.browser().post("/api/invitations/accept", json=given).json()["name"] == "Otis"
    place.later = timedelta(days=2.1)
    answers = set()
    for secret in ("x", *(each["secret"] for each in (*secrets, used))):
        looked = guest.post("/api/invitations/look", json={"secret": secret})
        accepted = guest.post("/api/invitations/accept", json={"secret": secret, "name": "P", "password": PASSWORD})
        answers |= {(looked.status_code, looked.text), (accepted.status_code, accepted.text)}
    assert len(answers) == 1


def test_a_reset_link_chooses_a_password_and_signs_everybody_else_out(place: Place) -> None:
    person = place.add("quin", "submitter")
    browser = place.browser("quin")
    link = place.browser("admin").post(f"/api/users/{person}/reset").json()
    seen = place.browser().post("/api/invitations/look", json={"secret": link["secret"]}).json()
    assert (seen["kind"], seen["name"]) == ("reset", "quin")
    fresh = place.browser()
    given = {"secret": link["secret"], "password": PASSWORD}
    assert fresh.post("/api/invitations/accept", json={**given, "password": "short"}).status_code == 422
    assert fresh.post("/api/invitations/accept", json=given).json()["name"] == "quin"
    assert browser.get("/api/me").status_code == 401
    assert place.browser("quin", PASSWORD).get("/api/me").json()["role"] == "submitter"


def test_a_cookie_that_is_no_longer_good_is_not_in_a_guest_s_way(place: Place) -> None:
    guest = place.browser("reader")
    place.later = timedelta(days=8)
    made = place.browser("admin").post("/api/invitations", json={"role": "reader"}).json()
    given = {"secret": made["secret"], "name": "Ruth", "password": PASSWORD}
    assert guest.post("/api/invitations/look", json={"secret": made["secret"]}).status_code == 200
    assert guest.post("/api/invitations/accept", json=given).json()["name"] == "Ruth"


def test_nobody_chooses_a_name_that_stands_for_somebody(place: Place) -> None:
    made = place.browser("admin").post("/api/invitations", json={"role": "reader"}).json()
    for name in ("ADMIN", "Owner"):
        given = {"secret": made["secret"], "name": name, "password": PASSWORD}
        assert place.browser().post("/api/invitations/accept", json=given).status_code == 409


def test_the_address_is_the_public_one_where_there_is_one(place: Place) -> None:
    admin = place.browser("admin")
    settings = place.server.settings.model_copy(update={"public_url": "https://lines.example.org/"})
    place.change_server(settings=settings)
    made = admin.post("/api/invitations", json={"role": "reader"}).json()
    assert made["address"] == f"https://lines.example.org/invitation#{made['secret']}"
