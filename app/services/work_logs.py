"""How much was decided, when, by whom and how fast: counted once, then only what is new.

Decisions are append-only, so what was counted stays counted. A million of them take a while to read; a page that is
looked at every minute reads those of the last minutes.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from threading import Lock
from typing import Any

from sqlalchemy import ColumnElement, and_, case, func, or_, select
from sqlalchemy.orm import Session

from app.db.models import Decision, Image, ImageTally
from app.db.session import Database
from app.services.decision_batch import REPLAYS
from app.services.people import WORK
from app.services.tallies import image_count
from app.services.time_bins import AWAY, bin_of

SETTLED = timedelta(minutes=10)
"""After this no decision of an earlier time appears any more: no transaction of ours is open for so long."""

MOST_LOGS = 16
LIKELY = 0.5

HourKey = tuple[str, str | None, str, str]
TimeKey = tuple[str | None, str, int]


@dataclass(frozen=True)
class HourWork:
    """What was decided in an hour.

    Attributes:
        decisions: Verdicts given.
        milliseconds: Time that they took, breaks left out.
        shown: Verdicts given with a suggestion in sight.
        agreed: Those of them that say what the suggestion says.
    """

    decisions: int = 0
    milliseconds: int = 0
    shown: int = 0
    agreed: int = 0

    def __add__(self, other: HourWork) -> HourWork:
        return HourWork(
            self.decisions + other.decisions,
            self.milliseconds + other.milliseconds,
            self.shown + other.shown,
            self.agreed + other.agreed,
        )


@dataclass
class WorkLog:
    """Counts of a dataset's decisions.

    Attributes:
        hours: By hour (``2025-06-01 12``, UTC), person, verdict and kind.
        times: Number of key presses by person, verdict and bin of the time they took (see ``app.services.time_bins``).
    """

    hours: dict[HourKey, HourWork] = field(default_factory=dict)
    times: dict[TimeKey, int] = field(default_factory=dict)

    def decisions_by_person(self) -> dict[str, int]:
        """Return how many verdicts each person gave, those taken back too; undo and redo are none."""
        counts: dict[str, int] = {}
        for (_, person, verdict, kind), work in self.hours.items():
            if person is not None and kind not in REPLAYS and verdict != "undecided":
                counts[person] = counts.get(person, 0) + work.decisions
        return counts

    def copy(self) -> WorkLog:
        """Return a log that grows by itself."""
        return WorkLog(dict(self.hours), dict(self.times))


@dataclass
class _Remembered:
    """A log, the last decision in it, and how many images the dataset had: fewer mean that some were purged."""

    log: WorkLog
    until: int
    images: int


class WorkLogs:
    """Counts decisions and remembers the counts. Safe to use from several threads.

    Args:
        database: Where the decisions are.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self._known: OrderedDict[int, _Remembered] = OrderedDict()
        self._lock = Lock()

    def of(self, dataset_id: int, now: datetime) -> WorkLog:
        """Return the counts of a dataset's decisions, deleted images' too, as they are now."""
        with self._lock, self._database.read() as session:  # of several who ask at once, the first one counts
            known = self._settled(session, dataset_id, now)
            log = known.log.copy()
            _count(session, log, and_(Image.dataset_id == dataset_id, Decision.id > known.until))
            return log

    def _settled(self, session: Session, dataset_id: int, now: datetime) -> _Remembered:
        images = image_count(session, ImageTally.dataset_id == dataset_id)
        known = self._known.get(dataset_id)
        if known is None or known.images > images:
            known = _Remembered(WorkLog(), 0, images)
        known.images = images
        settled = select(Decision.id).where(Decision.created_at < now - SETTLED).order_by(Decision.id.desc()).limit(1)
        until = session.scalar(settled) or 0
        if until > known.until:
            new = and_(Image.dataset_id == dataset_id, Decision.id > known.until, Decision.id <= until)
            _count(session, known.log, new)
            known.until = until
        self._known[dataset_id] = known
        self._known.move_to_end(dataset_id)
        while len(self._known) > MOST_LOGS:
            self._known.popitem(last=False)
        return known


def _count(session: Session, log: WorkLog, which: ColumnElement[bool]) -> None:
    for key, work in _hours(session, which):
        log.hours[key] = log.hours.get(key, HourWork()) + work
    for key, number in _times(session, which):
        log.times[key] = log.times.get(key, 0) + number


def _hours(session: Session, which: ColumnElement[bool]) -> Iterator[tuple[HourKey, HourWork]]:
    hour = _hour_of(session)
    took = case((Decision.elapsed_ms > AWAY, AWAY), else_=Decision.elapsed_ms)
    agrees = or_(
        and_(Decision.verdict == "keep", Decision.suggestion >= LIKELY),
        and_(Decision.verdict == "reject", Decision.suggestion < LIKELY),
    )
    rows = session.execute(
        select(
            hour,
            Decision.person,
            Decision.verdict,
            Decision.kind,
            func.count(),
            func.coalesce(func.sum(took), 0),
            func.count(Decision.suggestion),
            func.count(case((agrees, 1))),
        )
        .join(Image, Image.id == Decision.image_id)
        .where(which, Decision.kind.in_(WORK))
        .group_by(hour, Decision.person, Decision.verdict, Decision.kind)
    )
    for begun, person, verdict, kind, *numbers in rows:
        yield (begun, person, verdict, kind), HourWork(*map(int, numbers))


def _times(session: Session, which: ColumnElement[bool]) -> Iterator[tuple[TimeKey, int]]:
    place = bin_of(Decision.elapsed_ms)
    rows = session.execute(
        select(Decision.person, Decision.verdict, place, func.count())
        .join(Image, Image.id == Decision.image_id)
        .where(which, Decision.elapsed_ms.is_not(None), Decision.kind.in_(WORK), Decision.kind.not_in(REPLAYS))
        .group_by(Decision.person, Decision.verdict, place)
    )
    for person, verdict, number, count in rows:
        yield (person, verdict, int(number)), count


def _hour_of(session: Session) -> ColumnElement[Any]:
    """Return the hour of a decision as text, UTC; both databases keep UTC, in forms of their own."""
    if session.get_bind().dialect.name == "sqlite":
        return func.substr(Decision.created_at, 1, 13)
    return func.to_char(func.timezone("UTC", Decision.created_at), "YYYY-MM-DD HH24")
