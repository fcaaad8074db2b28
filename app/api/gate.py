"""Who asks, and whether they may: answered for every address of the API, before its body is read."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from http.cookies import CookieError, SimpleCookie
from urllib.parse import unquote_to_bytes

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app.api.deps import Server
from app.api.policy import PREFIX, Request, rule_of
from app.api.problems import problem_of
from app.errors import ClearLinesError, Forbidden, InvalidInput, NotFound, Unauthenticated
from app.services.access import Viewer, can_see_hidden, is_at_least
from app.services.concealing import require_details, require_visible
from app.services.people import checked_person
from app.services.tokens import is_use_due, record_use, token_of, viewer_of
from app.settings import Settings

COOKIE = "clearlines_token"
COOKIE_PATH = PREFIX
PERSON = "X-ClearLines-Person"
SIGNING_IN = "/session"


class Gate:
    """ASGI middleware: finds the viewer, and lets pass what the policy allows; the viewer goes along in the state.

    A middleware and no dependency of the routes: those are asked when the framework has read the whole body already,
    and what nobody may send isn't to fill the disk first.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, refuse, or pass on one request."""
        path = scope.get("path", "")
        if scope["type"] != "http" or not (path == PREFIX or path.startswith(PREFIX + "/")):
            await self.app(scope, receive, send)
            return
        server: Server = scope["app"].state.server
        request = rule_of(scope["method"], path)
        headers = Headers(scope=scope)
        given = _bearer(headers) or ("" if _is_signing(request) else _cookie(headers))
        try:
            viewer = _named(await self._admit(server, request, given), headers)
        except ClearLinesError as error:
            response = problem_of(error)
            if isinstance(error, Unauthenticated):
                forget_token(response)
            await response(scope, receive, send)
            return
        scope.setdefault("state", {})["viewer"] = viewer
        await self.app(scope, receive, send)

    async def _admit(self, server: Server, request: Request | None, token: str) -> Viewer:
        anonymous = anonymous_viewer(server.settings)
        if not token and can_see_hidden(anonymous):  # local mode asks the database nothing
            _require_role(anonymous, request)
            return anonymous
        return await run_in_threadpool(_admitted, server, request, token, anonymous, server.clock())


def anonymous_viewer(settings: Settings) -> Viewer:
    """Return who asks without a token."""
    if settings.anonymous_role == "owner":
        return Viewer(settings.person, "owner", anonymous=True)
    return Viewer(None, "reader", anonymous=True)


def remember_token(response: Response, token: str, *, secure: bool, seconds: int | None) -> None:
    """Give a browser the token to keep; no script can read it, no other site's page can send it.

    Args:
        response: The answer.
        token: What it is.
        secure: Whether the browser asks through https and is to send it through nothing else.
        seconds: How long it is good; until the browser is closed when left out.
    """
    response.set_cookie(
        COOKIE, token, max_age=seconds, path=COOKIE_PATH, secure=secure, httponly=True, samesite="strict"
    )


def forget_token(response: Response) -> None:
    """Have a browser drop the token that it keeps."""
    response.delete_cookie(COOKIE, path=COOKIE_PATH, httponly=True, samesite="strict")


def _admitted(server: Server, request: Request | None, token: str, anonymous: Viewer, now: datetime) -> Viewer:
    with server.database.read() as session:
        known = token_of(session, token, now) if token else None
        viewer = viewer_of(known) if known else anonymous
        _require_role(viewer, request)
        if request is not None:
            require_visible(session, viewer, request.named)
            require_details(session, viewer, request.submissions)
    if known is not None and is_use_due(known, now):
        with server.database.write() as session:
            record_use(session, known.id, now)
    return viewer


def _require_role(viewer: Viewer, request: Request | None) -> None:
    if request is None:
        if viewer.role != "owner":
            raise NotFound("there is nothing at this address", hint="/api/docs lists the addresses")
    elif not is_at_least(viewer, request.rule.role):
        if viewer.anonymous:
            raise Unauthenticated(
                "this needs a token",
                where=f"{request.rule.method} {PREFIX}{request.rule.template}",
                expected=f"the role {request.rule.role}",
                hint="sign in, or send the header Authorization: Bearer cl_...",
            )
        raise Forbidden(
            f"the role {viewer.role} may not do this",
            where=f"{request.rule.method} {PREFIX}{request.rule.template}",
            expected=f"the role {request.rule.role}",
        )


def _named(viewer: Viewer, headers: Headers) -> Viewer:
    """Return the viewer under the name that the page sends: only the owner without a token chooses one."""
    given = headers.get(PERSON)
    if given is None or not viewer.anonymous or viewer.role != "owner":
        return viewer
    try:
        name = unquote_to_bytes(given.encode("ascii")).decode()
    except UnicodeError as error:
        raise InvalidInput("the name can't be read", where=PERSON, expected="UTF-8, percent-encoded") from error
    return replace(viewer, name=checked_person(name, PERSON))


def _is_signing(request: Request | None) -> bool:
    """Whether the request signs in or out: a token that is no longer good mustn't be in its way."""
    return request is not None and request.rule.template == SIGNING_IN


def _bearer(headers: Headers) -> str:
    scheme, _, token = headers.get("authorization", "").partition(" ")
    return token.strip() if scheme.lower() == "bearer" else ""


def _cookie(headers: Headers) -> str:
    try:
        found = SimpleCookie(headers.get("cookie", "")).get(COOKIE)
    except CookieError:
        return ""
    return found.value if found else ""
