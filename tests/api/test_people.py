"""Several people through the REST API: names, leases, stale verdicts, tasks, second opinions, statistics."""

from __future__ import annotations

import io
import uuid
import zipfile
from typing import Any
from urllib.parse import quote

import pytest
from fastapi.testclient import TestClient


def named(person: str) -> dict[str, str]:
    return {"X-ClearLines-Person": quote(person)}


def decision(segment_id: int, verdict: str, **fields: Any) -> dict[str, Any]:
    ids = {"client_id": str(uuid.uuid4()), "group_id": str(uuid.uuid4())}
    return {**ids, "segment_id": segment_id, "verdict": verdict, **fields}


def finish(client: TestClient, image_id: int, verdicts: list[str], person: str) -> list[int]:
    segments = [each["id"] for each in client.get(f"/api/images/{image_id}/segments").json()["segments"]]
    given = [decision(segment, verdicts[place % len(verdicts)]) for place, segment in enumerate(segments)]
    address = f"/api/images/{image_id}"
    assert client.post(f"{address}/decisions", json={"decisions": given}, headers=named(person)).status_code == 200
    assert client.put(f"{address}/review", json={"status": "done"}, headers=named(person)).status_code == 200
    return segments


@pytest.mark.parametrize("person", ["Mara", "Zoë Müller", "山田"])
def test_a_person_is_a_name_that_the_page_sends(client: TestClient, person: str) -> None:
    assert client.get("/api/me", headers=named(person)).json()["name"] == person
    assert client.get("/api/me").json()["name"] == "owner"


@pytest.mark.parametrize("header", ["", "%20", "x" * 81, "a%00b", "a%0Ab", "%ff", "a%E2%80%AEb", "M\xe4ra"])
def test_a_name_that_cannot_be_is_refused(client: TestClient, header: str) -> None:
    answer = client.get("/api/me", headers={b"X-ClearLines-Person": header.encode("latin-1")})
    assert (answer.status_code, answer.json()["where"]) == (422, "X-ClearLines-Person")


def test_a_token_keeps_its_name(client: TestClient) -> None:
    from app.clock import utc_now
    from app.services.tokens import create_token

    with client.app.state.server.database.write() as session:  # type: ignore[attr-defined]
        token = create_token(session, "Ann", "annotator", utc_now(), person=None).text
    headers = {"Authorization": f"Bearer {token}", **named("Mara")}
    assert client.get("/api/me", headers=headers).json()["name"] == "Ann"


def test_two_people_on_one_image(client: TestClient, prelabelled: list[int]) -> None:
    image = f"/api/images/{prelabelled[0]}"
    pages = {"Mara": str(uuid.uuid4()), "Jon": str(uuid.uuid4())}

    def lease(person: str, **fields: Any) -> dict[str, Any]:
        answer = client.put(f"{image}/lease", json={"client_id": pages[person], **fields}, headers=named(person))
        assert answer.status_code == 200, answer.text
        return answer.json()

    assert lease("Mara")["holder"]["mine"] is True
    seen = lease("Jon")
    assert (seen["holder"]["person"], seen["holder"]["mine"]) == ("Mara", False)
    assert [present["person"] for present in seen["present"]] == ["Mara", "Jon"]
    beside = client.get(f"/api/images/{prelabelled[1]}", headers=named("Jon")).json()
    assert beside["next_open_id"] is None
    assert lease("Jon", take_over=True)["holder"]["mine"] is True
    left = client.delete(f"{image}/lease", params={"client_id": pages["Jon"]}, headers=named("Jon"))
    assert left.status_code == 204
    assert lease("Mara")["holder"]["mine"] is True


def test_a_stale_verdict_is_refused_with_both(client: TestClient, prelabelled: list[int]) -> None:
    image = f"/api/images/{prelabelled[0]}"
    shown = client.get(f"{image}/segments").json()
    segment = shown["segments"][0]["id"]
    client.post(f"{image}/decisions", json={"decisions": [decision(segment, "reject")]}, headers=named("Jon"))
    mine = {"decisions": [decision(segment, "keep")], "seen": shown["last_decision_id"]}
    refused = client.post(f"{image}/decisions", json=mine, headers=named("Mara"))
    assert (refused.status_code, refused.json()["code"]) == (409, "stale-verdict")
    (conflict,) = refused.json()["details"]["conflicts"]
    assert (conflict["client_id"], conflict["yours"]) == (mine["decisions"][0]["client_id"], "keep")
    assert (conflict["theirs"]["person"], conflict["theirs"]["verdict"]) == ("Jon", "reject")
    mine["seen"] = conflict["theirs"]["decision_id"]
    stored = client.post(f"{image}/decisions", json=mine, headers=named("Mara"))
    assert (stored.json()["stored"], stored.json()["others"]) == (1, [])


def test_tasks_guidelines_and_filters(client: TestClient, prelabelled: list[int]) -> None:
    one, two = prelabelled
    given = {"people": ["Mara", "Jon"], "mode": "shares"}
    assert client.post("/api/datasets/street/assign", json=given).json() == {
        "people": [{"person": "Mara", "images": 1}, {"person": "Jon", "images": 1}]
    }
    finish(client, one, ["keep", "reject"], "Mara")
    people = client.get("/api/datasets/street/people").json()
    assert [(each["person"], each["assigned"], each["done"]) for each in people] == [("Jon", 1, 0), ("Mara", 1, 1)]

    def found(**query: Any) -> list[int]:
        answer = client.get("/api/datasets/street/images", params=query)
        assert answer.status_code == 200, answer.text
        return [image["id"] for image in answer.json()["items"]]

    assert (found(assignee="Mara"), found(assignee="Jon"), found(assignee="")) == ([one], [two], [])
    assert (found(person="Mara"), found(person="Jon")) == ([one], [])
    assert (found(verdict="keep"), found(verdict="undecided")) == ([one], [two])
    assert (found(min_score=0.0, max_score=1.0), found(min_score=1.0)) == ([one, two], [])
    assert client.get("/api/datasets/street/images", params={"verdict": "maybe"}).status_code == 422
    rules = {"second_share": 0.5, "ask_recall": True}
    changed = client.patch("/api/datasets/street", json={"guidelines": "# Keep poles", "rules": rules})
    assert changed.status_code == 200, changed.text
    read = client.get("/api/datasets/street/guidelines").json()
    assert read == {"guidelines": "# Keep poles", "rules": rules}
    segments = client.get(f"/api/images/{two}/segments").json()["segments"]
    client.post(f"/api/images/{two}/decisions", json={"decisions": [decision(each["id"], "keep") for each in segments]})
    asked = client.put(f"/api/images/{two}/review", json={"status": "done"})
    assert (asked.status_code, asked.json()["code"]) == (409, "recall-asked")
    told = client.put(f"/api/images/{two}/review", json={"status": "done", "recall": "nearly"})
    assert (told.status_code, told.json()["recall"]) == (200, "nearly")


def test_second_review_agreement_and_adjudication(client: TestClient, prelabelled: list[int]) -> None:
    client.patch("/api/datasets/street", json={"rules": {"second_share": 1.0}})
    image = prelabelled[0]
    segments = finish(client, image, ["keep", "reject"], "Mara")
    mara, jon = named("Mara"), named("Jon")
    assert client.get("/api/datasets/street/second-reviews", headers=mara).json()["due"] == []
    due = client.get("/api/datasets/street/second-reviews", headers=jon).json()["due"]
    assert [each["image_id"] for each in due] == [image]
    refused = client.post(f"/api/images/{image}/second-review", headers=mara)
    assert (refused.status_code, refused.json()["code"]) == (409, "not-blind")
    review = client.post(f"/api/images/{image}/second-review", headers=jon).json()
    address = f"/api/second-reviews/{review['id']}"
    shown = client.get(f"{address}/segments", headers=jon).json()
    assert [each["id"] for each in shown["segments"]] == segments
    assert {each["verdict"] for each in shown["segments"]} == {"undecided"}
    assert client.get(f"{address}/segments", headers=mara).status_code == 403
    given = [decision(segment, "keep") for segment in segments]
    stored = client.post(f"{address}/decisions", json={"decisions": given}, headers=jon).json()
    assert (stored["stored"], stored["verdicts"]["keep"]) == (len(segments), len(segments))
    assert len(client.get(f"{address}/decisions", headers=jon).json()["decisions"]) == len(segments)
    assert client.put(f"{address}/review", json={"status": "done"}, headers=jon).json()["status"] == "done"

    agreement = client.get("/api/datasets/street/agreement").json()
    assert (agreement["reviews"], agreement["overall"]["count"]) == (1, len(segments))
    assert agreement["differences"] == len(segments) // 2
    page = client.get("/api/datasets/street/differences", params={"adjudicated": False}).json()
    difference = page["items"][0]
    assert (difference["first"], difference["second"]) == (
        {"verdict": "reject", "person": "Mara"},
        {"verdict": "keep", "person": "Jon"},
    )
    ruling = {"client_id": str(uuid.uuid4()), "segment_id": difference["segment_id"], "verdict": "keep"}
    ruled = client.post(f"{address}/adjudications", json=ruling, headers=named("Ann"))
    assert ruled.json()["adjudicated"]["person"] == "Ann"
    undone = client.delete(f"{address}/adjudications/{difference['segment_id']}", headers=named("Ann"))
    assert undone.json()["adjudicated"] is None

    statistics = client.get("/api/datasets/street/statistics").json()
    assert statistics["decisions"] == len(segments) + 1
    assert statistics["agreement"]["kappa"]["count"] == len(segments)
    assert len(statistics["edges"]) == len(statistics["times"]["histogram"])


def test_predictions_become_candidates(client: TestClient, prelabelled: list[int]) -> None:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("a/one.json", '{"segments": [{"points": [[3, 140], [180, 141]]}]}')
    files = [("files", ("predictions.zip", stream.getvalue()))]
    reports = [client.post("/api/datasets/street/candidates", files=files) for _ in range(2)]
    assert reports[0].status_code == 200, reports[0].text
    assert [(each.json()["added"], each.json()["duplicates"]) for each in reports] == [(1, 0), (0, 1)]
    segments = client.get(f"/api/images/{prelabelled[0]}/segments").json()["segments"]
    assert [each["verdict"] for each in segments if each["origin"] == "import"] == ["undecided"]
    wrong = [("files", ("a/nine.json", b'{"segments": []}'))]
    refused = client.post("/api/datasets/street/candidates", files=wrong)
    assert refused.status_code == 422
    assert refused.json()["details"]["errors"][0]["message"] == "there is no image of this name"
