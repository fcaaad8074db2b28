"""Requests are counted, and those that are too many refused: see `app.api.throttle`."""

from __future__ import annotations

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.policy import PREFIX
from app.api.problems import problem_of
from app.api.throttle import Throttle, client_address
from app.errors import TooMany
from app.services.access import Viewer

UNCOUNTED = frozenset({f"{PREFIX}/health", f"{PREFIX}/ready"})
UNKNOWN = 401


class ThrottledRefusals:
    """ASGI middleware outside the gate: who sends too many tokens or sessions that aren't good isn't looked at."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, or refuse, one request."""
        if not _is_counted(scope):
            await self.app(scope, receive, send)
            return
        throttle: Throttle = scope["app"].state.server.throttle
        address = client_address(scope)
        try:
            throttle.require_known(address)
        except TooMany as error:
            await problem_of(error)(scope, receive, send)
            return

        async def watched_send(message: Message) -> None:
            if message["type"] == "http.response.start" and message["status"] == UNKNOWN:
                throttle.refused(address)
            await send(message)

        await self.app(scope, receive, watched_send)


class Throttled:
    """ASGI middleware inside the gate: counts requests and uploads by account, or by address without one."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, or refuse, one request."""
        if not _is_counted(scope):
            await self.app(scope, receive, send)
            return
        throttle: Throttle = scope["app"].state.server.throttle
        asker = _asker(scope)
        try:
            standing = throttle.request(asker)
            if _is_upload(scope):
                standing = throttle.upload(asker)
        except TooMany as error:
            await problem_of(error)(scope, receive, send)
            return
        told = standing.as_headers() if standing is not None else {}

        async def send_with_standing(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(told)
            await send(message)

        await self.app(scope, receive, send_with_standing)


def _is_counted(scope: Scope) -> bool:
    path = scope.get("path", "")
    return scope["type"] == "http" and path.startswith(f"{PREFIX}/") and path not in UNCOUNTED


def _is_upload(scope: Scope) -> bool:
    return Headers(scope=scope).get("content-type", "").lower().startswith("multipart/form-data")


def _asker(scope: Scope) -> str:
    viewer: Viewer | None = scope.get("state", {}).get("viewer")
    if viewer is None or viewer.anonymous:
        return f"address {client_address(scope)}"
    return f"token {viewer.name}" if viewer.user_id is None else f"account {viewer.user_id}"
