"""What browsers keep: the secret of a session, or a token. No script can read it, no other site's page can send it."""

from __future__ import annotations

from starlette.datastructures import Headers
from starlette.requests import Request, cookie_parser
from starlette.responses import Response

from app.api.policy import PREFIX
from app.settings import Settings

SESSION_COOKIE = "clearlines_session"
TOKEN_COOKIE = "clearlines_token"  # noqa: S105
COOKIE_PATH = PREFIX


def remember(response: Response, name: str, secret: str, *, secure: bool, seconds: int | None) -> None:
    """Give a browser a secret to keep, in place of whatever it kept before.

    Args:
        response: The answer.
        name: ``SESSION_COOKIE`` or ``TOKEN_COOKIE``.
        secret: What it is.
        secure: Whether the browser is to send it through nothing but https.
        seconds: How long it is good; until the browser is closed when left out.
    """
    for other in {SESSION_COOKIE, TOKEN_COOKIE} - {name}:
        _forget(response, other)
    response.set_cookie(
        name, secret, max_age=seconds, path=COOKIE_PATH, secure=secure, httponly=True, samesite="strict"
    )


def forget_secrets(response: Response) -> None:
    """Have a browser drop what it keeps."""
    for name in (SESSION_COOKIE, TOKEN_COOKIE):
        _forget(response, name)


def is_secure(settings: Settings, request: Request) -> bool:
    """Whether browsers ask through https, so that no cookie need ever travel without."""
    return request.url.scheme == "https" or (settings.public_url or "").startswith("https:")


def cookie_of(headers: Headers, name: str) -> str:
    """Return a cookie that a request carries; an empty text if there is none."""
    # one that the standard library's parser would stop at, another site's on the same machine, isn't in the way
    return cookie_parser(headers.get("cookie", "")).get(name, "")


def _forget(response: Response, name: str) -> None:
    response.delete_cookie(name, path=COOKIE_PATH, httponly=True, samesite="strict")
