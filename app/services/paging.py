"""Pages of a list that stay right while rows come and go: each page begins after the last row of the one before."""

from __future__ import annotations

import base64
import binascii
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any, Generic, TypeGuard, TypeVar

from sqlalchemy import ColumnElement, Integer, Select, func, literal, select, tuple_
from sqlalchemy.orm import InstrumentedAttribute, Session

from app.db.models import UtcDateTime
from app.errors import InvalidInput
from app.formats.naming import has_control_characters

MAX_LIMIT = 1_000
COUNTED = 1_000
"""As far as rows are counted that no tally counts."""

Item = TypeVar("Item")
Other = TypeVar("Other")
Value = str | int | float


@dataclass(frozen=True)
class Page(Generic[Item]):
    """Some items of a list.

    Attributes:
        items: The items, in the list's order.
        next_cursor: Asks for the next page; ``None`` on the last one.
        total: Items on all pages together.
        total_exact: Whether that is all; else there are more than ``total``, and nobody counted on.
    """

    items: tuple[Item, ...]
    next_cursor: str | None
    total: int
    total_exact: bool = True

    def map(self, function: Callable[[Item], Other]) -> Page[Other]:
        """Return the page with each item replaced by the function of it."""
        return Page(tuple(function(item) for item in self.items), self.next_cursor, self.total, self.total_exact)


@dataclass(frozen=True)
class Counted:
    """How many rows there are; where that isn't exact, there are more."""

    number: int
    exact: bool = True


@dataclass(frozen=True)
class Order:
    """A total order of rows: by a column that is never null, then by id.

    Attributes:
        name: How the caller names it; a cursor is good for this order only.
        column: Strings, numbers or times.
        id_column: Breaks ties.
        descending: Largest first.
    """

    name: str
    column: InstrumentedAttribute[Any]
    id_column: InstrumentedAttribute[Any]
    descending: bool = False

    def clauses(self) -> tuple[ColumnElement[Any], ColumnElement[Any]]:
        """Return what to order by."""
        if self.descending:
            return self.column.desc(), self.id_column.desc()
        return self.column.asc(), self.id_column.asc()

    def on(self, entity: Any) -> Order:
        """Return the same order of an alias of the table."""
        column, id_column = (getattr(entity, each.key) for each in (self.column, self.id_column))
        return replace(self, column=column, id_column=id_column)

    def after(self, cursor: str) -> ColumnElement[bool]:
        """Return the condition that a row comes after the one the cursor names.

        Raises:
            InvalidInput: When the cursor isn't one of this order.
        """
        value, row_id = read_cursor(self.name, cursor)
        if isinstance(self.column.type, UtcDateTime):
            value = _read_time(value)
        elif isinstance(self.column.type, Integer):
            if not _is_integer(value):
                raise _foreign_cursor()
        elif not isinstance(value, str) or has_control_characters(value):
            raise _foreign_cursor()
        here, there = (
            tuple_(self.column, self.id_column),
            tuple_(literal(value, self.column.type), literal(row_id, self.id_column.type)),
        )
        return here < there if self.descending else here > there


def page_of(
    rows: Sequence[Any], limit: int, order: Order, key: Callable[[Any], tuple[Any, int]], total: int | Counted
) -> Page[Any]:
    """Make a page of rows that were selected with ``limit + 1``: the surplus row says that there is a next page.

    Args:
        rows: At most ``limit + 1``, in the order.
        limit: Rows of a page.
        order: The order they were selected in.
        key: Value of the order's column, and id, of a row.
        total: Rows on all pages, or how far they were counted.
    """
    shown = tuple(rows[:limit])
    cursor = write_cursor(order.name, *key(shown[-1])) if len(rows) > limit else None
    counted = Counted(total) if isinstance(total, int) else total
    return Page(shown, cursor, counted.number, counted.exact)


def counted_up_to(session: Session, query: Select[*tuple[Any, ...]], most: int = COUNTED) -> Counted:
    """Count the rows of a query, but not for longer than it takes to know that there are very many.

    Args:
        session: Any session.
        query: What to count; what it selects and its order don't matter.
        most: Rows from which on the number doesn't matter any more.
    """
    some = query.with_only_columns(literal(1), maintain_column_froms=True).order_by(None).limit(most + 1).subquery()
    return counted(session.scalar(select(func.count()).select_from(some)) or 0, most)


def counted(number: int, most: int = COUNTED) -> Counted:
    """Return what is known when up to ``most + 1`` rows were looked for, and so many found."""
    return Counted(min(number, most), exact=number <= most)


def checked_limit(limit: int) -> int:
    """Return the limit.

    Raises:
        InvalidInput: Below 1 or above ``MAX_LIMIT``.
    """
    if not 1 <= limit <= MAX_LIMIT:
        raise InvalidInput(f"a page of {limit} items", where="limit", expected=f"1 to {MAX_LIMIT}")
    return limit


def write_cursor(order: str, value: Value | datetime, row_id: int) -> str:
    """Return a cursor that names the row."""
    stored = value.isoformat() if isinstance(value, datetime) else value
    text = json.dumps([order, stored, row_id], separators=(",", ":"))
    return base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def read_cursor(order: str, cursor: str) -> tuple[Any, int]:
    """Return value and id of the row that a cursor names.

    Raises:
        InvalidInput: When it isn't a cursor of this order.
    """
    try:
        padded = cursor + "=" * (-len(cursor) % 4)
        name, value, row_id = json.loads(base64.b64decode(padded.encode("ascii"), altchars=b"-_", validate=True))
    except (binascii.Error, ValueError, TypeError, RecursionError) as error:
        raise _foreign_cursor() from error
    if name != order or not isinstance(value, str | int | float) or not _is_integer(row_id):
        raise _foreign_cursor()
    return value, row_id


def _is_integer(value: Any) -> TypeGuard[int]:
    return type(value) is int and abs(value) < 2**31


def _read_time(text: Any) -> datetime:
    try:
        value = datetime.fromisoformat(text)
        if value.tzinfo is None:
            raise _foreign_cursor()
        return value.astimezone(UTC)
    except (ValueError, TypeError, OverflowError) as error:
        raise _foreign_cursor() from error


def _foreign_cursor() -> InvalidInput:
    return InvalidInput(
        "the cursor doesn't belong to this list and order",
        where="cursor",
        expected="next_cursor of the page before, with the same sort",
    )
