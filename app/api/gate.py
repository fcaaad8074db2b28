"""Who asks, and whether they may: answered for every address of the API, before its body is read."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from datetime import datetime
from urllib.parse import unquote_to_bytes

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from app.api.cookies import forget_secrets
from app.api.credentials import Credential, credential_of, identify, is_use_due, record_use
from app.api.deps import Server
from app.api.guard import SAFE_METHODS
from app.api.policy import PREFIX, Request, rule_of
from app.api.problems import problem_of
from app.errors import ClearLinesError, Forbidden, InvalidInput, NotFound, Unauthenticated, Unavailable
from app.services.access import Viewer, can_see_hidden, is_at_least
from app.services.concealing import require_details, require_visible
from app.services.people import checked_person
from app.services.web_sessions import session_rules
from app.settings import Settings

PERSON = "X-ClearLines-Person"
ENTERING = frozenset(
    {("POST", "/session"), ("DELETE", "/session"), ("POST", "/invitations/look"), ("POST", "/invitations/accept")}
)
"""What is asked by those who want to be somebody, or nobody: a secret that is no longer good mustn't be in its way."""


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
        headers = Headers(scope=scope)
        credential = credential_of(headers)
        try:
            viewer = _named(await _admit(server, scope["method"], path, credential, headers), headers)
        except ClearLinesError as error:
            response = problem_of(error)
            # not where none came: a link on another site's page, with which none goes along, would sign people out
            if isinstance(error, Unauthenticated) and credential is not None and credential.in_cookie:
                forget_secrets(response)
            await response(scope, receive, send)
            return
        scope.setdefault("state", {})["viewer"] = viewer
        await self.app(scope, receive, send)


def anonymous_viewer(settings: Settings) -> Viewer:
    """Return who asks without a token."""
    if settings.anonymous == "admin":
        return Viewer(settings.person, "admin", anonymous=True)
    return Viewer(None, "reader", anonymous=True)


def require_own_page(headers: Headers) -> None:
    """Refuse a change in the name of a cookie's holder, unless the browser says which page asks for it.

    Which pages may is checked in ``app.api.guard``. Browsers always say it: what doesn't is no browser.

    Raises:
        Forbidden: When neither Origin nor Sec-Fetch-Site is there.
    """
    if "origin" not in headers and "sec-fetch-site" not in headers:
        raise Forbidden(
            "a change that a cookie stands for must say which page asks for it",
            where="Origin",
            expected="the header Origin or Sec-Fetch-Site, as browsers send it",
            hint="programs send the header Authorization: Bearer cl_...",
        )


async def _admit(server: Server, method: str, path: str, credential: Credential | None, headers: Headers) -> Viewer:
    request = rule_of(method, path)
    anonymous = anonymous_viewer(server.settings)
    is_local = can_see_hidden(anonymous)
    entering = request is not None and (method, request.rule.template) in ENTERING
    if credential is not None and credential.in_cookie:
        if method not in SAFE_METHODS and not entering:
            require_own_page(headers)
        if entering or (is_local and credential.kind == "session"):
            credential = None
    names_nothing = request is None or not (request.named or request.submissions)
    if credential is None and (is_local or names_nothing):  # the database is asked nothing: it may be what is down
        _require_role(anonymous, request)
        _require_account(server.settings, anonymous, request)
        return anonymous
    return await run_in_threadpool(_admitted, server, request, credential, anonymous, server.clock())


def _admitted(
    server: Server, request: Request | None, credential: Credential | None, anonymous: Viewer, now: datetime
) -> Viewer:
    rules = session_rules(server.settings)
    with server.database.read() as session:
        known = identify(session, credential, now, rules) if credential else None
        viewer = known.viewer if known else anonymous
        _require_role(viewer, request)
        _require_account(server.settings, viewer, request)
        if request is not None:
            require_visible(session, viewer, request.named)
            require_details(session, viewer, request.submissions)
    if known is not None and is_use_due(known, now, rules):
        with suppress(Unavailable), server.database.write() as session:  # it is no reason to refuse anybody
            record_use(session, known, now)
    return viewer


def _require_account(settings: Settings, viewer: Viewer, request: Request | None) -> None:
    if request is None or not request.rule.account or viewer.user_id is not None:
        return
    where = f"{request.rule.method} {PREFIX}{request.rule.template}"
    if settings.anonymous == "admin" and viewer.anonymous:
        raise NotFound("there are no accounts in local mode: whoever asks is the owner", where=where)
    if viewer.anonymous:
        raise Unauthenticated("this needs an account", where=where, hint="sign in")
    raise NotFound("a service's token has no account", where=where)


def _require_role(viewer: Viewer, request: Request | None) -> None:
    if request is None:
        if viewer.role != "admin":
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
    if given is None or not viewer.anonymous or viewer.role != "admin":
        return viewer
    try:
        name = unquote_to_bytes(given.encode("ascii")).decode()
    except UnicodeError as error:
        raise InvalidInput("the name can't be read", where=PERSON, expected="UTF-8, percent-encoded") from error
    return replace(viewer, name=checked_person(name, PERSON))
