"""The log of a submission: what happened to it, in words, in the transaction in which it happened."""

from __future__ import annotations

from datetime import datetime

from app.db.models import Submission

LONGEST = 200
"""Entries that are kept; of a submission that is scored again and again the oldest go."""


def add_to_log(submission: Submission, text: str, now: datetime) -> None:
    """Add a line.

    Args:
        submission: Of a writing session.
        text: What happened, for its author.
        now: When.
    """
    # a new list: a change inside the old one isn't noticed
    submission.log = [*(submission.log or []), {"at": now.isoformat(), "text": text}][-LONGEST:]
