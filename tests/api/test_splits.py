"""Splits through the API: freezing, versions, truth, images, and what outlives the dataset."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from datetime import timedelta
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.clock import utc_now
from app.services.purging import purge


def label_file(*lines: tuple[float, float, float, float], ambiguous: int = 0) -> bytes:
    segments: list[dict[str, Any]] = [{"points": [[a, b], [c, d]], "verdict": "keep"} for a, b, c, d in lines]
    for segment in segments[len(lines) - ambiguous :]:
        segment["verdict"] = "ambiguous"
    return json.dumps({"segments": segments}).encode()


LONG, SHORT, UNCLEAR = (10.0, 20.0, 110.0, 20.0), (10.0, 40.0, 30.0, 40.0), (10.0, 60.0, 90.0, 60.0)


@pytest.fixture
def street(upload: Callable[..., dict[str, Any]], picture: Callable[[int], bytes]) -> list[int]:
    """A dataset of three images: two with labels, one open."""
    files = {
        "images/a/one.png": picture(1),
        "labels/a/one.json": label_file(LONG, SHORT, UNCLEAR, ambiguous=1),
        "images/a/two.png": picture(2),
        "labels/a/two.json": label_file(LONG),
        "images/a/zero.png": picture(3),
    }
    return [image["id"] for image in sorted(upload("street", files)["added"], key=lambda image: image["name"])]


def freeze(client: TestClient, *, status: int = 201, **given: Any) -> dict[str, Any]:
    answer = client.post("/api/datasets/street/splits", json={"name": "Test", "min_length": 50, **given})
    assert answer.status_code == status, answer.text
    return answer.json()


def judge(client: TestClient, image: int, verdict: str) -> None:
    """Decide on the image's first segment."""
    segment = client.get(f"/api/images/{image}/segments").json()["segments"][0]["id"]
    decision = {"client_id": f"{image:08}-0000-4000-8000-{segment:012}", "segment_id": segment, "verdict": verdict}
    decision |= {"group_id": decision["client_id"], "kind": "judge"}
    answer = client.post(f"/api/images/{image}/decisions", json={"decisions": [decision]})
    assert answer.status_code == 200, answer.text


def test_kept_is_truth_and_ambiguous_and_short_ones_are_ignored(client: TestClient, street: list[int]) -> None:
    split = freeze(client, description="of the city", closes_at="2999-01-01T00:00:00Z")
    assert split["slug"] == "test"
    assert split["dataset"] == {"slug": "street", "name": "street"}
    version = split["version"]
    assert (version["number"], version["images"], version["labels"], version["ambiguous"]) == (1, 2, 2, 1)
    assert split["protocol"] == "clearlines-v2"
    assert not split["closed"]
    assert split["daily_limit"] == 20
    truth = client.get("/api/splits/test/truth?format=json").json()["images"]
    assert [segment["verdict"] for segment in truth["a/one"]["segments"]] == ["keep", "keep", "ambiguous"]
    assert truth["a/two"]["segments"] == [{"points": [[10.0, 20.0], [110.0, 20.0]], "verdict": "keep"}]
    answer = client.get("/api/splits/test/truth")
    assert answer.headers["x-truth-hash"] == version["truth_hash"]
    with np.load(io.BytesIO(answer.content)) as arrays:
        assert arrays["names"].tolist() == ["a/one", "a/two"]
        assert arrays["points"].dtype == np.float32


def test_the_truth_s_hash_names_the_labels_and_not_their_order(client: TestClient, street: list[int]) -> None:
    first = freeze(client)["version"]["truth_hash"]
    assert freeze(client, name="Again")["version"]["truth_hash"] == first
    assert freeze(client, name="Longer", min_length=60)["version"]["truth_hash"] != first
    assert freeze(client, name="One", image_ids=street[:1])["version"]["truth_hash"] != first


def test_images_that_are_not_done_are_named_with_their_reason(client: TestClient, street: list[int]) -> None:
    problem = freeze(client, status=409, image_ids=street)
    assert problem["code"] == "not-frozen"
    assert [reason["image"] for reason in problem["details"]["reasons"]] == ["a/zero"]
    assert "open, not done" in problem["details"]["reasons"][0]["reason"]
    assert client.get("/api/splits").json() == []


def test_nothing_to_freeze(client: TestClient, street: list[int]) -> None:
    assert freeze(client, status=409, min_length=500)["code"] == "not-frozen"
    for image in street[:2]:
        assert client.put(f"/api/images/{image}/review", json={"status": "open"}).status_code == 200
    assert "no image is done" in freeze(client, status=409)["message"]
    assert freeze(client, status=404, image_ids=[999])["code"] == "not-found"


def test_a_later_label_makes_a_new_version_and_the_old_one_stays(client: TestClient, street: list[int]) -> None:
    first = freeze(client)
    old = client.get("/api/splits/test/truth").content
    assert client.post("/api/splits/test/versions").json()["code"] == "not-frozen"
    judge(client, street[1], "reject")
    assert client.get("/api/splits/test").json()["labels_since"] == {"changed": ["a/two"], "gone": []}
    judge_back = client.post("/api/splits/test/versions")
    assert judge_back.status_code == 201, judge_back.text
    again = judge_back.json()
    assert [version["number"] for version in again["versions"]] == [2, 1]
    assert again["versions"][1]["truth_hash"] == first["version"]["truth_hash"]
    assert again["version"]["labels"] == 1
    assert again["labels_since"] == {"changed": [], "gone": []}
    assert client.get("/api/splits/test/truth?version=1").content == old
    assert client.get("/api/splits/test/truth?version=3").status_code == 404


def test_open_and_hidden_splits_share_no_image(
    client: TestClient, street: list[int], upload: Callable[..., dict[str, Any]], picture: Callable[[int], bytes]
) -> None:
    freeze(client, visibility="open", image_ids=street[:1])
    problem = freeze(client, name="Hidden", visibility="hidden", status=409)
    assert [reason["image"] for reason in problem["details"]["reasons"]] == ["a/one"]
    assert freeze(client, name="Hidden", visibility="hidden", image_ids=street[1:2])["daily_limit"] == 5
    upload("copy", {"images/x.png": picture(2), "labels/x.json": label_file(LONG)})
    answer = client.post("/api/datasets/copy/splits", json={"name": "Copy"})
    assert answer.status_code == 409
    assert answer.json()["details"]["reasons"][0]["reason"] == "a hidden split uses it"


def test_change_delete_and_restore(client: TestClient, street: list[int]) -> None:
    freeze(client)
    freeze(client, name="Other")
    change = {"name": "New  name", "closes_at": "2000-01-01T00:00:00Z", "daily_limit": 3}
    changed = client.patch("/api/splits/test", json=change).json()
    assert (changed["slug"], changed["name"], changed["closed"], changed["daily_limit"]) == (
        "test",
        "New name",
        True,
        3,
    )
    assert not changed["can"]["submit"]
    assert client.patch("/api/splits/test", json={"closes_at": None}).json()["closes_at"] is None
    assert client.patch("/api/splits/test", json={"name": "Other"}).status_code == 409
    assert client.patch("/api/splits/test", json={"visibility": "hidden"}).status_code == 422
    assert client.delete("/api/splits/test").json()["deleted_at"] is not None
    assert client.get("/api/splits/test").status_code == 404
    assert [split["slug"] for split in client.get("/api/splits").json()] == ["other"]
    assert [split["slug"] for split in client.get("/api/splits?deleted=true").json()] == ["test"]
    assert client.post("/api/splits/test/restore").status_code == 200
    assert client.post("/api/splits/test/restore").status_code == 409
    assert len(client.get("/api/splits?dataset=street").json()) == 2


def test_images_are_listed_page_by_page(client: TestClient, street: list[int], picture: Callable[[int], bytes]) -> None:
    freeze(client)
    first = client.get("/api/splits/test/images?limit=1").json()
    second = client.get(f"/api/splits/test/images?limit=1&cursor={first['next_cursor']}").json()
    assert [page["items"][0]["name"] for page in (first, second)] == ["a/one", "a/two"]
    assert (first["total"], second["next_cursor"]) == (2, None)
    assert client.get(first["items"][0]["original"]).content == picture(1)
    assert client.get("/api/splits/test/images/99/original").status_code == 404


def test_frozen_truth_outlives_its_dataset(
    client: TestClient, street: list[int], picture: Callable[[int], bytes]
) -> None:
    freeze(client)
    truth = client.get("/api/splits/test/truth").content
    assert client.delete("/api/datasets/street").status_code == 200
    application: Any = client.app
    server = application.state.server
    purge(server.database, server.blobs, utc_now() + timedelta(days=400), grace=timedelta(days=7))
    assert client.get("/api/splits/test/truth").content == truth
    split = client.get("/api/splits/test").json()
    assert split["dataset"] is None
    assert split["labels_since"] == {"changed": [], "gone": ["a/one", "a/two"]}
    image = client.get("/api/splits/test/images").json()["items"][0]
    assert client.get(image["original"]).content == picture(1)
    assert client.get(image["thumbnail"]).status_code == 200
    assert client.post("/api/splits/test/versions").status_code == 404
