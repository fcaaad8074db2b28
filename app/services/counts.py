"""Numbers that datasets, images and answers share."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class VerdictCounts:
    """Current candidates by verdict."""

    keep: int = 0
    reject: int = 0
    ambiguous: int = 0
    undecided: int = 0


@dataclass(frozen=True)
class ReviewCounts:
    """Images by review status."""

    open: int = 0
    done: int = 0
    discarded: int = 0


def verdict_counts(candidates: int, keep: int, reject: int, ambiguous: int) -> VerdictCounts:
    """Return the counts of an image's row as counts by verdict."""
    return VerdictCounts(keep, reject, ambiguous, candidates - keep - reject - ambiguous)
