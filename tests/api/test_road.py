"""The road of one image through the REST API alone: upload, run, decide, review, export."""

from __future__ import annotations

import io
import struct
import uuid
import zipfile
from collections.abc import Callable
from typing import Any

import numpy as np
from fastapi.testclient import TestClient


def read_points(content: bytes) -> dict[int, np.ndarray]:
    magic, revision, count, total = struct.unpack_from("<4sIII", content)
    assert magic == b"CLP1"
    assert revision > 0
    ids = np.frombuffer(content, "<u4", count, 16)
    offsets = np.frombuffer(content, "<u4", count + 1, 16 + 4 * count)
    points = np.frombuffer(content, "<f4", 2 * total, 16 + 4 * (2 * count + 1)).reshape(-1, 2)
    return {int(i): points[a:b] for i, a, b in zip(ids, offsets[:-1], offsets[1:], strict=True)}


def decision(segment_id: int, verdict: str, **fields: Any) -> dict[str, Any]:
    ids = {"client_id": str(uuid.uuid4()), "group_id": str(uuid.uuid4())}
    return {**ids, "segment_id": segment_id, "verdict": verdict, "elapsed_ms": 700, **fields}


def test_the_whole_road_ends_in_a_label_file_with_exactly_the_kept_segments(
    client: TestClient, prelabelled: list[int]
) -> None:
    kept: dict[str, list[np.ndarray]] = {}
    for image_id in prelabelled:
        image = client.get(f"/api/images/{image_id}").json()
        segments = client.get(f"/api/images/{image_id}/segments").json()["segments"]
        points = read_points(client.get(f"/api/images/{image_id}/points").content)
        assert [segment["id"] for segment in segments] == list(points)
        assert len(segments) >= 3
        verdicts = ["keep", "ambiguous"] + ["reject"] * (len(segments) - 2)
        decisions = [decision(segment["id"], word) for segment, word in zip(segments, verdicts, strict=True)]
        stored = client.post(f"/api/images/{image_id}/decisions", json={"decisions": decisions})
        assert stored.status_code == 200, stored.text
        assert stored.json()["stored"] == len(segments)
        assert client.put(f"/api/images/{image_id}/review", json={"status": "done"}).status_code == 200
        kept[image["name"]] = [points[segments[0]["id"]]]

    answer = client.get("/api/datasets/street/export")
    assert answer.status_code == 200, answer.text
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        names = archive.namelist()
        for name, lines in kept.items():
            assert f"images/{name}.png" in names
            content = archive.read(f"labels/{name}_edge_segments_filtered.npy")
            loaded = np.load(io.BytesIO(content), allow_pickle=True)
            assert len(loaded) == len(lines)
            for label, line in zip(loaded, lines, strict=True):
                assert label.shape == (len(line), 1, 2)
                np.testing.assert_array_equal(label[:, 0], line.astype(np.float64))
            ambiguous = np.load(
                io.BytesIO(archive.read(f"labels/{name}_edge_segments_ambiguous.npy")), allow_pickle=True
            )
            assert len(ambiguous) == 1


def test_an_image_with_undecided_candidates_is_not_done_and_not_exported(
    client: TestClient, prelabelled: list[int]
) -> None:
    refused = client.put(f"/api/images/{prelabelled[0]}/review", json={"status": "done"})
    assert refused.status_code == 409
    assert refused.json()["code"] == "undecided-left"
    assert refused.json()["details"]["undecided"] > 0

    export = client.get("/api/datasets/street/export")
    assert export.status_code == 409
    assert export.json()["code"] == "images-not-done"
    assert export.json()["details"]["images"] == ["a/one", "a/two"]
    assert client.get("/api/datasets/street/export", params={"allow_not_done": True}).status_code == 200


def test_the_same_decision_twice_counts_once_and_a_changed_one_is_refused(
    client: TestClient, prelabelled: list[int]
) -> None:
    address = f"/api/images/{prelabelled[0]}/decisions"
    first = client.get(f"/api/images/{prelabelled[0]}/segments").json()["segments"][0]["id"]
    sent = decision(first, "keep")
    assert client.post(address, json={"decisions": [sent]}).json()["stored"] == 1
    again = client.post(address, json={"decisions": [sent]}).json()
    assert (again["stored"], again["repeated"]) == (0, 1)
    changed = client.post(address, json={"decisions": [{**sent, "verdict": "reject"}]})
    assert changed.status_code == 409
    history = client.get(address).json()["decisions"]
    assert [row["verdict"] for row in history] == ["keep"]


def test_decisions_are_stored_together_or_not_at_all(client: TestClient, prelabelled: list[int]) -> None:
    one, two = prelabelled
    mine = client.get(f"/api/images/{one}/segments").json()["segments"][0]["id"]
    foreign = client.get(f"/api/images/{two}/segments").json()["segments"][0]["id"]
    answer = client.post(
        f"/api/images/{one}/decisions", json={"decisions": [decision(mine, "keep"), decision(foreign, "keep")]}
    )
    assert answer.status_code == 422
    assert client.get(f"/api/images/{one}/decisions").json()["decisions"] == []


def test_a_second_run_takes_the_verdicts_along(
    client: TestClient, prelabelled: list[int], finish_run: Callable[[int], dict[str, Any]]
) -> None:
    image_id = prelabelled[0]
    segments = client.get(f"/api/images/{image_id}/segments").json()["segments"]
    decisions = [decision(segment["id"], "keep") for segment in segments[:2]]
    client.post(f"/api/images/{image_id}/decisions", json={"decisions": decisions})
    run = client.post("/api/datasets/street/runs", json={"min_length": 30}).json()["id"]
    assert finish_run(run)["changes"]["carried"] == 2
    after = client.get(f"/api/images/{image_id}/segments").json()["segments"]
    assert sum(segment["verdict"] == "keep" for segment in after) == 2
    assert not {segment["id"] for segment in after} & {segment["id"] for segment in segments}
