"""Who may hand in, see and change what."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.services.tokens import create_token


@pytest.fixture(scope="module")
def sign(client: TestClient) -> Callable[[str, str], dict[str, str]]:
    """Return the header of somebody of a role."""
    server = client.app.state.server  # type: ignore[attr-defined]
    known: dict[str, dict[str, str]] = {}

    def sign(name: str, role: str) -> dict[str, str]:
        if name not in known:
            with server.database.write() as session:
                made = create_token(session, name, role, datetime.now(UTC), person=None)
            known[name] = {"Authorization": f"Bearer {made.text}"}
        return known[name]

    return sign


def read(client: TestClient, path: str, headers: dict[str, str], status: int = 200) -> Any:
    answer = client.get(f"/api/{path}", headers=headers)
    assert answer.status_code == status, answer.text
    return answer.json() if answer.headers["content-type"].startswith("application/json") else None


def test_a_reader_sees_what_is_public_and_changes_nothing(field, perfect_results, sign, client: TestClient) -> None:
    author, reader = sign("ann", "submitter"), sign("rea", "reader")
    mine = field.submit(perfect_results, headers=author, anonymous="true", method="Ann's lines")
    field.finished(mine["id"])
    seen = read(client, f"submissions/{mine['id']}", reader)
    assert (seen["person"], seen["mine"], seen["log"]) == (None, False, [])
    assert not any(seen["can"][name] for name in ("withdraw", "rescore"))
    assert read(client, f"submissions/{mine['id']}", author)["person"] == "ann"
    assert read(client, f"splits/{field.split}/board", reader)["rows"][0]["person"] is None
    for method, path, body in (
        ("POST", f"submissions/{mine['id']}/withdraw", None),
        ("PATCH", f"submissions/{mine['id']}", {"visibility": "private"}),
        ("PATCH", f"methods/{mine['method']['slug']}", {"name": "Stolen"}),
        ("POST", f"submissions/{mine['id']}/rescore", None),
    ):
        for other in (reader, sign("bob", "submitter")):
            answer = client.request(method, f"/api/{path}", json=body, headers=other)
            assert answer.status_code == 403, f"{method} {path}: {answer.text}"
    field.submit(perfect_results, headers=reader, status=403)
    # others may not hand in under the method's name
    field.submit(perfect_results, headers=sign("bob", "submitter"), method=mine["method"]["slug"], status=403)

    assert (
        client.patch(f"/api/submissions/{mine['id']}", json={"visibility": "private"}, headers=author).status_code
        == 200
    )
    read(client, f"submissions/{mine['id']}", reader, 404)
    read(client, f"methods/{mine['method']['slug']}", reader, 404)
    assert read(client, f"splits/{field.split}/submissions", reader)["total"] == 0
    assert read(client, f"splits/{field.split}/submissions?mine=true", author)["total"] == 1
    revealed = client.patch(f"/api/methods/{mine['method']['slug']}", json={"anonymous": False}, headers=author)
    assert revealed.json()["person"] == "ann"
    again = client.patch(f"/api/methods/{mine['method']['slug']}", json={"anonymous": True}, headers=author)
    assert again.status_code == 409


def test_a_hidden_split_tells_three_rounded_numbers(make_field, half_results, sign, client: TestClient) -> None:
    hidden = make_field("hidden")
    author = sign("ann", "submitter")
    mine = hidden.submit(half_results, headers=author)
    whole = hidden.finished(mine["id"])
    assert len(whole["scores"][0]["totals"]) > 20
    seen = read(client, f"submissions/{mine['id']}", author)
    totals = seen["scores"][0]["totals"]
    assert set(totals) == {"f1", "precision", "recall"}
    assert totals["precision"]["value"] == 0.667
    assert [seen[name] for name in ("strata", "error_types", "cameras", "f1_grid")] == [None] * 4
    assert not seen["can"]["see_details"]
    board = read(client, f"splits/{hidden.split}/board", author)
    assert set(board["rows"][0]["totals"]) == {"f1", "precision", "recall"}
    assert board["rows"][0]["warning"] is None
    image = read(client, f"submissions/{mine['id']}/images", {})["items"][0]["image_id"]
    here = f"submissions/{mine['id']}"
    for path in (
        *(f"{here}/images", f"{here}/matches", f"{here}/compare/{mine['id']}", f"{here}/images/{image}"),
        *(f"{here}/images/{image}/points", f"{here}/images/{image}/overlay.png"),
    ):
        read(client, path, author, 404)
    sent = client.post(f"/api/{here}/images/{image}/review", json={"predictions": [2]})
    assert sent.status_code == 409
    assert client.get(f"/api/{here}/file", headers=author).status_code == 200
    assert client.get(f"/api/{here}/file", headers=sign("bob", "submitter")).status_code == 404


def test_a_hidden_board_shows_a_new_best_only_beyond_its_noise(
    make_field, half_results, perfect_results, sign, client: TestClient
) -> None:
    hidden = make_field("hidden", daily_limit=9)
    author = sign("cleo", "submitter")

    def shown(content: bytes, label: str) -> str:
        hidden.finished(hidden.submit(content, headers=author, label=label, method="Ladder")["id"])
        return read(client, f"splits/{hidden.split}/board", author)["rows"][0]["label"]

    assert shown(half_results, "first") == "first"
    assert shown(half_results, "the same again") == "first"
    assert shown(perfect_results, "better") == "better"
    assert shown(half_results, "worse") == "better"


def test_failed_and_invalid_ones_are_not_charged(make_field, half_results, sign, client: TestClient) -> None:
    split = make_field(daily_limit=2)
    author = sign("dan", "submitter")
    for _ in range(3):
        split.submit(b"rubbish", headers=author, status=422)
    first = split.submit(half_results, headers=author)
    split.finished(first["id"])
    # the numbers have been seen: taking it back gives nothing back
    assert client.post(f"/api/submissions/{first['id']}/withdraw", headers=author).status_code == 200
    split.submit(half_results, headers=author)
    refused = split.submit(half_results, headers=author, status=429)
    assert refused["code"] == "too-many"
    # others, maintainers and checks aren't held up
    split.submit(half_results, headers=sign("eve", "submitter"))
    split.submit(half_results)
    files = [("files", ("a.zip", half_results))]
    answer = client.post(f"/api/splits/{split.split}/submissions/validate", files=files, headers=author)
    assert answer.status_code == 200


def test_a_closed_split_takes_nothing(make_field, half_results, sign) -> None:
    split = make_field(closes_at="2020-01-01T00:00:00Z")
    split.submit(half_results, headers=sign("ann", "submitter"), status=409)
