"""Methods: what authors call their detectors; found or made by a submission, changed by their owners."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any
from urllib.parse import urlsplit

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Method, Submission
from app.errors import Conflict, Forbidden, InvalidInput, NotFound
from app.services.access import Viewer, can_maintain
from app.services.events import record_event
from app.services.given import UNCHANGED, Unchanged, checked_name, checked_text
from app.services.slugs import free_slug, slug_of
from app.services.submission_access import is_mine, require_author, shown_person, visible_submissions

URL_LENGTH = 2_000


@dataclass(frozen=True)
class MethodGiven:
    """What a submission says of its method; of a method that is there already it only fills in what is missing."""

    name: str
    description: str | None = None
    code_url: str | None = None
    paper_url: str | None = None
    anonymous: bool = False
    kind: str = "method"


@dataclass(frozen=True)
class MethodChanges:
    """What to change of a method; a field that is left out stays as it is."""

    name: str | Unchanged = UNCHANGED
    description: str | Unchanged | None = UNCHANGED
    code_url: str | Unchanged | None = UNCHANGED
    paper_url: str | Unchanged | None = UNCHANGED
    anonymous: bool | Unchanged = UNCHANGED


@dataclass(frozen=True)
class MethodView:
    """A method as a viewer may see it; ``person`` is ``None`` while it is anonymous."""

    slug: str
    name: str
    kind: str
    description: str | None
    code_url: str | None
    paper_url: str | None
    person: str | None
    anonymous: bool
    mine: bool


def find_or_add_method(session: Session, viewer: Viewer, given: MethodGiven, now: datetime) -> Method:
    """Return the viewer's method of a name or slug; it is made if there is none.

    Raises:
        InvalidInput: Naming the field that can't be.
        Forbidden: When the method of this slug is someone else's.
    """
    name = checked_name(given.name)
    code_url, paper_url = checked_url(given.code_url, "code_url"), checked_url(given.paper_url, "paper_url")
    description = checked_text(given.description, "description")
    same_name = Method.owner.is_(None) if viewer.name is None else Method.owner == viewer.name
    method = session.scalars(
        select(Method).where(Method.name == name, Method.kind == given.kind, same_name).order_by(Method.id).limit(1)
    ).one_or_none()
    if method is None and name.isascii():
        method = session.scalars(select(Method).where(Method.slug == name)).one_or_none()
        if method is not None and (method.kind != given.kind or not is_mine(viewer, method.owner)):
            if not can_maintain(viewer):
                raise Forbidden("a method of this name belongs to someone else", where="method", hint="choose another")
            method = None
    if method is None:
        method = Method(
            slug=free_slug(slug_of(name), set(session.scalars(select(Method.slug)))),
            name=name,
            owner=viewer.name,
            anonymous=given.anonymous,
            kind=given.kind,
            created_at=now,
        )
        session.add(method)
    for field, value in (("description", description), ("code_url", code_url), ("paper_url", paper_url)):
        if value is not None and getattr(method, field) is None:  # what is said already, its page changes
            setattr(method, field, value)
    session.flush()
    return method


def get_method(session: Session, viewer: Viewer, slug: str) -> Method:
    """Return a method of which the viewer may see something.

    Raises:
        NotFound: When there is none of that slug, or all of its submissions are hidden from the viewer.
    """
    method = session.scalars(select(Method).where(Method.slug == slug)).one_or_none() if slug.isascii() else None
    if method is not None and not is_mine(viewer, method.owner) and not can_maintain(viewer):
        shown = select(Submission.id).where(Submission.method_id == method.id, visible_submissions(viewer)).limit(1)
        if session.scalar(shown) is None:
            method = None
    if method is None:
        raise NotFound(f"there is no method {slug}")
    return method


def method_view(viewer: Viewer, method: Method) -> MethodView:
    """Return a method as the viewer may see it."""
    return MethodView(
        slug=method.slug,
        name=method.name,
        kind=method.kind,
        description=method.description,
        code_url=method.code_url,
        paper_url=method.paper_url,
        person=shown_person(viewer, method, method.owner),
        anonymous=method.anonymous,
        mine=is_mine(viewer, method.owner),
    )


def change_method(session: Session, viewer: Viewer, slug: str, changes: MethodChanges, now: datetime) -> Method:
    """Change what is said of a method. An anonymous one can be revealed; what was shown can't be hidden again.

    Raises:
        NotFound: When there is none of that slug.
        Forbidden: For others than its owner and maintainers.
        InvalidInput: Naming the field that can't be.
        Conflict: When it is to become anonymous again.
    """
    method = get_method(session, viewer, slug)
    require_author(viewer, method.owner)
    told: dict[str, Any] = {}
    if changes.name is not UNCHANGED:
        told["name"] = checked_name(changes.name)
    if changes.description is not UNCHANGED:
        told["description"] = checked_text(changes.description, "description")
    if changes.code_url is not UNCHANGED:
        told["code_url"] = checked_url(changes.code_url, "code_url")
    if changes.paper_url is not UNCHANGED:
        told["paper_url"] = checked_url(changes.paper_url, "paper_url")
    if changes.anonymous is not UNCHANGED:
        if changes.anonymous and not method.anonymous:
            raise Conflict("everyone has seen whose method this is", where="anonymous", expected="false")
        told["anonymous"] = changes.anonymous
    for field, value in told.items():
        setattr(method, field, value)
    session.flush()
    details = {"method": method.slug, "fields": sorted(told)}
    record_event(session, "method.changed", now, person=viewer.name, details=details)
    return method


def checked_url(url: str | None, where: str) -> str | None:
    """Return a web address that pages can link to; ``None`` for an empty one.

    Raises:
        InvalidInput: When it is no http or https address.
    """
    url = (url or "").strip() or None
    if url is None:
        return None
    try:
        parts = urlsplit(url)
    except ValueError:
        parts = urlsplit("")
    odd = len(url) > URL_LENGTH or not url.isprintable() or any(character.isspace() for character in url)
    if odd or parts.scheme not in ("http", "https") or not parts.hostname:
        raise InvalidInput("this is no web address", where=where, expected="https://HOST/PATH")
    return url
