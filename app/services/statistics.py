"""A dataset's statistics: progress, pace, time per decision, suggestions, reasons, agreement."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import UTC, date, datetime
from typing import TypeVar

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.db.models import REVIEW_STATES, Dataset, Image, ImageTally, Review, Segment, SegmentState
from app.review.agreement import Kappa
from app.services.agreements import agreement_of
from app.services.counts import ReviewCounts
from app.services.decision_batch import REPLAYS
from app.services.decision_times import DecisionTimes, VerdictTimes, times_of, verdict_times
from app.services.tallies import counts_by, of_dataset
from app.services.time_bins import EDGES
from app.services.work_logs import HourKey, HourWork, WorkLog
from app.verdicts import REASONS, VERDICTS

Key = TypeVar("Key")


@dataclass(frozen=True)
class DayProgress:
    """What happened on a day, UTC.

    Attributes:
        done: Images that were finished then, and are still.
    """

    day: date
    decisions: int
    done: int


@dataclass(frozen=True)
class HourProgress:
    """How many verdicts were given in an hour that begins at this time."""

    hour: datetime
    decisions: int


@dataclass(frozen=True)
class PersonWork:
    """What one person did.

    Attributes:
        decisions: Verdicts given.
        undone: Verdicts taken back by undo.
        hours: Time that the decisions took, breaks left out, h.
        per_hour: Decisions in an hour of such time; ``None`` without any.
        times: Per key press.
    """

    person: str | None
    decisions: int
    undone: int
    hours: float
    per_hour: float | None
    times: DecisionTimes


@dataclass(frozen=True)
class SuggestionUse:
    """What became of suggestions.

    Attributes:
        shown: Verdicts given with a suggestion in sight.
        agreed: Those of them that say what the suggestion says.
        accepted: Verdicts given by accepting suggestions, many at once.
    """

    shown: int
    agreed: int
    accepted: int


@dataclass(frozen=True)
class ReasonCount:
    """How many candidates are rejected for a reason."""

    reason: str
    count: int


@dataclass(frozen=True)
class AgreementSummary:
    """Agreement of first and second reviews."""

    reviews: int
    kappa: Kappa
    differences: int
    adjudicated: int


@dataclass(frozen=True)
class Statistics:
    """A dataset's statistics.

    Attributes:
        decisions: Verdicts given, whatever became of them.
        per_hour: Decisions in an hour of work, of all people together; ``None`` without any.
        days: Days on which something happened, in order.
        hours: Hours in which verdicts were given, in order.
        edges: Lower ends of the bars of all histograms, ms.
        verdicts: Times by verdict.
        people: By name.
        reasons: Of candidates that are rejected now.
    """

    images: ReviewCounts
    decisions: int
    per_hour: float | None
    days: tuple[DayProgress, ...]
    hours: tuple[HourProgress, ...]
    edges: tuple[int, ...]
    times: DecisionTimes
    verdicts: tuple[VerdictTimes, ...]
    people: tuple[PersonWork, ...]
    suggestions: SuggestionUse
    reasons: tuple[ReasonCount, ...]
    agreement: AgreementSummary


def statistics_of(session: Session, dataset: Dataset, log: WorkLog) -> Statistics:
    """Return a dataset's statistics.

    Args:
        session: Any session.
        dataset: The dataset.
        log: Counts of its decisions.
    """
    judged = {key: work for key, work in log.hours.items() if key[3] not in REPLAYS and key[2] != "undecided"}
    total = _sum(judged.values())
    by_hour = _grouped(judged, lambda key: key[0])
    agreement = agreement_of(session, dataset)
    status = counts_by(session, ImageTally.review_status, of_dataset(dataset))
    return Statistics(
        images=ReviewCounts(**(dict.fromkeys(REVIEW_STATES, 0) | dict(status))),
        decisions=total.decisions,
        per_hour=_per_hour(total),
        days=_days(session, dataset, by_hour),
        hours=tuple(HourProgress(_hour(hour), work.decisions) for hour, work in sorted(by_hour.items())),
        edges=EDGES,
        times=times_of(log, lambda _: True),
        verdicts=tuple(verdict_times(log, verdict) for verdict in VERDICTS if verdict != "undecided"),
        people=_people(log, judged),
        suggestions=SuggestionUse(
            total.shown, total.agreed, _sum(work for key, work in judged.items() if key[3] == "accept").decisions
        ),
        reasons=_reasons(session, dataset),
        agreement=AgreementSummary(agreement.reviews, agreement.overall, agreement.differences, agreement.adjudicated),
    )


def _days(session: Session, dataset: Dataset, by_hour: dict[str, HourWork]) -> tuple[DayProgress, ...]:
    decisions = Counter[date]()
    for hour, work in by_hour.items():
        decisions[_hour(hour).date()] += work.decisions
    finished = session.scalars(
        select(Review.updated_at)
        .join(Image)
        .where(Image.dataset_id == dataset.id, Image.deleted_at.is_(None), Review.status == "done")
    )
    done = Counter(time.date() for time in finished)
    return tuple(DayProgress(day, decisions[day], done[day]) for day in sorted({*decisions, *done}))


def _people(log: WorkLog, judged: dict[HourKey, HourWork]) -> tuple[PersonWork, ...]:
    by_person = _grouped(judged, lambda key: key[1])
    undone = Counter[str | None]()
    for (_, person, _, kind), work in log.hours.items():
        undone[person] += work.decisions if kind == "undo" else 0
    return tuple(
        PersonWork(
            person=person,
            decisions=work.decisions,
            undone=undone[person],
            hours=work.milliseconds / 3_600_000,
            per_hour=_per_hour(work),
            times=times_of(log, lambda key, person=person: key[0] == person),
        )
        for person, work in sorted(by_person.items(), key=lambda item: (item[0] is None, item[0]))
    )


def _reasons(session: Session, dataset: Dataset) -> tuple[ReasonCount, ...]:
    rows = session.execute(
        select(SegmentState.reason, func.count())
        .join(Segment, Segment.id == SegmentState.segment_id)
        .join(Image, Image.id == Segment.image_id)
        .where(
            SegmentState.reason.is_not(None),
            Segment.retired_at.is_(None),
            Image.dataset_id == dataset.id,
            Image.deleted_at.is_(None),
        )
        .group_by(SegmentState.reason)
    ).all()
    counts = dict(rows)
    return tuple(ReasonCount(reason, counts.get(reason, 0)) for reason in REASONS)


def _grouped(hours: dict[HourKey, HourWork], key: Callable[[HourKey], Key]) -> dict[Key, HourWork]:
    groups: dict[Key, HourWork] = {}
    for full, work in hours.items():
        groups[key(full)] = groups.get(key(full), HourWork()) + work
    return groups


def _sum(works: Iterable[HourWork]) -> HourWork:
    return sum(works, HourWork())


def _per_hour(work: HourWork) -> float | None:
    return work.decisions / (work.milliseconds / 3_600_000) if work.milliseconds else None


def _hour(text: str) -> datetime:
    return datetime.strptime(text, "%Y-%m-%d %H").replace(tzinfo=UTC)
