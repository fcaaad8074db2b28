"""Every error that ClearLines raises on purpose, as one tree.

    ClearLinesError
        InvalidInput                what was given can't be used                        422
            InvalidImage            not an image, or a kind that isn't read             422
            InvalidSegments         points or offsets that make no segments             422
            InvalidFile             a label, prediction or archive file                 422
            NoEdge                  nothing in the image to trace                       422
            CannotExport            a file format that can't hold the lens              422
        TooLarge                    over a limit that a setting names                   413
        NotFound                    no such dataset, image, run...                      404
            NoHistory               a segment that nobody can tell how it was found     404
        Conflict                    the state of things doesn't allow it now            409
            UndecidedLeft           candidates wait for a verdict                       409
        Unauthenticated             a token that is not good                            401
        Forbidden                   not allowed for whom, or from where, it was asked   403
            NotInvited              a stranger whom a provider names                403
        TooSlow                     a request whose rest doesn't come                   408
        TooMany                     more often than is allowed for now                  429
        Unavailable                 can't be done now; trying again may help            503
            NoRoom                  a disk of the server is full                        507
        Cancelled                   called off by whoever asked for it                  409
        BrokenInstallation          a part of ClearLines itself is missing              500

An error says what is wrong and, where known, where, what was expected and what would help. The web layer turns
it into a problem document (RFC 9457) with its status; the command line prints the same words.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar


class ClearLinesError(Exception):
    """Base of the tree.

    Args:
        message: What is wrong, one sentence.
        where: File, segment, field or row that it is about.
        expected: What would have been right.
        hint: What the person can do now.
        details: Further facts for programs; must be JSON-serialisable.
    """

    status: ClassVar[int] = 500
    code: ClassVar[str] = "error"

    def __init__(
        self,
        message: str,
        *,
        where: str | None = None,
        expected: str | None = None,
        hint: str | None = None,
        details: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.where = where
        self.expected = expected
        self.hint = hint
        self.details = dict(details or {})

    def __str__(self) -> str:
        head = f"{self.where}: {self.message}" if self.where else self.message
        tail = [
            f"expected: {self.expected}" if self.expected else "",
            f"hint: {self.hint}" if self.hint else "",
        ]
        return "; ".join([head, *filter(None, tail)])

    def __reduce__(self) -> tuple[Any, ...]:
        # a worker's error crosses the process border whole
        return _rebuild, (type(self), self.message, self.where, self.expected, self.hint, self.details)

    def as_dict(self) -> dict[str, Any]:
        """Return the error as JSON-serialisable fields (absent ones left out)."""
        fields = {
            "code": self.code,
            "message": self.message,
            "where": self.where,
            "expected": self.expected,
            "hint": self.hint,
            "details": self.details,
        }
        return {key: value for key, value in fields.items() if value}


def _rebuild(
    kind: type[ClearLinesError],
    message: str,
    where: str | None,
    expected: str | None,
    hint: str | None,
    details: dict[str, Any],
) -> ClearLinesError:
    return kind(message, where=where, expected=expected, hint=hint, details=details)


class InvalidInput(ClearLinesError):
    """What was given can't be used."""

    status = 422
    code = "invalid-input"


class InvalidImage(InvalidInput):
    """Not an image, or a kind that isn't read."""

    code = "invalid-image"


class InvalidSegments(InvalidInput):
    """Points or offsets that make no segments."""

    code = "invalid-segments"


class InvalidFile(InvalidInput):
    """A label, prediction or archive file that can't be read."""

    code = "invalid-file"


class NoEdge(InvalidInput):
    """Nothing in the image runs where an edge was to be traced."""

    code = "no-edge"


class CannotExport(InvalidInput):
    """The file format asked for can't hold the lens closely enough."""

    code = "cannot-export"


class TooLarge(ClearLinesError):
    """Over a limit that a setting names."""

    status = 413
    code = "too-large"


class NotFound(ClearLinesError):
    """No such dataset, image, run or camera."""

    status = 404
    code = "not-found"


class NoHistory(NotFound):
    """The pipeline as it is here didn't find the segment, so how it was found can't be told."""

    code = "no-history"


class Conflict(ClearLinesError):
    """The state of things doesn't allow it now."""

    status = 409
    code = "conflict"


class UndecidedLeft(Conflict):
    """An image can't be done while candidates wait for a verdict."""

    code = "undecided-left"


class Unauthenticated(ClearLinesError):
    """Whoever asks isn't who they say: the token is unknown, expired or revoked."""

    status = 401
    code = "unauthenticated"


class Forbidden(ClearLinesError):
    """Not allowed for whom, or from where, it was asked."""

    status = 403
    code = "forbidden"


class TooSlow(ClearLinesError):
    """A request whose rest doesn't come."""

    status = 408
    code = "too-slow"


class NotInvited(Forbidden):
    """Whoever a provider names has no account, and nobody has asked them to make one."""

    code = "not-invited"


class TooMany(ClearLinesError):
    """More often than is allowed for now."""

    status = 429
    code = "too-many"


class Unavailable(ClearLinesError):
    """Can't be done now; trying again may help."""

    status = 503
    code = "unavailable"


class NoRoom(Unavailable):
    """A disk of the server is full."""

    status = 507
    code = "no-room"


class Cancelled(ClearLinesError):
    """Work was called off, before its end, by whoever asked for it."""

    status = 409
    code = "cancelled"


class BrokenInstallation(ClearLinesError):
    """A part of ClearLines itself is missing or can't be loaded."""

    code = "broken-installation"
