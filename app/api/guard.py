"""What every request passes before any route sees it: Host, Origin, size; and what every answer carries.

On a loopback address the one owner may do everything, so the danger is a foreign page in the owner's browser: DNS
rebinding (a foreign name that resolves to 127.0.0.1) is stopped by the Host check, cross-site posts by the Origin and
Sec-Fetch-Site checks.
"""

from __future__ import annotations

from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import problem_of
from app.errors import ClearLinesError, Forbidden, InvalidInput, TooLarge

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]"})
SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
ANSWER_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Content-Security-Policy": (
        "default-src 'self'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
        "worker-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
    ),
}


def host_name(host: str) -> str:
    """Return the name of a Host header without its port; an IPv6 address keeps its brackets."""
    if host.startswith("["):
        return host.partition("]")[0].lower() + "]"
    return host.partition(":")[0].lower()


def check_host(headers: Headers) -> None:
    """Refuse names that aren't this machine's loopback.

    Raises:
        Forbidden: Where the Host header is missing or names another host.
    """
    host = headers.get("host", "")
    if host_name(host) not in LOOPBACK_NAMES:
        raise Forbidden(
            "this server answers on its loopback address only",
            where=f"Host: {host[:200]}",
            expected="localhost, 127.0.0.1 or [::1]",
        )


def check_origin(method: str, headers: Headers) -> None:
    """Refuse changes that another site's page asks for.

    Raises:
        Forbidden: Where Origin or Sec-Fetch-Site say that the request comes from elsewhere.
    """
    if method in SAFE_METHODS:
        return
    site = headers.get("sec-fetch-site")
    origin = headers.get("origin")
    foreign = origin is not None and urlsplit(origin).netloc.lower() != headers.get("host", "").lower()
    if foreign or site in {"cross-site", "same-site"}:
        raise Forbidden(
            "a page of another site may not change anything here", where=f"Origin: {(origin or site or '')[:200]}"
        )


class Guard:
    """ASGI middleware: the checks above, a bound on the body while it streams, and the headers of every answer."""

    def __init__(self, app: ASGIApp, *, max_body_bytes: int) -> None:
        self.app = app
        self.max_body_bytes = max_body_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, refuse, or pass on one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                answer = MutableHeaders(scope=message)
                for name, value in ANSWER_HEADERS.items():
                    answer.setdefault(name, value)
            await send(message)

        try:
            check_host(headers)
            check_origin(scope["method"], headers)
            self._check_length(headers)
        except ClearLinesError as error:
            await problem_of(error)(scope, receive, send_with_headers)
            return
        await self.app(scope, self._bounded(receive), send_with_headers)

    def _too_large(self) -> TooLarge:
        return TooLarge(
            "the request is larger than this server takes",
            expected=f"at most {self.max_body_bytes // 2**20} MiB",
            hint="send fewer files at once, or raise CLEARLINES_MAX_UPLOAD_BYTES",
        )

    def _check_length(self, headers: Headers) -> None:
        length = headers.get("content-length")
        if length is None:
            return
        if not length.isdecimal():
            raise InvalidInput("Content-Length is no number", where=f"Content-Length: {length[:40]}")
        if int(length) > self.max_body_bytes:
            raise self._too_large()

    def _bounded(self, receive: Receive) -> Receive:
        received = 0

        async def bounded() -> Message:
            nonlocal received
            message = await receive()
            if message["type"] == "http.request":
                received += len(message.get("body", b""))
                if received > self.max_body_bytes:
                    raise self._too_large()
            return message

        return bounded
