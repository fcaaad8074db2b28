"""How candidates were found, asked over HTTP."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from fastapi.testclient import TestClient


def segments_of(client: TestClient, image_id: int) -> list[dict[str, Any]]:
    return client.get(f"/api/images/{image_id}/segments").json()["segments"]


@pytest.mark.parametrize("point", ["recall", "precise"])
def test_all_candidates_of_an_image_tell_how_they_were_found(
    client: TestClient,
    upload: Callable[..., dict[str, Any]],
    finish_run: Callable[[int], dict[str, Any]],
    picture: Callable[[int], bytes],
    point: str,
) -> None:
    image_id = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    # longer than the 60 px that the lens is read off, and shorter
    for min_length in (30, 80):
        asked = {"min_length": min_length, "operating_point": point, "camera": "per-image"}
        run = client.post("/api/datasets/street/runs", json=asked).json()["id"]
        assert finish_run(run)["status"] == "done"
        candidates = segments_of(client, image_id)
        assert candidates
        for candidate in candidates:
            answer = client.get(f"/api/segments/{candidate['id']}/history")
            assert answer.status_code == 200, answer.text
            history = answer.json()
            assert (history["segment_id"], history["image_id"], history["run_id"]) == (candidate["id"], image_id, run)
            assert history["score"] == pytest.approx(candidate["score"], abs=1e-6)
            evidence = sum(part["weight"] * part["value"] for part in history["score_parts"]) + history["intercept"]
            assert 1 / (1 + math.exp(-evidence)) == pytest.approx(history["score"])
            assert len(history["joins"]) == len(history["pieces"]) - 1
            assert all(piece["length"] > 0 for piece in history["pieces"])
            assert min(*history["extended"], *history["trimmed"]) >= 0


def test_what_has_no_history_says_why(client: TestClient, prelabelled: list[int]) -> None:
    missing = client.get("/api/segments/999999/history")
    assert (missing.status_code, missing.json()["code"]) == (404, "not-found")
    assert client.get("/api/segments/0/history").status_code == 422

    candidate = segments_of(client, prelabelled[0])[0]["id"]
    client.delete(f"/api/images/{prelabelled[0]}")
    deleted = client.get(f"/api/segments/{candidate}/history")
    assert (deleted.status_code, deleted.json()["hint"]) == (404, "restore it first")


def test_an_imported_segment_has_no_history(client: TestClient, prelabelled: list[int]) -> None:
    from app.db.models import Segment

    candidate = segments_of(client, prelabelled[0])[0]["id"]
    with client.app.state.server.database.write() as session:  # type: ignore[attr-defined]
        session.get_one(Segment, candidate).origin = "import"
    answer = client.get(f"/api/segments/{candidate}/history")
    assert (answer.status_code, answer.json()["code"]) == (404, "no-history")
    assert "imported" in answer.json()["message"]
    assert answer.headers["content-type"] == "application/problem+json"
