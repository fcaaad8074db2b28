"""Signing in with an OpenID Connect provider."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import HTMLResponse, RedirectResponse

from app.api.cookies import COOKIE_PATH, cookie_of, is_secure
from app.api.deps import ActorDep, Now, Server, ServerDep, ViewerDep
from app.api.entrance import get_entrance, let_in
from app.api.own_paths import own_path
from app.api.problems import answers
from app.api.schemas.openid import OpenIdStart, OpenIdStarted, ProviderAnswer
from app.api.throttle import client_address
from app.errors import ClearLinesError, Forbidden, NotFound, Unauthenticated
from app.openid.flow import LIFETIME, Flow, new_flow
from app.services.access import Viewer
from app.services.identities import enter_identified, link_identified

if TYPE_CHECKING:  # what it imports is installed with the extra alone
    from app.openid.sign_in import OpenIdSignIn

router = APIRouter(prefix="/session", tags=["session"], responses=answers(404, 503))

COOKIE = "clearlines_openid"
START = f"{COOKIE_PATH}/session/openid/start"
CALLBACK = f"{COOKIE_PATH}/session/openid/callback"
FLOW_PATH = f"{COOKIE_PATH}/session/openid"

Text = Annotated[str, Query(max_length=4000)]


@router.get("/providers")
def list_providers(server: ServerDep) -> list[ProviderAnswer]:
    """List the providers that one can sign in with, beside name and password."""
    return [] if server.openid is None else [ProviderAnswer(name=server.openid.name, start=START)]


@router.get("/openid/start", response_class=RedirectResponse, status_code=302, responses=answers(401, 403, 409))
def start_sign_in(
    server: ServerDep,
    viewer: ViewerDep,
    now: Now,
    request: Request,
    next: Annotated[str, Query(max_length=2000)] = "/",  # noqa: A002
    link: Annotated[bool, Query(description="Link the account that is signed in.")] = False,
) -> RedirectResponse:
    """Send the browser to the provider; afterwards it goes on to `next`, a path of this site."""
    get_entrance(request)
    if link:
        _require_own_link(viewer, request)
    flow = new_flow(
        now, next_path=own_path(next), redirect=_redirect(server, request), user_id=viewer.user_id if link else None
    )
    address, kept = _provider(server).begin(flow)
    response = RedirectResponse(address, status_code=302)
    _keep(response, server, request, kept)
    return response


@router.post("/openid/start", responses=answers(409))
def start_with_invitation(
    server: ServerDep, now: Now, request: Request, response: Response, given: OpenIdStart
) -> OpenIdStarted:
    """Return where the browser is to go to be identified, for who has an invitation: its secret is in no address."""
    get_entrance(request)
    secret = None if given.invitation is None else given.invitation.get_secret_value()
    flow = new_flow(now, next_path=own_path(given.next), redirect=_redirect(server, request), invitation=secret)
    address, kept = _provider(server).begin(flow)
    _keep(response, server, request, kept)
    return OpenIdStarted(address=address)


@router.get("/openid/callback", response_class=HTMLResponse, responses=answers(401, 403, 409, 429))
def end_sign_in(
    server: ServerDep,
    actor: ActorDep,
    now: Now,
    request: Request,
    state: Text = "",
    code: Text = "",
    iss: Text | None = None,
    error: Text | None = None,
) -> HTMLResponse:
    """Take the provider's answer, and go on: a page of this site does, so that browsers send the new cookie along."""
    flow: Flow | None = None
    try:
        with server.throttle.signing_in(None, client_address(request.scope)):
            openid = _provider(server)
            flow = openid.flow_of(cookie_of(request.headers, COOKIE), state, now)
            if error is not None or not code:
                raise Unauthenticated("the provider has not signed you in", where=(error or "code")[:100])
            found = openid.identify(flow, code, iss, now)
        response = onward(flow.next)
        if flow.user_id is not None:
            with server.database.write() as session:
                link_identified(session, flow.user_id, found, now, actor)
        else:
            settings = server.settings
            user, made = enter_identified(
                get_entrance(request),
                found,
                role=settings.openid_role,
                invitation=flow.invitation,
                reserved=(settings.person,),
            )
            let_in(request, response, user, made)
    except ClearLinesError as problem:
        # its code, which the page has a sentence for: a text in an address could be anybody's
        page = "/sign-in" if flow is None or flow.user_id is None else "/account"
        response = onward(f"{page}?problem={problem.code}", status=problem.status)
    response.delete_cookie(COOKIE, path=FLOW_PATH, httponly=True, samesite="lax")
    return response


def onward(path: str, *, status: int = 200) -> HTMLResponse:
    """Return a page that goes on to a path of this site by itself.

    A redirect would count as part of the way from the provider, on which browsers send no SameSite=Strict cookie.
    """
    address = escape(path, quote=True)
    page = (
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>ClearLines</title>'
        f'<meta http-equiv="refresh" content="0;url={address}"></head>'
        f'<body><p><a href="{address}">Go on to ClearLines</a></p></body></html>'
    )
    return HTMLResponse(page, status_code=status, headers={"Cache-Control": "no-store"})


def _require_own_link(viewer: Viewer, request: Request) -> None:
    """Refuse to link an account, unless its holder clicks on a page of this site.

    A page of a neighbour's name could send the browser here, with the cookie, after it had signed the browser in at the
    provider as somebody else, who would then have a way into the account.

    Raises:
        Unauthenticated: When nobody is signed in to an account.
        Forbidden: When a page of another site asks.
    """
    if viewer.user_id is None:
        raise Unauthenticated("only one's own account can be linked", hint="sign in first, with name and password")
    if request.headers.get("sec-fetch-site", "same-origin") != "same-origin":
        raise Forbidden("a page of another site may not link an account", hint="begin on your account page")


def _provider(server: Server) -> OpenIdSignIn:
    if server.openid is None:
        raise NotFound("no provider is set up", hint="CLEARLINES_OPENID_ISSUER names one")
    return server.openid


def _redirect(server: Server, request: Request) -> str:
    """Return where the provider sends the browser back to; it has to know this very address."""
    base = server.settings.public_url or str(request.base_url)
    return base.rstrip("/") + CALLBACK


def _keep(response: Response, server: Server, request: Request, kept: str) -> None:
    # Lax, as the way back from the provider comes from another site
    response.set_cookie(
        COOKIE,
        kept,
        max_age=int(LIFETIME.total_seconds()),
        path=FLOW_PATH,
        secure=is_secure(server.settings, request),
        httponly=True,
        samesite="lax",
    )
