"""What is taken from the rows in hand, as much as there is room for."""

from __future__ import annotations

from datetime import datetime

from app.db.session import Database
from app.jobs.calibration_work import take_calibration
from app.jobs.flight import Flight
from app.jobs.scoring_steps import scoring_in_hand, scoring_share, scoring_work
from app.jobs.suggestion_intake import SuggestionIntake
from app.jobs.work import DetectWork, EstimateWork, JudgeWork, Work
from app.services.calibration_queue import has_calibration_work
from app.services.lens_estimates import pending_estimates, pending_judgements
from app.services.run_queue import claim_images, has_queued_images, unsettled_runs
from app.services.scoring_queue import claim_scoring, has_scoring_work


def take_work(flight: Flight, database: Database, now: datetime, suggestions: SuggestionIntake | None = None) -> None:
    """Take work in hand: of submissions first, as somebody waits for it and it is short; a calibration; then of runs.

    Args:
        flight: Work in hand; it tells how much room there is.
        database: Where the rows are.
        now: When.
        suggestions: Takes what suggestions need when nothing else is left; nobody does if left out.
    """
    if flight.room:
        _take_scoring(flight, database, now)
        take_calibration(flight, database, now)
        _take_of_runs(flight, database, now)
        if suggestions is not None:
            suggestions.take(flight, database)


def work_is_left(database: Database) -> bool:
    """Whether the rows hold work that isn't done, in hand or not."""
    with database.read() as session:
        return bool(
            has_queued_images(session)
            or has_scoring_work(session)
            or has_calibration_work(session)
            or unsettled_runs(session, limit=1)
        )


def _take_scoring(flight: Flight, database: Database, now: datetime) -> None:
    with database.read() as session:
        if not has_scoring_work(session):
            return
        shared = has_queued_images(session)
    room = scoring_share(flight, shared=shared)
    if room > 0:
        with database.write() as session:
            claims = claim_scoring(session, room, scoring_in_hand(flight.work), now)
        for claim in claims:
            flight.add(scoring_work(claim), suspect=claim.claim.attempts > 1)


def _take_of_runs(flight: Flight, database: Database, now: datetime) -> None:
    known = {work.key for work in flight.work}
    with database.read() as session:
        steps: list[Work] = [EstimateWork(step) for step in pending_estimates(session)]
        steps += [JudgeWork(step) for step in pending_judgements(session, flight.room + len(known))]
        queued = has_queued_images(session)
    for work in [step for step in steps if step.key not in known][: flight.room]:
        flight.add(work)
    if queued and flight.room:
        with database.write() as session:
            claims = claim_images(session, flight.room, now)
        for claim in claims:
            # what was lost before may be what killed the server
            flight.add(DetectWork(claim), suspect=claim.attempts > 1)
