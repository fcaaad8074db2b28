"""All that is wrong with a submission, each complaint with file, segment, point, what was expected and a hint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from app.errors import ClearLinesError, InvalidFile


@dataclass(frozen=True)
class Problem:
    """One complaint.

    Attributes:
        message: What is wrong.
        file: Path of the file in the upload; with ``: image NAME`` behind it in a file for all images.
        segment: Its index in the file, from 0.
        point: Its index in the segment, from 0.
        expected: What would have been right.
        hint: What the person can do now.
    """

    message: str
    file: str | None = None
    segment: int | None = None
    point: int | None = None
    expected: str | None = None
    hint: str | None = None


class InvalidSubmission(InvalidFile):
    """A submission that can't be used; ``details["errors"]`` has every complaint."""

    code = "invalid-submission"


@dataclass
class Complaints:
    """Collects complaints; the first ``limit`` are kept, the others counted.

    Attributes:
        limit: Complaints to keep.
        problems: Those kept, in the order of their coming.
        count: All of them.
    """

    limit: int
    problems: list[Problem] = field(default_factory=list)
    count: int = 0

    @property
    def has_room(self) -> bool:
        """Whether one more is kept."""
        return len(self.problems) < self.limit

    def add(self, problem: Problem) -> None:
        """Take one more."""
        self.count += 1
        if self.has_room:
            self.problems.append(problem)

    def add_error(self, error: ClearLinesError, file: str | None = None) -> None:
        """Take an error that a reader raised; what it says of the place behind the file's name stays in the message."""
        where = error.where or ""
        if file and where.startswith(file):
            where = where[len(file) :].lstrip(": ")
        message = f"{where}: {error.message}" if where and where != file else error.message
        self.add(Problem(message, file, expected=error.expected, hint=error.hint))

    def raise_any(self, where: str) -> None:
        """Raise what was collected, if anything was.

        Raises:
            InvalidSubmission: With all of it.
        """
        if self.count:
            raise invalid_submission(self.problems, self.count, where=where)


def invalid_submission(problems: Sequence[Problem], count: int | None = None, *, where: str) -> InvalidSubmission:
    """Return the error that tells all complaints.

    Args:
        problems: Those to tell; at least one.
        count: How many there are, where not all are told.
        where: Name of the upload.
    """
    number = len(problems) if count is None else count
    first = problems[0]
    message = first.message if number == 1 else f"{number:,} things are wrong; the first: {first.message}"
    details: dict[str, Any] = {"errors": [asdict(problem) for problem in problems], "count": number}
    return InvalidSubmission(
        message, where=first.file or where, expected=first.expected, hint=first.hint, details=details
    )
