"""What every request passes before any route sees it: Host, Origin, size; and what every answer carries.

On a loopback address the one owner may do everything, so the danger is a foreign page in the owner's browser: DNS
rebinding (a foreign name that resolves to 127.0.0.1) is stopped by the Host check, cross-site posts by the Origin and
Sec-Fetch-Site checks.
"""

from __future__ import annotations

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import problem_of
from app.errors import ClearLinesError, Forbidden, InvalidInput, TooLarge

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]"})
SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
MAX_DOCUMENT_BYTES = 16 * 2**20
"""Largest body that is no upload of files; the longest list of ids that a route takes needs a quarter of it."""

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
    foreign = origin is not None and origin.lower() not in _own_origins(headers)
    if foreign or site in {"cross-site", "same-site"}:
        raise Forbidden(
            "a page of another site may not change anything here", where=f"Origin: {(origin or site or '')[:200]}"
        )


def _own_origins(headers: Headers) -> set[str]:
    host = headers.get("host", "").lower()
    return {f"http://{host}", f"https://{host}"}


def check_address(scope: Scope) -> None:
    """Refuse addresses with a NUL character, which no name has and no database takes.

    Raises:
        InvalidInput: Where there is one in path or query.
    """
    if "\0" in scope["path"] or b"%00" in scope.get("query_string", b""):
        raise InvalidInput("the address holds a NUL character", where="address", expected="text")


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
            check_address(scope)
            limit = self._limit_of(headers)
            _check_length(headers, limit)
        except ClearLinesError as error:
            await problem_of(error)(scope, receive, send_with_headers)
            return
        await self.app(scope, _bounded(receive, limit), send_with_headers)

    def _limit_of(self, headers: Headers) -> int:
        """Return the largest body to take: files are streamed to the disk, all else is held in memory."""
        is_form = headers.get("content-type", "").lower().startswith("multipart/form-data")
        return self.max_body_bytes if is_form else min(MAX_DOCUMENT_BYTES, self.max_body_bytes)


def _too_large(limit: int) -> TooLarge:
    return TooLarge(
        "the request is larger than this server takes",
        expected=f"at most {limit / 2**20:g} MiB",
        hint="send fewer things at once; for files there is CLEARLINES_MAX_UPLOAD_BYTES",
    )


def _check_length(headers: Headers, limit: int) -> None:
    length = headers.get("content-length")
    if length is None:
        return
    if not length.isdecimal():
        raise InvalidInput("Content-Length is no number", where=f"Content-Length: {length[:40]}")
    if int(length) > limit:
        raise _too_large(limit)


def _bounded(receive: Receive, limit: int) -> Receive:
    received = 0

    async def bounded() -> Message:
        nonlocal received
        message = await receive()
        if message["type"] == "http.request":
            received += len(message.get("body", b""))
            if received > limit:
                raise _too_large(limit)
        return message

    return bounded
