"""Who is let in: the Host, Origin and size checks, and what every answer carries."""

from __future__ import annotations

import pytest
from fastapi.testclient import TestClient

from app.api.application import create_application
from app.settings import Settings


@pytest.mark.parametrize("host", ["localhost:8765", "127.0.0.1", "[::1]:9000", "LOCALHOST"])
def test_loopback_names_are_answered(client: TestClient, host: str) -> None:
    assert client.get("/api/health", headers={"host": host}).status_code == 200


@pytest.mark.parametrize("host", ["evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "", "10.0.0.1"])
def test_a_foreign_name_is_refused_whatever_it_resolves_to(client: TestClient, host: str) -> None:
    answer = client.get("/api/health", headers={"host": host})
    assert answer.status_code == 403
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "https://evil.example"},
        {"origin": "null"},
        {"origin": "http://127.0.0.1:9999"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ],
)
def test_a_change_asked_for_by_another_site_is_refused(client: TestClient, headers: dict[str, str]) -> None:
    answer = client.post("/api/datasets", json={"name": "x"}, headers=headers)
    assert answer.status_code == 403
    assert client.get("/api/datasets").json() == []


@pytest.mark.parametrize("header", ["X-Forwarded-For", "X-Forwarded-Host", "Forwarded", "X-Real-IP", "Via"])
def test_who_comes_through_a_proxy_is_not_taken_for_the_owner(client: TestClient, header: str) -> None:
    answer = client.get("/api/datasets", headers={header: "192.0.2.1"})
    assert answer.status_code == 403
    assert "--public-url" in answer.json()["hint"]


def test_a_change_asked_for_by_our_own_page_is_made(client: TestClient) -> None:
    headers = {"origin": "http://127.0.0.1:8765", "sec-fetch-site": "same-origin"}
    assert client.post("/api/datasets", json={"name": "x"}, headers=headers).status_code == 201


def test_every_answer_carries_the_headers_that_bind_the_browser(client: TestClient) -> None:
    for path in ("/api/health", "/api/nope"):
        headers = client.get(path).headers
        assert headers["x-content-type-options"] == "nosniff"
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert "unsafe-inline" not in headers["content-security-policy"]


def test_a_body_over_the_limit_is_refused_by_its_length_and_while_it_streams(settings: Settings) -> None:
    small = settings.model_copy(update={"max_upload_bytes": 5_000})
    with TestClient(create_application(small), base_url="http://127.0.0.1:8765") as client:
        client.post("/api/datasets", json={"name": "x"})
        known = client.post("/api/datasets/x/images", files=[("files", ("a.png", b"0" * 6_000))])
        assert known.status_code == 413
        assert known.json()["code"] == "too-large"

        def pieces():
            yield b'{"name": "'
            for _ in range(20):
                yield b"a" * 1_000
            yield b'"}'

        streamed = client.post("/api/datasets", content=pieces(), headers={"content-type": "application/json"})
        assert streamed.status_code == 413
        assert streamed.json()["code"] == "too-large"


def test_unknown_addresses_of_the_api_are_not_the_browser_tool(client: TestClient) -> None:
    for method in ("GET", "POST", "PUT", "PATCH", "DELETE"):
        answer = client.request(method, "/api/nope")
        assert answer.status_code == 404, method
        assert answer.json()["code"] == "not-found"


def test_a_wrong_method_and_a_wrong_body_have_the_same_form_of_error(client: TestClient) -> None:
    wrong_body = client.post("/api/datasets", json={"nam": "x"})
    assert wrong_body.status_code == 422
    assert wrong_body.json()["code"] == "invalid-request"
    assert {error["where"] for error in wrong_body.json()["details"]["errors"]} == {"body.name", "body.nam"}
    wrong_number = client.get("/api/images/abc")
    assert wrong_number.status_code == 422
    assert wrong_number.headers["content-type"] == "application/problem+json"


def test_the_openapi_document_has_an_example_for_every_body(client: TestClient) -> None:
    document = client.get("/api/openapi.json").json()
    schemas = document["components"]["schemas"]
    contents = [
        content["schema"]
        for path in document["paths"].values()
        for operation in path.values()
        for kind, content in operation.get("requestBody", {}).get("content", {}).items()
        if kind == "application/json"
    ]
    bodies = {choice["$ref"].rpartition("/")[2] for schema in contents for choice in schema.get("anyOf", [schema])}
    assert bodies
    assert not [name for name in bodies if "example" not in schemas[name]]
