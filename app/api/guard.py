"""What every request passes before any route sees it: Host, Origin, size; and what every answer carries.

On a loopback address the one owner may do everything, so the danger is a foreign page in the owner's browser: DNS
rebinding (a foreign name that resolves to 127.0.0.1) is stopped by the Host check, cross-site posts by the Origin and
Sec-Fetch-Site checks. Where others can reach the server the same checks keep a foreign page from using what a browser
is signed in with.
"""

from __future__ import annotations

import asyncio

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.origins import OwnNames
from app.api.problems import problem_of
from app.errors import ClearLinesError, Forbidden, InvalidInput, TooLarge, TooSlow

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
MAX_DOCUMENT_BYTES = 16 * 2**20
"""Largest body that is no upload of files; the longest list of ids that a route takes needs a quarter of it."""
SILENCE = 60.0
"""How long a body may pause, in s, before nobody waits for the rest of it."""

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
PROXIES_SAY = ("x-forwarded-for", "x-forwarded-host", "forwarded", "x-real-ip", "via")
"""Headers that tell of a proxy."""
TLS_HEADERS = {"Strict-Transport-Security": "max-age=31536000"}
"""Where it is served with TLS: browsers ask this name with nothing else, for a year."""


def check_host(headers: Headers, own: OwnNames) -> None:
    """Refuse names that aren't this server's.

    Raises:
        Forbidden: Where the Host header is missing or names another host.
    """
    host = headers.get("host", "")
    if own.has(host):
        return
    if own.numbers:
        raise Forbidden(
            "this server isn't called that",
            where=f"Host: {host[:200]}",
            hint="clearlines serve --public-url https://NAME says how it is; CLEARLINES_ALLOWED_HOSTS takes more names",
        )
    raise Forbidden(
        "this server answers on its loopback address only",
        where=f"Host: {host[:200]}",
        expected="localhost, 127.0.0.1 or [::1]",
    )


def check_direct(headers: Headers, own: OwnNames) -> None:
    """Refuse what a proxy passes on in local mode: others ask through it, and whoever asks would be the owner.

    Raises:
        Forbidden: Where the request came through a proxy.
    """
    if own.has_accounts:
        return
    name = next((name for name in PROXIES_SAY if name in headers), None)
    if name is not None:
        raise Forbidden(
            "a proxy passes this on, and there are no accounts",
            where=name,
            hint="clearlines serve --public-url https://NAME requires accounts",
        )


def check_origin(method: str, headers: Headers, own: OwnNames) -> None:
    """Refuse changes that another site's page asks for.

    Raises:
        Forbidden: Where Origin or Sec-Fetch-Site say that the request comes from elsewhere.
    """
    if method in SAFE_METHODS:
        return
    site = headers.get("sec-fetch-site")
    origin = headers.get("origin")
    if origin is not None and own.may_ask(origin, headers):
        return
    foreign = origin is not None and not own.is_own(origin, headers.get("host", ""))
    if foreign or site in {"cross-site", "same-site"}:
        raise Forbidden(
            "a page of another site may not change anything here", where=f"Origin: {(origin or site or '')[:200]}"
        )


def check_address(scope: Scope) -> None:
    """Refuse addresses with a NUL character, which no name has and no database takes.

    Raises:
        InvalidInput: Where there is one in path or query.
    """
    if "\0" in scope["path"] or b"%00" in scope.get("query_string", b""):
        raise InvalidInput("the address holds a NUL character", where="address", expected="text")


class Guard:
    """ASGI middleware: the checks above, bounds on the body while it streams, and the headers of every answer.

    Args:
        app: What answers.
        own: What the server is called.
        max_body_bytes: Longest body.
        silence: How long a body may pause, in s.
    """

    def __init__(self, app: ASGIApp, *, own: OwnNames, max_body_bytes: int, silence: float = SILENCE) -> None:
        self.app = app
        self.own = own
        self.max_body_bytes = max_body_bytes
        self.silence = silence
        has_tls = (own.public_origin or "").startswith("https:")
        self.answer_headers = ANSWER_HEADERS | (TLS_HEADERS if has_tls else {})

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, refuse, or pass on one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                answer = MutableHeaders(scope=message)
                for name, value in self.answer_headers.items():
                    answer.setdefault(name, value)
            await send(message)

        try:
            check_host(headers, self.own)
            check_direct(headers, self.own)
            check_origin(scope["method"], headers, self.own)
            check_address(scope)
            limit = self._limit_of(headers)
            _check_length(headers, limit)
        except ClearLinesError as error:
            await problem_of(error)(scope, receive, send_with_headers)
            return
        await self.app(scope, _bounded(receive, limit, self.silence), send_with_headers)

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


def _bounded(receive: Receive, limit: int, silence: float) -> Receive:
    received = 0
    is_whole = False

    async def bounded() -> Message:
        nonlocal received, is_whole
        if is_whole:  # what is waited for now is the end of the connection
            return await receive()
        try:
            async with asyncio.timeout(silence):
                message = await receive()
        except TimeoutError:
            raise TooSlow(
                "the rest of the request didn't come",
                expected=f"no pause longer than {silence:g} s",
                hint="try again, on a connection that holds",
            ) from None
        is_whole = not message.get("more_body", False)
        if message["type"] == "http.request":
            received += len(message.get("body", b""))
            if received > limit:
                raise _too_large(limit)
        return message

    return bounded
