"""Tracing and editing over the API, on real pixels, with the real worker."""

from __future__ import annotations

from typing import Any
from uuid import uuid4

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient


def wall() -> bytes:
    """A bright wall with a long horizontal edge at y = 59.5, from x = 30 to x = 270, 300 x 160."""
    image = np.full((160, 300), 80, np.uint8)
    image[60:, 30:271] = 180
    return cv2.imencode(".png", image)[1].tobytes()


@pytest.fixture
def image(client: TestClient, upload: Any) -> str:
    """The address of an image without candidates."""
    return f"/api/images/{upload('walls', {'wall.png': wall()})['added'][0]['id']}"


def segments(client: TestClient, image: str) -> list[dict[str, Any]]:
    return client.get(f"{image}/segments").json()["segments"]


def post_edit(client: TestClient, image: str, kind: str, replaces: list[int], **fields: Any) -> Any:
    body = {"client_id": str(uuid4()), "kind": kind, "replaces": replaces, **fields}
    return client.post(f"{image}/edits", json=body)


def test_a_line_is_traced_kept_cut_extended_joined_and_all_is_undone(client: TestClient, image: str) -> None:
    traced = client.post(f"{image}/trace", json={"points": [[80, 62], [220, 58]]})
    assert traced.status_code == 200, traced.text
    points = np.array(traced.json()["points"])
    assert points[:, 1] == pytest.approx(59.5, abs=0.05)
    assert traced.json()["residual"] < 0.05
    assert segments(client, image) == []  # nothing is stored by a preview

    drawn = post_edit(client, image, "trace", [], adds=[traced.json()["points"]]).json()
    assert (drawn["kind"], drawn["verdicts"]["keep"], drawn["undone_at"]) == ("trace", 1, None)
    (whole,) = segments(client, image)
    assert (whole["origin"], whole["verdict"], whole["n_points"]) == ("manual", "keep", len(points))

    cut = post_edit(client, image, "cut", [whole["id"]], at=[150.2, 64]).json()
    assert [entry["box"][2] for entry in segments(client, image)] == [150, 220]
    trimmed = post_edit(client, image, "trim", [cut["added"][1]], at=[169.6, 60]).json()
    joined = post_edit(client, image, "join", [cut["added"][0], trimmed["added"][0]]).json()
    (one,) = segments(client, image)
    assert (one["id"], one["box"][0], one["box"][2]) == (joined["added"][0], 80, 220)
    assert one["n_points"] == len(points)  # what is between them was traced
    extended = post_edit(client, image, "extend", [one["id"]]).json()
    (longest,) = segments(client, image)
    assert longest["box"][0] == pytest.approx(30, abs=3)
    assert longest["box"][2] == pytest.approx(270, abs=3)
    preview = client.post(f"{image}/trace", json={"segment_id": longest["id"], "extend": True}).json()
    assert abs(len(preview["points"]) - longest["n_points"]) <= 2

    group = str(uuid4())
    for step in (extended, joined, trimmed, cut, drawn):
        undo = [
            {
                "client_id": str(uuid4()),
                "group_id": group,
                "segment_id": key,
                "verdict": "undecided",
                "kind": "undo",
                "target_group_id": step["client_id"],
            }
            for key in step["added"]
        ]
        assert client.post(f"{image}/decisions", json={"decisions": undo}).status_code == 200
    assert segments(client, image) == []
    edits = client.get(f"{image}/edits").json()["edits"]
    assert [entry["kind"] for entry in edits] == ["trace", "cut", "trim", "join", "extend"]
    assert all(entry["undone_at"] for entry in edits)


def test_problems_say_what_and_where(client: TestClient, image: str) -> None:
    nothing = client.post(f"{image}/trace", json={"points": [[50, 20], [250, 35]]})
    assert (nothing.status_code, nothing.json()["code"]) == (422, "no-edge")
    assert "from (50, 20) to (250, 35)" in nothing.json()["where"]
    drawn = client.post(f"{image}/trace", json={"points": [[50, 20], [250, 35]], "straight": True}).json()
    assert drawn["points"][0] == [50, 20]
    assert drawn["points"][-1] == [250, 35]
    for body in (
        {"points": [[50, 20]]},
        {"points": [[50, 20], [250, 35]], "segment_id": 1, "extend": True},
        {"points": [[50, 20], [250, 35]], "extend": True},
        {"segment_id": 1},
        {},
        {"points": [[50, 20], [250, 35]], "reach": 0},
        {"points": [[5, 20]] * 21},
        {"points": [[50, 20], [1e9, 35]]},
        {"segment_id": 4711, "extend": True},
    ):
        answer = client.post(f"{image}/trace", json=body)
        assert answer.status_code == 422, (body, answer.text)
        assert answer.json()["message"]
    assert client.post("/api/images/4711/trace", json={"points": [[1, 2], [30, 4]]}).status_code == 404
    for body in ({"kind": "cut", "replaces": [1]}, {"kind": "trace", "replaces": []}, {"kind": "fold", "replaces": []}):
        assert post_edit(client, image, **body).status_code == 422


@pytest.mark.parametrize("at", [[1e308, 1e308], [-1e308, 60], [5000, 60], [150, 160]])
def test_nothing_is_cut_or_trimmed_at_a_place_outside_the_image(client: TestClient, image: str, at: Any) -> None:
    (line,) = post_edit(client, image, "trace", [], adds=[[[x, 59.5] for x in range(80, 221)]]).json()["added"]
    for kind in ("cut", "trim"):
        answer = post_edit(client, image, kind, [line], at=at)
        assert (answer.status_code, answer.json()["where"]) == (422, "at")
    far = post_edit(client, image, "trace", [], adds=[[[1e300, 1], [5, 5]]])
    assert (far.status_code, far.json()["where"]) == (422, "adds[0][0]")
    assert [entry["id"] for entry in segments(client, image)] == [line]


def test_an_edit_of_what_was_edited_meanwhile_is_a_conflict_with_what_is_there(client: TestClient, image: str) -> None:
    adds = [[[x, 59.5] for x in range(80, 221)]]
    first = post_edit(client, image, "trace", [], adds=adds).json()
    cut = post_edit(client, image, "cut", first["added"], at=[150, 60]).json()
    late = post_edit(client, image, "trim", first["added"], at=[100, 60])
    assert (late.status_code, late.json()["code"]) == (409, "stale-edit")
    assert late.json()["details"]["current"][0]["replaced_by"] == cut["added"]
    assert len(segments(client, image)) == 2


def test_an_edit_sent_again_is_answered_without_being_made_again(
    client: TestClient, image: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn = post_edit(client, image, "trace", [], adds=[[[x, 59.5] for x in range(80, 221)]]).json()
    body = {"client_id": str(uuid4()), "kind": "extend", "replaces": drawn["added"]}
    first = client.post(f"{image}/edits", json=body).json()
    monkeypatch.setattr(client.app.state.server.tracer, "trace", None)  # type: ignore[attr-defined]
    assert client.post(f"{image}/edits", json=body).json() == first
    assert client.post(f"{image}/edits", json={**body, "kind": "trim", "at": [150, 60]}).status_code == 409
