"""Keys, and a small provider that says whatever a test wants, for what a real provider never does."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs

import pytest
from joserfc.jwk import KeySet, RSAKey


@pytest.fixture(scope="session")
def key() -> RSAKey:
    return RSAKey.generate_key(2048, {"kid": "first", "alg": "RS256", "use": "sig"})


@pytest.fixture(scope="session")
def other_key() -> RSAKey:
    return RSAKey.generate_key(2048, {"kid": "second", "alg": "RS256", "use": "sig"})


class SmallProvider:
    """Answers as a provider does, with the keys and the answer to a code that it was given.

    Attributes:
        asked: Paths, in the order they were asked.
        forms: What was posted.
        keys: Whose public halves it tells.
        answer: Status and content of the answer to a code.
        told: What it tells of itself beside the usual.
        person: What it tells of a person.
    """

    def __init__(self, keys: list[RSAKey]) -> None:
        self.asked: list[str] = []
        self.forms: list[dict[str, list[str]]] = []
        self.keys = keys
        self.answer: tuple[int, dict[str, Any]] = (400, {"error": "invalid_grant"})
        self.told: dict[str, Any] = {}
        self.person: dict[str, Any] = {}
        provider = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                provider.asked.append(self.path)
                self._send(200, provider._document(self.path))

            def do_POST(self) -> None:
                content = self.rfile.read(int(self.headers["content-length"])).decode()
                provider.forms.append(parse_qs(content) | {"authorization": [self.headers["authorization"]]})
                self._send(*provider.answer)

            def _send(self, status: int, content: dict[str, Any]) -> None:
                body = json.dumps(content).encode()
                self.send_response(status)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, format: str, *_: Any) -> None:  # noqa: A002
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.issuer = f"http://127.0.0.1:{self._server.server_port}"
        threading.Thread(target=self._server.serve_forever, args=(0.02,), daemon=True).start()

    def stop(self) -> None:
        self._server.shutdown()
        self._server.server_close()

    def _document(self, path: str) -> dict[str, Any]:
        if path == "/keys":
            return {**KeySet([*self.keys]).as_dict(private=False)}
        if path == "/person":
            return self.person
        return {
            "issuer": self.issuer,
            "authorization_endpoint": f"{self.issuer}/authorize?tenant=1",
            "token_endpoint": f"{self.issuer}/token",
            "jwks_uri": f"{self.issuer}/keys",
            "id_token_signing_alg_values_supported": ["RS256", "HS256", "none"],
            **self.told,
        }


@pytest.fixture
def small_provider(key: RSAKey) -> Iterator[SmallProvider]:
    provider = SmallProvider([key])
    yield provider
    provider.stop()
