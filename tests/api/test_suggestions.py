"""Suggestions through the API: of an image, of a dataset, and a training that somebody asks for."""

from __future__ import annotations

import json
import time
from typing import Any
from uuid import uuid4

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.services.suggestion_training import FEWEST_DECISIONS


def line_labels(count: int, seed: int) -> bytes:
    """Undecided candidates: steep ones, and others that bend."""
    random = np.random.default_rng(seed)
    lines = []
    for number in range(count):
        x = 8 + 4 * number + random.uniform(-1, 1)
        bend = 0.0 if number % 2 else 6.0
        y = np.linspace(10, 130, 40)
        lines.append(np.stack([x + bend * np.sin(y / 20), y], axis=1).round(3).tolist())
    return json.dumps({"segments": [{"points": line, "verdict": "undecided"} for line in lines]}).encode()


@pytest.fixture
def candidates(client: TestClient, upload: Any, picture: Any) -> list[int]:
    """A dataset `street` of three images with candidates that nobody has judged."""
    files = {f"images/a/{number}.png": picture(number) for number in range(3)}
    files |= {f"labels/a/{number}.json": line_labels(24, number) for number in range(3)}
    return [image["id"] for image in upload("street", files)["added"]]


def finish(client: TestClient, image_id: int) -> None:
    """Keep what is straight, reject the rest."""
    found = client.get(f"/api/images/{image_id}/segments").json()["segments"]
    group = str(uuid4())
    decisions = [
        {
            "client_id": str(uuid4()),
            "group_id": group,
            "segment_id": segment["id"],
            "verdict": "keep" if number % 2 else "reject",
            "kind": "accept" if number % 3 else "judge",
            "suggestion": 0.25,
        }
        for number, segment in enumerate(found)
    ]
    answer = client.post(f"/api/images/{image_id}/decisions", json={"decisions": decisions})
    assert answer.status_code == 200, answer.text
    assert client.put(f"/api/images/{image_id}/review", json={"status": "done"}).status_code == 200


def learnt(client: TestClient) -> dict[str, Any]:
    """Wait until a model of the dataset's own suggests, and return what is told of it."""
    deadline = time.monotonic() + 60
    while True:
        answer = client.get("/api/datasets/street/suggestions").json()
        if answer["model"]["id"] is not None:
            return answer
        assert time.monotonic() < deadline, answer
        time.sleep(0.05)


def test_before_any_decision_the_general_model_suggests(client: TestClient, candidates: list[int]) -> None:
    answer = client.get(f"/api/images/{candidates[0]}/suggestions")
    assert answer.status_code == 200, answer.text
    told = answer.json()
    ids = [segment["id"] for segment in client.get(f"/api/images/{candidates[0]}/segments").json()["segments"]]
    assert [segment["id"] for segment in told["segments"]] == ids
    assert told["model"]["id"] is None
    assert told["thresholds"]["reject"] < told["thresholds"]["keep"]
    first = told["segments"][0]
    assert set(first) == {"id", "probability", "family", "value", "lens", "for", "against"}
    assert all(0 <= segment["probability"] <= 1 for segment in told["segments"])
    # nothing is decided by it
    assert client.get("/api/datasets/street").json()["verdicts"]["undecided"] == 72
    page = client.get("/api/datasets/street/suggestions").json()
    assert (page["model"]["id"], page["calibration"], page["gain"]) == (None, None, [])
    assert page["weights"][0]["feature"]
    assert page["training"]["least"] == FEWEST_DECISIONS
    refused = client.post("/api/datasets/street/suggestions/train")
    assert (refused.status_code, refused.json()["details"]) == (409, {"decisions": 0, "images": 0})


def test_what_was_decided_is_learnt_by_itself_and_when_asked(client: TestClient, candidates: list[int]) -> None:
    first, second, third = candidates
    before = client.get(f"/api/images/{third}/suggestions").json()
    finish(client, first)
    finish(client, second)
    client.app.state.server.dispatcher.wake()  # type: ignore[attr-defined]
    page = learnt(client)
    model = page["model"]
    assert (model["decisions"], model["images"]) == (48, 2)
    assert sum(entry["count"] for entry in page["calibration"]["bins"]) == page["calibration"]["count"] == 48
    assert [entry["images"] for entry in page["gain"]] == [0, 1]
    assert page["training"]["decisions"] == 48
    assert page["training"]["wanted"] == 88
    after = client.get(f"/api/images/{third}/suggestions").json()
    assert after["model"] == model
    gap = [mean_gap(answer) for answer in (before, after)]
    assert gap[1] > gap[0]

    asked = client.post("/api/datasets/street/suggestions/train")
    assert (asked.status_code, asked.json()["asked"]) == (202, True)


def mean_gap(answer: dict[str, Any]) -> float:
    """How much more likely the straight ones are, on average."""
    probability = np.array([segment["probability"] for segment in answer["segments"]])
    return float(probability[1::2].mean() - probability[::2].mean())


def test_what_isnt_there_has_no_suggestions(client: TestClient, candidates: list[int]) -> None:
    assert client.get("/api/images/4711/suggestions").status_code == 404
    assert client.get("/api/datasets/nowhere/suggestions").status_code == 404
    assert client.post("/api/datasets/nowhere/suggestions/train").status_code == 404
    assert client.delete(f"/api/images/{candidates[0]}").status_code == 200
    assert client.get(f"/api/images/{candidates[0]}/suggestions").status_code == 404


def test_an_image_without_candidates_has_none(client: TestClient, upload: Any, picture: Any) -> None:
    [image] = upload("street", {"one.png": picture(1)})["added"]
    assert client.get(f"/api/images/{image['id']}/suggestions").json()["segments"] == []
