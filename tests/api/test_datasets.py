"""Datasets through the REST API: names, deletion that can be undone, counts."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from fastapi.testclient import TestClient


def test_a_dataset_is_made_renamed_deleted_and_restored(client: TestClient) -> None:
    made = client.post("/api/datasets", json={"name": " Straße am Fluß "})
    assert made.status_code == 201
    slug = made.json()["slug"]
    assert made.json()["name"] == "Straße am Fluß"
    assert slug.isascii()

    renamed = client.patch(f"/api/datasets/{slug}", json={"name": "River road"}).json()
    assert (renamed["slug"], renamed["name"]) == (slug, "River road")

    deleted = client.delete(f"/api/datasets/{slug}").json()
    assert deleted["deleted"] == 1
    assert client.get(f"/api/datasets/{slug}").status_code == 404
    assert client.get("/api/datasets").json() == []
    listed = client.get("/api/datasets", params={"deleted": True}).json()
    assert [each["slug"] for each in listed] == [slug]
    assert listed[0]["restorable_until"] == deleted["restorable_until"]

    assert client.post(f"/api/datasets/{slug}/restore").json()["name"] == "River road"
    assert client.get(f"/api/datasets/{slug}").status_code == 200


def test_a_name_can_be_taken_only_once(client: TestClient) -> None:
    assert client.post("/api/datasets", json={"name": "Ring road"}).status_code == 201
    answer = client.post("/api/datasets", json={"name": "Ring road"})
    assert answer.status_code == 409
    assert answer.json()["code"] == "conflict"
    assert client.post("/api/datasets", json={"name": "Ring  Road!"}).json()["slug"] != "ring-road"


def test_an_empty_name_is_refused_with_its_field(client: TestClient) -> None:
    answer = client.post("/api/datasets", json={"name": "   "})
    assert answer.status_code == 422
    assert answer.json()["where"] == "body.name"


def test_a_restored_dataset_brings_its_images_back(
    client: TestClient, upload: Callable[..., dict[str, Any]], picture: Callable[[int], bytes]
) -> None:
    upload("street", {"one.png": picture(1)})
    client.delete("/api/datasets/street")
    client.post("/api/datasets/street/restore")
    overview = client.get("/api/datasets/street").json()
    assert overview["images"] == 1
    assert overview["reviewed"] == {"open": 1, "done": 0, "discarded": 0}


def test_counts_follow_the_decisions(client: TestClient, prelabelled: list[int]) -> None:
    before = client.get("/api/datasets/street").json()
    assert before["prelabelled"] == 2
    assert before["verdicts"]["undecided"] == before["candidates"] > 0
    assert before["latest_run"]["status"] == "done"
    discard = client.put(f"/api/images/{prelabelled[0]}/review", json={"status": "discarded", "reason": "blurred"})
    assert discard.status_code == 200
    assert client.get("/api/datasets/street").json()["reviewed"] == {"open": 1, "done": 0, "discarded": 1}
