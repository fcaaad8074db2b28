"""Which work of submissions a dispatcher takes in hand, beside that of runs."""

from __future__ import annotations

from collections.abc import Sequence

from app.jobs.flight import Flight
from app.jobs.scoring_work import ScoreWork, TotalWork, ValidateWork
from app.jobs.work import Work
from app.services.scoring_claims import InHand, PartClaim, ScoringClaim, ValidationClaim

SUBMISSION_WORK = (ValidateWork, ScoreWork, TotalWork)


def scoring_work(claim: ScoringClaim) -> Work:
    """Return the work that a claim is for."""
    if isinstance(claim, ValidationClaim):
        return ValidateWork(claim)
    return ScoreWork(claim) if isinstance(claim, PartClaim) else TotalWork(claim)


def scoring_in_hand(work: Sequence[Work]) -> InHand:
    """Return what is worked on already."""
    parts = [each.claim for each in work if isinstance(each, ScoreWork)]
    return InHand(
        {(part.score_id, image) for part in parts for image in part.images},
        {each.claim.score_id for each in work if isinstance(each, TotalWork)},
    )


def submissions_in_hand(work: Sequence[Work]) -> set[int]:
    """Return the ids of the submissions that are worked on."""
    return {each.claim.claim.submission_id for each in work if isinstance(each, SUBMISSION_WORK)}


def scoring_share(flight: Flight, *, shared: bool) -> int:
    """Return how much work of submissions may be taken in hand.

    Work of submissions goes first, so that no run makes its author wait; but a place is left to runs, so that many
    submissions don't stop them.

    Args:
        flight: What is in hand.
        shared: Whether a run waits too.
    """
    if not shared:
        return flight.room
    at_it = sum(isinstance(work, SUBMISSION_WORK) for work in flight.work)
    return min(flight.room, max(flight.places - 1 - at_it, 0))
