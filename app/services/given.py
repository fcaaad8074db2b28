"""What a request gives: fields that are left as they are, names and texts."""

from __future__ import annotations

import unicodedata
from enum import Enum
from typing import Final

from app.errors import InvalidInput

NAME_LENGTH = 200
TEXT_LENGTH = 20_000


class Unchanged(Enum):
    """Stands for a field that is left as it is; ``None`` clears one."""

    UNCHANGED = "unchanged"


UNCHANGED: Final = Unchanged.UNCHANGED


def checked_name(name: str, where: str = "name") -> str:
    """Return the name in Unicode's composed form, with single spaces.

    Raises:
        InvalidInput: When it is empty, too long, or has control characters.
    """
    name = " ".join(unicodedata.normalize("NFC", name).split())
    if not name or len(name) > NAME_LENGTH or not name.isprintable():
        raise InvalidInput("this can't be a name", where=where, expected=f"1 to {NAME_LENGTH} characters")
    return name


def checked_text(text: str | None, where: str) -> str | None:
    """Return a text without outer spaces, ``None`` for an empty one.

    Raises:
        InvalidInput: When it is too long or holds a NUL character.
    """
    text = (text or "").strip() or None
    if text and (len(text) > TEXT_LENGTH or "\0" in text):
        raise InvalidInput(
            "the text is too long or holds a NUL character", where=where, expected=f"at most {TEXT_LENGTH} characters"
        )
    return text
