"""Requests that no page of ours sends: each has a clear answer, and none is the server's mistake."""

from __future__ import annotations

import base64
import json
import uuid
from collections.abc import Callable
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.api.guard import MAX_DOCUMENT_BYTES

Upload = Callable[..., dict[str, Any]]
Picture = Callable[[int], bytes]

HUGE = 2**63


@pytest.mark.parametrize("number", [HUGE, -HUGE - 1, 2**31, 0, -1])
def test_a_number_that_is_no_id_is_refused_wherever_an_id_is_asked_for(
    client: TestClient, upload: Upload, picture: Picture, number: int
) -> None:
    image = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    decision = {"client_id": str(uuid.uuid4()), "group_id": str(uuid.uuid4()), "segment_id": number, "verdict": "keep"}
    requests: list[tuple[str, str, Any]] = [
        ("GET", f"/api/images/{number}", None),
        ("GET", f"/api/images/{number}/points", None),
        ("GET", f"/api/images/{number}/thumbnail", None),
        ("DELETE", f"/api/images/{number}", None),
        ("GET", f"/api/runs/{number}/images", None),
        ("POST", f"/api/runs/{number}/retry", None),
        ("PATCH", f"/api/cameras/{number}", {"name": "left"}),
        ("GET", f"/api/datasets/street/images?camera={number}", None),
        ("PATCH", "/api/datasets/street/images", {"ids": [number], "source": "x"}),
        ("POST", "/api/datasets/street/images/delete", {"ids": [image, number]}),
        ("POST", "/api/datasets/street/runs", {"image_ids": [number]}),
        ("POST", f"/api/images/{image}/decisions", {"decisions": [decision]}),
    ]
    for method, path, body in requests:
        answer = client.request(method, path, json=body)
        assert answer.status_code == 422, (method, path, answer.text)
        assert answer.headers["content-type"] == "application/problem+json"
    assert client.get(f"/api/images/{image}").status_code == 200


def cursor(*parts: Any) -> str:
    return base64.urlsafe_b64encode(json.dumps(parts).encode()).decode().rstrip("=")


@pytest.mark.parametrize(
    ("sort", "given"),
    [
        ("name", cursor("name", "x", HUGE)),
        ("name", cursor("name", 5, 1)),
        ("name", cursor("name", "\ud800", 1)),
        ("name", cursor("name", "a\0b", 1)),
        ("candidates", cursor("candidates", HUGE, 1)),
        ("candidates", cursor("candidates", "x", 1)),
        ("candidates", cursor("candidates", float("nan"), 1)),
        ("candidates", cursor("candidates", True, 1)),
        ("created", cursor("created", "0001-01-01T00:00:00+23:59", 1)),
        ("created", cursor("created", "2025-01-01T00:00:00", 1)),
        ("created", cursor("created", 5, 1)),
        ("created", cursor("name", "x", 1)),
        ("name", base64.urlsafe_b64encode(b"[" * 1400).decode()),
    ],
)
def test_a_cursor_of_elsewhere_is_refused(client: TestClient, upload: Upload, sort: str, given: str) -> None:
    client.post("/api/datasets", json={"name": "street"})
    answer = client.get("/api/datasets/street/images", params={"sort": sort, "cursor": given})
    assert answer.status_code == 422, answer.text
    assert answer.json()["where"] == "cursor"


@pytest.mark.parametrize("path", ["/api/datasets/a%00b", "/api/datasets/street/images?search=%00", "/%00"])
def test_a_nul_character_in_an_address_is_refused(client: TestClient, path: str) -> None:
    answer = client.get(path)
    assert answer.status_code == 422
    assert "NUL" in answer.json()["message"]


def test_a_nul_character_in_a_text_is_refused(client: TestClient, upload: Upload, picture: Picture) -> None:
    image = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    texts = [
        ("POST", "/api/datasets", {"name": "a\0b"}),
        ("PATCH", f"/api/images/{image}", {"name": "a\0b"}),
        ("PATCH", f"/api/images/{image}", {"camera": "a\0b"}),
        ("PATCH", f"/api/images/{image}", {"source": "a\0b"}),
        ("PUT", f"/api/images/{image}/review", {"status": "discarded", "reason": "a\0b"}),
    ]
    for method, path, body in texts:
        assert client.request(method, path, json=body).status_code == 422, body
    assert client.get(f"/api/images/{image}").json()["status"] == "open"


def test_head_is_get_without_its_content(client: TestClient, upload: Upload, picture: Picture) -> None:
    image = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    for path in ("/api/health", "/api/datasets", f"/api/images/{image}/original", f"/api/images/{image}/thumbnail"):
        head, get = client.head(path), client.get(path)
        assert (head.status_code, head.content) == (200, b"")
        assert head.headers["content-length"] == get.headers["content-length"]
    assert client.head("/api/nope").status_code == 404


def test_an_address_asked_with_another_method_says_which_ones_it_takes(client: TestClient) -> None:
    answer = client.put("/api/datasets")
    assert answer.status_code == 405
    assert answer.json()["code"] == "method-not-allowed"
    assert answer.headers["allow"] == "GET, POST"
    assert client.put("/api/nope").status_code == 404
    assert client.get("/api", follow_redirects=False).status_code == 404


@pytest.mark.parametrize("kind", ["original", "display", "thumbnail"])
def test_a_tag_is_found_in_a_list_and_weak(client: TestClient, upload: Upload, picture: Picture, kind: str) -> None:
    image = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    path = f"/api/images/{image}/{kind}"
    tag = client.get(path).headers["etag"]
    for held in (tag, f"W/{tag}", f'"other", {tag}', "*"):
        answer = client.get(path, headers={"if-none-match": held})
        assert (answer.status_code, answer.content) == (304, b""), held
        assert answer.headers["etag"] == tag
    for other in ('"other"', tag.strip('"')):
        assert client.get(path, headers={"if-none-match": other}).status_code == 200, other


def test_files_and_points_are_sent_as_they_are_and_in_parts(
    client: TestClient, upload: Upload, picture: Picture
) -> None:
    content = picture(1) + bytes(5000)
    image = upload("street", {"one.png": content})["added"][0]["id"]
    whole = client.get(f"/api/images/{image}/original", headers={"accept-encoding": "gzip"})
    assert "content-encoding" not in whole.headers
    part = client.get(f"/api/images/{image}/original", headers={"range": "bytes=10-4009", "accept-encoding": "gzip"})
    assert part.status_code == 206
    assert part.content == content[10:4010]


def test_an_image_whose_file_is_gone_says_so(client: TestClient, upload: Upload, picture: Picture, settings) -> None:
    image = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    for blob in settings.blob_dir.glob("??/??/*"):
        blob.unlink()
    for kind in ("original", "display", "thumbnail"):
        answer = client.get(f"/api/images/{image}/{kind}")
        assert answer.status_code == 404, kind
        assert answer.json()["code"] == "not-found"


def test_a_document_is_bounded_closer_than_an_upload(client: TestClient) -> None:
    body = b'{"name": "' + b"a" * MAX_DOCUMENT_BYTES + b'"}'
    answer = client.post("/api/datasets", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 413
    assert answer.json()["expected"] == "at most 16 MiB"


@pytest.mark.parametrize("origin", ["http://[bad", "http://", "127.0.0.1:8765", "ftp://127.0.0.1:8765", ""])
def test_an_origin_that_is_none_of_ours_is_refused(client: TestClient, origin: str) -> None:
    assert client.post("/api/datasets", json={"name": "x"}, headers={"origin": origin}).status_code == 403


@pytest.mark.parametrize("body", [b"[" * 100_000, b'{"name":"\xff"}', b'{"name":"\\ud800"}', b'{"name":', b"9" * 5000])
def test_a_body_that_is_no_json_is_a_problem_of_the_client(client: TestClient, body: bytes) -> None:
    answer = client.post("/api/datasets", content=body, headers={"content-type": "application/json"})
    assert answer.status_code in (400, 422)
    assert answer.json()["status"] == answer.status_code
    assert "addresses" not in answer.json().get("hint", "")


def test_hidden_files_alone_are_nothing_to_import(client: TestClient, upload: Upload, picture: Picture) -> None:
    problem = upload("street", {".hidden.png": picture(1), "a/.b/c.png": picture(2)}, status=422)
    assert "no image" in problem["message"]
    assert len(upload("street", {".DS_Store": b"x", "one.png": picture(1)})["added"]) == 1


def test_a_name_is_taken_in_any_case(client: TestClient, upload: Upload, picture: Picture) -> None:
    first, second = (
        upload("street", {name: picture(n)})["added"][0]["id"] for n, name in enumerate(("A.png", "b.png"))
    )
    clash = upload("street", {"a.png": picture(3)}, status=422)
    assert clash["details"]["failed"][0]["error"]["code"] == "conflict"
    assert client.patch(f"/api/images/{second}", json={"name": "a"}).status_code == 409
    assert client.patch(f"/api/images/{first}", json={"name": "a"}).json()["name"] == "a"
    client.delete(f"/api/images/{first}")
    upload("street", {"A.png": picture(4)})
    assert client.post("/api/datasets/street/images/restore", json={"ids": [first]}).status_code == 409


@pytest.mark.parametrize("name", [".hidden", "a/.b/c", "__MACOSX/x", "x" * 230, "é" * 115])
def test_a_name_that_could_not_be_exported_and_imported_again_is_refused(
    client: TestClient, upload: Upload, picture: Picture, name: str
) -> None:
    image = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    assert client.patch(f"/api/images/{image}", json={"name": name}).status_code == 422
