"""Names of accounts. What somebody does is stored under their name, so none is ever given to another person."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterator

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import ImagePerson, Method, SecondReview, Submission, Token, User
from app.errors import Conflict, InvalidInput
from app.services.people import PERSON_LENGTH, checked_person

KEY_LENGTH = 400
UNSEEN = re.compile("[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2800\u3164\ufe00-\ufe0f\uffa0\U000e0100-\U000e01ef]")
"""Printable to Python, and yet nothing is seen of them: default-ignorable code points of Unicode, and empty braille."""


def name_key(name: str) -> str:
    """Return what two names have in common that look the same but for case, width and how letters are composed."""
    return unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", name).casefold())


def typed_key(name: str) -> str:
    """Return the key of a name as somebody has typed it, with spaces around it."""
    return name_key(name.strip())


def checked_account_name(name: str) -> str:
    """Return a name that an account can have.

    Raises:
        InvalidInput: When it can't be a person's name.
    """
    name = checked_person(name, "name")
    if len(name_key(name)) > KEY_LENGTH or UNSEEN.search(name):
        raise InvalidInput("this can't be a person's name", where="name", expected=f"{PERSON_LENGTH} plain characters")
    return name


def require_free_name(session: Session, name: str, *, chosen: bool, reserved: Collection[str] = ()) -> None:
    """Refuse a name that is, or ever was, an account's or a service token's.

    Args:
        session: Any session.
        name: Checked.
        chosen: Whether its holder chooses it. Then it may not stand on anything either that is somebody's: in local
            mode names are claims, and an admin may give such a name to whom it belongs, but nobody may take it.
        reserved: Names that nobody may choose.

    Raises:
        Conflict: When it is taken.
    """
    key = name_key(name)
    taken = session.scalar(select(User.id).where(User.name_key == key)) is not None
    tokens = session.scalars(select(Token.name).where(Token.user_id.is_(None)).distinct())
    taken = taken or any(name_key(other) == key for other in tokens)
    if chosen and not taken:
        taken = any(name_key(other) == key for other in (*_names_that_stand(session), *reserved))
    if taken:
        raise Conflict(f"the name {name} is taken", where="name", hint="choose another; names are never given twice")


def _names_that_stand(session: Session) -> Iterator[str]:
    """Yield the names on methods, submissions, verdicts and second reviews."""
    columns = (Method.owner, Submission.person, ImagePerson.person, SecondReview.person)
    for column in columns:
        yield from (name for name in session.scalars(select(column).distinct()) if name is not None)


def require_no_account(session: Session, name: str) -> None:
    """Refuse a service token the name of an account, living or not.

    Raises:
        Conflict: When there is one.
    """
    if session.scalar(select(User.id).where(User.name_key == name_key(name))) is not None:
        raise Conflict(f"{name} is the name of an account", where="name", hint="take a new name")
