"""A submission from upload to board, through the API."""

from __future__ import annotations

import csv
import io
import struct
from typing import Any
from uuid import uuid4

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient


def value(done: dict[str, Any], metric: str) -> float | None:
    return done["scores"][0]["totals"][metric]["value"]


def test_perfect_results_are_perfect_and_every_event_is_a_step_forward(field, perfect_results) -> None:
    received = field.submit(perfect_results, label="v1")
    assert received["status"] in ("queued", "scoring", "scored")
    assert (received["images"], received["segments"], received["missing"]) == (5, 20, [])
    done = field.finished(received["id"])
    assert (done["status"], done["progress"], done["position"], done["label"]) == ("scored", 1.0, None, "v1")
    assert [value(done, name) for name in ("f1", "precision", "recall")] == [1.0, 1.0, 1.0]
    assert done["scores"][0]["protocol"] == "clearlines-v2"
    assert [line["text"] for line in done["log"]][-1] == "scored"
    assert done["error_types"]["background"] == 0
    assert {"source", "length", "orientation"} <= set(done["strata"])


def test_one_image_shows_why(field, half_results, client: TestClient) -> None:
    done = field.scored(half_results)
    assert value(done, "precision") == pytest.approx(2 / 3)
    assert value(done, "recall") == 0.5
    address = f"/api/submissions/{done['id']}"
    page = client.get(f"{address}/images", params={"sort": "-fp", "limit": 2}).json()
    assert (page["total"], len(page["items"]), page["items"][0]["fp"]) == (5, 2, 1)
    rest = client.get(f"{address}/images", params={"sort": "-fp", "limit": 9, "cursor": page["next_cursor"]}).json()
    assert len({item["image_id"] for item in page["items"] + rest["items"]}) == 5
    assert client.get(page["items"][0]["thumbnail"]).status_code == 200

    image = client.get(f"{address}/images/{rest['items'][0]['image_id']}", params={"sort": "-fp"}).json()
    assert (image["previous"], image["position"]) == (page["items"][1]["image_id"], 3)
    assert [label["outcome"] for label in image["truth"]] == ["hit", "hit", "miss", "miss"]
    assert [found["outcome"] for found in image["predictions"]] == ["hit", "hit", "false_alarm"]
    assert image["predictions"][0]["best_label"] == 0
    assert image["predictions"][0]["offset"] == pytest.approx(0, abs=1e-3)
    assert image["predictions"][2]["error_type"] == "background"
    assert client.get(image["display"]).status_code == 200

    here = f"{address}/images/{image['image_id']}"
    points = client.get(f"{here}/points").content
    magic, _, segments, count = struct.unpack("<4sIII", points[:16])
    assert (magic, segments, count) == (b"CLP1", 7, 7 * 60)
    assert np.frombuffer(points, "<u4", 7, 16).tolist() == list(range(7))
    overlay = cv2.imdecode(np.frombuffer(client.get(f"{here}/overlay.png").content, np.uint8), cv2.IMREAD_COLOR)
    assert overlay is not None
    assert overlay.shape[0] > 240
    assert overlay.shape[1] >= 320

    matches = client.get(f"{address}/matches").json()
    assert [match["label"] for match in matches["images"][0]["matches"]] == [0, 1]


def test_a_wrong_line_that_people_rejected_says_why(field, half_results, client: TestClient) -> None:
    image = field.images[0]
    name = client.get(f"/api/images/{image}").json()["name"]
    segment = client.get(f"/api/images/{image}/segments").json()["segments"][1]["id"]
    decision = {"client_id": str(uuid4()), "group_id": str(uuid4()), "segment_id": segment, "verdict": "reject"}
    given = {"decisions": [{**decision, "reason": "lane_marking"}]}
    assert client.post(f"/api/images/{image}/decisions", json=given).status_code == 200
    assert client.post(f"/api/splits/{field.split}/versions").status_code == 201

    done = field.scored(half_results)
    (marking,) = done["strata"]["reason"]
    share = {"value": 1.0, "low": 1.0, "high": 1.0}
    assert marking == {"name": "lane_marking", "tp": 0, "fp": 1, "fn": 0, "candidates": 1, "share": share}
    address = f"/api/submissions/{done['id']}/images"
    (row,) = client.get(address, params={"search": name}).json()["items"]
    found = client.get(f"{address}/{row['image_id']}").json()["predictions"]
    assert [each["rejected_as"] for each in found] == [None, "lane_marking", None]

    truth = client.get(f"/api/splits/{field.split}/truth?format=json").json()["images"]
    assert [each.get("reason") for each in truth[name]["segments"]] == [None, None, None, "lane_marking"]
    assert {each["verdict"] for other in truth for each in truth[other]["segments"]} == {"keep", "reject"}


def test_false_positives_go_to_the_labellers_once(field, half_results, client: TestClient) -> None:
    done = field.scored(half_results)
    item = client.get(f"/api/submissions/{done['id']}/images").json()["items"][0]
    here = f"/api/submissions/{done['id']}/images/{item['image_id']}"
    target = client.get(here).json()["review_target"]
    assert client.post(f"{here}/review", json={"predictions": [0]}).status_code == 422
    sent = client.post(f"{here}/review", json={"predictions": [2]}).json()
    assert sent == {"image_id": target, "sent": 1, "already_there": 0}
    assert client.post(f"{here}/review", json={"predictions": [2]}).json()["already_there"] == 1
    candidates = client.get(f"/api/images/{target}/segments").json()["segments"]
    assert [candidate["verdict"] for candidate in candidates].count("undecided") == 1
    assert client.get(f"/api/images/{target}").json()["status"] == "open"
    # the truth is frozen: the numbers stay
    assert value(client.get(f"/api/submissions/{done['id']}").json(), "recall") == 0.5


def test_a_board_has_one_row_per_method_and_says_who_is_tied(field, perfect_results, half_results, client) -> None:
    field.scored(half_results, method="Rival")
    first = field.scored(half_results, method="Lines", label="old")
    best = field.scored(perfect_results, method="Lines", label="new", code_url="https://example.org/code")
    board = client.get(f"/api/splits/{field.split}/board").json()
    assert [(row["method"]["name"], row["label"]) for row in board["rows"]] == [("Lines", "new"), ("Rival", None)]
    assert [(row["rank_low"], row["rank_high"]) for row in board["rows"]] == [(1, 1), (2, 2)]
    assert board["rows"][0]["method"]["code_url"] == "https://example.org/code"
    assert board["rows"][0]["totals"]["official_f1"]["value"] is not None
    table = list(csv.DictReader(io.StringIO(client.get(f"/api/splits/{field.split}/board.csv").text)))
    assert (table[0]["method"], float(table[0]["f1"])) == (best["method"]["slug"], 1.0)

    comparison = client.get(f"/api/submissions/{first['id']}/compare/{best['id']}").json()
    assert comparison["metrics"]["recall"]["difference"] == 0.5
    assert comparison["images"] == {"better": 5, "worse": 0, "equal": 0}

    assert client.post(f"/api/submissions/{best['id']}/withdraw").json()["status"] == "withdrawn"
    board = client.get(f"/api/splits/{field.split}/board").json()
    assert {row["label"] for row in board["rows"]} == {"old", None}
    assert {row["rank_high"] for row in board["rows"]} == {2}  # equal results are tied
    assert board["rows"][0]["tied_with"] == [board["rows"][1]["method"]["slug"]]
    assert client.post(f"/api/submissions/{best['id']}/restore").json()["status"] == "scored"
    assert client.get(f"/api/splits/{field.split}/board").json()["rows"][0]["label"] == "new"

    method = client.get(f"/api/methods/{best['method']['slug']}").json()
    assert [entry["id"] for entry in method["submissions"]][:2] == [best["id"], first["id"]]


def test_a_new_version_of_the_truth_leaves_old_numbers_alone(field, perfect_results, client: TestClient) -> None:
    done = field.scored(perfect_results)
    image = field.images[0]
    segment = client.get(f"/api/images/{image}/segments").json()["segments"][0]
    decision = {
        "client_id": "5f0c1c8e-0c5e-4d2c-9a55-111111111111",
        "group_id": "5f0c1c8e-0c5e-4d2c-9a55-222222222222",
        "segment_id": segment["id"],
        "verdict": "reject",
    }
    assert client.post(f"/api/images/{image}/decisions", json={"decisions": [decision]}).status_code == 200
    assert client.post(f"/api/splits/{field.split}/versions").status_code == 201
    assert client.get(f"/api/splits/{field.split}/board").json()["rows"] == []
    assert client.post(f"/api/submissions/{done['id']}/rescore").status_code == 202
    again = field.finished(done["id"])
    assert [(score["split_version"], score["totals"]["tp"]["value"]) for score in again["scores"]] == [(2, 19), (1, 20)]
    assert client.post(f"/api/submissions/{done['id']}/rescore").status_code == 409
    assert len(client.get(f"/api/splits/{field.split}/board?version=1").json()["rows"]) == 1


def test_all_submissions_of_a_split_are_scored_anew(field, perfect_results, half_results, client: TestClient) -> None:
    ids = [field.scored(perfect_results, method="A")["id"], field.scored(half_results, method="B")["id"]]
    address = f"/api/splits/{field.split}/rescore"
    assert client.post(address).json() == {"queued": 0}
    image = field.images[0]
    segment = client.get(f"/api/images/{image}/segments").json()["segments"][0]
    names = dict.fromkeys(("client_id", "group_id"), "5f0c1c8e-0c5e-4d2c-9a55-333333333333")
    decision = {**names, "segment_id": segment["id"], "verdict": "reject"}
    assert client.post(f"/api/images/{image}/decisions", json={"decisions": [decision]}).status_code == 200
    assert client.post(f"/api/splits/{field.split}/versions").status_code == 201
    assert client.post(address).json() == {"queued": 2}
    assert [len(field.finished(each)["scores"]) for each in ids] == [2, 2]
    assert client.post(address, json={"split_version": 9}).status_code == 404
    assert client.post(address, json={"split_version": 1}).json() == {"queued": 0}


def test_too_many_loose_files_are_refused_with_a_hint(field, client: TestClient) -> None:
    files = [("files", (f"{number}.npz", b"")) for number in range(1001)]
    answer = client.post(f"/api/splits/{field.split}/submissions/validate", files=files)
    assert answer.status_code == 400
    assert answer.json()["hint"] == "pack them into one zip or tar.gz"


def test_own_results_come_back_as_they_are_scored(field, half_results, client: TestClient) -> None:
    done = field.scored(half_results)
    with np.load(io.BytesIO(client.get(f"/api/submissions/{done['id']}/file").content)) as file:
        assert file["names"].tolist() == ["a/one", "a/two", "b/five", "b/four", "b/three"]
        assert len(file["offsets"]) == 16
    assert client.get(f"/api/submissions/{done['id']}/file?form=upload").content == half_results
    # the same results packed otherwise are the same submission
    repacked = field.scored(client.get(f"/api/submissions/{done['id']}/file").content, name="set.npz")
    assert repacked["submission_hash"] == done["submission_hash"]


def test_validation_stores_nothing_and_says_what_is_missing(field, client: TestClient, one_image) -> None:
    files = [("files", ("one.zip", one_image))]
    answer = client.post(f"/api/splits/{field.split}/submissions/validate", files=files).json()
    assert (answer["images"], answer["segments"]) == (1, 4)
    assert answer["missing"] == ["a/two", "b/five", "b/four", "b/three"]
    assert answer["left_out"] == [{"file": "readme.txt", "reason": "no file of segments"}]
    assert client.get(f"/api/splits/{field.split}/submissions").json()["total"] == 0


def test_many_files_make_one_submission(field, client: TestClient, loose_files) -> None:
    answer = client.post(
        f"/api/splits/{field.split}/submissions", files=loose_files, data={"method": "Lines", "visibility": "private"}
    )
    assert answer.status_code == 202, answer.text
    done = field.finished(answer.json()["id"])
    assert (done["images"], done["segments"], done["visibility"]) == (5, 20, "private")
    assert client.get(f"/api/splits/{field.split}/board").json()["rows"] == []
    assert client.patch(f"/api/submissions/{done['id']}", json={"visibility": "public"}).status_code == 200
    assert len(client.get(f"/api/splits/{field.split}/board").json()["rows"]) == 1
