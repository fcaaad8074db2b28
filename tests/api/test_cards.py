"""A dataset's card through the API."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
from fastapi.testclient import TestClient


def test_a_card_tells_images_sources_and_how_the_candidates_did(
    client: TestClient, upload: Callable[..., dict[str, Any]], picture: Callable[[int], bytes]
) -> None:
    line = {"points": [[10, 20], [110, 20]]}
    other = {"points": [[10, 90], [110, 90]], "verdict": "reject"}
    upload(
        "street",
        {
            "images/city/one.png": picture(1),
            "labels/city/one.json": json.dumps({"segments": [line, other]}).encode(),
            "images/land/two.png": picture(2),
            "labels/land/two.json": json.dumps({"segments": [line, {**other, "points": [[30, 9], [30, 99]]}]}).encode(),
            "images/land/three.png": picture(3),
        },
    )
    texts = {"description": "Two drives", "licence": "CC BY 4.0", "citation": "@misc{x}"}
    assert client.patch("/api/datasets/street", json=texts).status_code == 200
    card = client.get("/api/datasets/street/card").json()
    assert {word: card[word] for word in texts} == texts
    assert (card["images"], card["labelled"], card["labels"]) == (3, 2, 2)
    assert [(source["source"], source["images"], source["labelled"]) for source in card["sources"]] == [
        ("city", 1, 1),
        ("land", 2, 1),
    ]
    city, land, everything = card["table_one"]
    assert (city["source"], city["precision"], city["recall"], city["f1_v2"]) == ("city", 0.5, 1.0, 2 / 3)
    assert (land["precision"], land["f1"]) == (0.5, 2 / 3)
    assert (everything["source"], everything["images"], everything["precision"]) == ("all", 2, 0.5)
    pixels = cv2.imdecode(np.frombuffer(client.get(card["figure"]).content, np.uint8), cv2.IMREAD_COLOR)
    assert pixels is not None
    assert pixels.shape[1] > 3 * 200
    spread = pixels.max(axis=2).astype(int) - pixels.min(axis=2)
    assert (spread[:150, :200] == 0).all()
    assert (spread[:150, 210:400] > 60).any()
    assert (spread[:150, 420:] > 60).any()


def test_the_table_follows_the_labels(
    client: TestClient, upload: Callable[..., dict[str, Any]], picture: Callable[[int], bytes]
) -> None:
    upload("street", {"one.png": picture(1)})
    card = client.get("/api/datasets/street/card").json()
    assert (card["table_one"], card["figure"], card["labelled"]) == ([], None, 0)
    assert client.get("/api/datasets/street/card.png").status_code == 404
    kept, rejected = {"points": [[10, 20], [110, 20]]}, {"points": [[10, 90], [110, 90]], "verdict": "reject"}
    labels = json.dumps({"segments": [kept, rejected]}).encode()
    upload("street", {"images/two.png": picture(2), "labels/two.json": labels})
    (row,) = client.get("/api/datasets/street/card").json()["table_one"]
    assert (row["source"], row["images"]) == (None, 1)
    found = client.get("/api/datasets/street/images?status=done").json()["items"]
    client.patch(f"/api/images/{found[0]['id']}", json={"source": "city"})
    assert client.get("/api/datasets/street/card").json()["table_one"] == [{**row, "source": "city"}]


def test_labels_alone_are_no_candidates(
    client: TestClient, upload: Callable[..., dict[str, Any]], picture: Callable[[int], bytes]
) -> None:
    labels = json.dumps({"segments": [{"points": [[10, 20], [110, 20]]}]}).encode()
    upload("street", {"images/one.png": picture(1), "labels/one.json": labels})
    card = client.get("/api/datasets/street/card").json()
    assert (card["labelled"], card["labels"], card["table_one"]) == (1, 1, [])
    pixels = cv2.imdecode(np.frombuffer(client.get(card["figure"]).content, np.uint8), cv2.IMREAD_COLOR)
    assert pixels is not None
    assert 2 * 200 < pixels.shape[1] < 3 * 200


def test_texts_are_cleared_and_the_name_stays(client: TestClient) -> None:
    client.post("/api/datasets", json={"name": "Street"})
    client.patch("/api/datasets/street", json={"licence": "CC0"})
    answer = client.patch("/api/datasets/street", json={"licence": None, "name": "Road"})
    assert answer.json()["name"] == "Road"
    assert client.get("/api/datasets/street/card").json()["licence"] is None
    assert client.patch("/api/datasets/street", json={"licence": "x" * 20_001}).status_code == 422
    assert client.patch("/api/datasets/street", json={"licence": "a\0b"}).status_code == 422
