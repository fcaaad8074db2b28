"""Passwords: which can be, and how they are kept (Argon2id, RFC 9106)."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from threading import BoundedSemaphore

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError

from app.errors import InvalidInput, Unauthenticated, Unavailable
from app.services.common_passwords import COMMON_PASSWORDS

SHORTEST = 10
LONGEST = 200
LEAST_DIFFERENT = 4
AT_ONCE = 2
"""Hashes that are worked out at the same time: each takes 64 MiB of memory."""

PATIENCE = 5.0
"""Seconds that somebody waits for a place."""


class Passwords:
    """Makes and compares hashes, a few at a time. Safe to use from several threads.

    Args:
        hasher: Says what a hash costs; by default what RFC 9106, section 4, advises for little memory: 3 passes
            over 64 MiB.
        at_once: How many are worked out at the same time.
        patience: How long somebody waits for their turn, s.
    """

    def __init__(
        self, hasher: PasswordHasher | None = None, *, at_once: int = AT_ONCE, patience: float = PATIENCE
    ) -> None:
        self._hasher = hasher or PasswordHasher()
        self._room = BoundedSemaphore(at_once)
        self._patience = patience

    def hash_of(self, password: str) -> str:
        """Return what is kept of a password: salt, cost and hash.

        Raises:
            Unavailable: When many others are at it.
        """
        with self._place():
            return self._hasher.hash(_as_bytes(password))

    def is_right(self, password: str, stored: str | None) -> bool:
        """Whether a password is the one that was stored.

        Args:
            password: What was typed.
            stored: From `hash_of`; ``None`` where there is none: that takes as long, so that time doesn't tell it.

        Raises:
            Unavailable: When many others are at it.
        """
        with self._place():
            if stored is None:
                self._hasher.hash(_as_bytes(password))
                return False
            try:
                return self._hasher.verify(stored, _as_bytes(password))
            except (VerificationError, InvalidHashError):
                return False

    def require_right(self, password: str, stored: str | None) -> None:
        """Refuse a password that isn't the one that was stored; as `is_right`.

        Raises:
            Unauthenticated: When it isn't.
        """
        if not self.is_right(password, stored):
            raise wrong_password()

    def is_outdated(self, stored: str) -> bool:
        """Whether a hash was made at another cost than is usual now."""
        return self._hasher.check_needs_rehash(stored)

    @contextmanager
    def _place(self) -> Iterator[None]:
        if not self._room.acquire(timeout=self._patience):
            raise Unavailable("many people are signing in", hint="try again in a moment")
        try:
            yield
        finally:
            self._room.release()


def wrong_password() -> Unauthenticated:
    """Return the error of a name and a password that don't fit, for whatever reason."""
    return Unauthenticated(
        "this name and password don't fit", where="password", hint="an admin can send you a link to choose a new one"
    )


def checked_password(password: str, name: str, where: str = "password") -> str:
    """Return a new password as it was given.

    Args:
        password: What somebody wants to sign in with.
        name: Of their account.
        where: The field.

    Raises:
        InvalidInput: When it is too short or too long, or among the first that somebody would guess.
    """
    composed = _composed(password)
    lower = composed.casefold()
    if not SHORTEST <= len(composed) <= LONGEST:
        raise InvalidInput(
            f"this password has {len(composed)} characters",
            where=where,
            expected=f"{SHORTEST} to {LONGEST} characters; a sentence is good",
        )
    if lower == _composed(name).casefold():
        raise InvalidInput("the password is the name", where=where, hint="take something that nobody else knows")
    if lower in COMMON_PASSWORDS or len(set(lower)) < LEAST_DIFFERENT:
        raise InvalidInput("this password is among the first that are guessed", where=where, hint="take a sentence")
    return password


def _composed(password: str) -> str:
    """Return the same characters for a password however a keyboard composes them (NFKC)."""
    return unicodedata.normalize("NFKC", password)


def _as_bytes(password: str) -> bytes:
    """Return what is hashed; half a character, which JSON can hold, is as good as any."""
    return _composed(password).encode("utf-8", "surrogatepass")
