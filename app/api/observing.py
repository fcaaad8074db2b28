"""Each request is watched: it has an id, and is logged and counted when it was answered; what goes wrong is told.

The log names an address by its template, ``/api/images/{image_id}``, so that no query and no part of an address that
only its reader should know gets into it.
"""

from __future__ import annotations

import logging
import re
import time
import uuid
from collections.abc import Callable

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from structlog.contextvars import bound_contextvars

from app.api.metrics import Metrics
from app.api.policy import PREFIX, rule_of
from app.api.problems import mistake_of

REQUEST_ID = "X-Request-ID"
GIVEN_ID = re.compile(r"[A-Za-z0-9-]{8,64}")
QUIET = frozenset({f"{PREFIX}/health", f"{PREFIX}/ready", f"{PREFIX}/metrics", "page"})
"""Templates that machines ask all the time, and files: logged where everything is."""
GONE = 499
"""Logged, never sent, where the client went away in the middle of its request."""
METHODS = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})

logger = logging.getLogger(__name__)


class Observed:
    """ASGI middleware: gives each request an id, and logs and counts it.

    Args:
        app: What answers.
        metrics: Where it is counted.
        level: At which a request is logged that went well, as of ``logging``.
        new_id: Makes an id.
    """

    def __init__(
        self, app: ASGIApp, *, metrics: Metrics, level: int, new_id: Callable[[], str] = lambda: uuid.uuid4().hex
    ) -> None:
        self.app = app
        self.metrics = metrics
        self.level = level
        self.new_id = new_id

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        given = Headers(scope=scope).get(REQUEST_ID, "")
        request_id = given if GIVEN_ID.fullmatch(given) else self.new_id()
        state = scope.setdefault("state", {})
        state["request_id"] = request_id
        status = GONE

        async def send_with_id(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                MutableHeaders(scope=message)[REQUEST_ID] = request_id
            await send(message)

        async def counted_receive() -> Message:
            message = await receive()
            self.metrics.upload_received(len(message.get("body", b"")))
            return message

        is_upload = Headers(scope=scope).get("content-type", "").lower().startswith("multipart/form-data")
        template = template_of(scope["method"], scope["path"])
        began = time.perf_counter()
        self.metrics.request_began()
        with bound_contextvars(request_id=request_id):
            try:
                await self.app(scope, counted_receive if is_upload else receive, send_with_id)
            finally:
                seconds = time.perf_counter() - began
                method = scope["method"] if scope["method"] in METHODS else "other"
                self.metrics.request_ended(method, template, status, seconds)
                self._log(scope, template, status, seconds)

    def _log(self, scope: Scope, template: str, status: int, seconds: float) -> None:
        level = logging.DEBUG if template in QUIET and status < 400 else self.level
        if not logger.isEnabledFor(level):
            return
        viewer = scope["state"].get("viewer")
        facts = {
            "method": scope["method"],
            "path": template,
            "status": status,
            "ms": round(seconds * 1000, 1),
            "viewer": getattr(viewer, "name", None),
        }
        logger.log(level, "request", extra=facts)


class Mishaps:
    """ASGI middleware: errors that nobody foresaw are logged, and answered with a problem document."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        begun = False

        async def watched_send(message: Message) -> None:
            nonlocal begun
            begun = True
            await send(message)

        try:
            await self.app(scope, receive, watched_send)
        except ClientDisconnect:
            logger.info("the client went away")
        except Exception:
            template = template_of(scope["method"], scope["path"])
            logger.exception("%s failed", template, extra={"method": scope["method"], "path": template})
            if begun:
                raise  # the connection is cut, so that nobody takes half an answer for a whole one
            await mistake_of(scope["state"]["request_id"])(scope, receive, send)


def template_of(method: str, path: str) -> str:
    """Return what stands for an address where it is logged and counted: one of a bounded number of words."""
    if path == "/metrics":
        return f"{PREFIX}/metrics"
    if path != PREFIX and not path.startswith(f"{PREFIX}/"):
        return "page"
    found = rule_of(method, path)
    return f"{PREFIX}{found.rule.template}" if found is not None else f"{PREFIX}/?"
