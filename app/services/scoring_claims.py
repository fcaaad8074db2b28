"""What the dispatcher takes of a submission: its upload, some of its images, or the adding up of their scores."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from app.services.submission_states import SubmissionClaim


@dataclass(frozen=True)
class ValidationClaim:
    """An upload to be validated."""

    claim: SubmissionClaim
    upload_sha256: str
    upload_name: str
    split_version_id: int


@dataclass(frozen=True)
class PartClaim:
    """Some images of a submission to be scored.

    Attributes:
        images: Ids of split images, in the split's order.
        truth_sha256: Blob of the truth.
        segments_sha256: Blob of the submission's segments.
        min_length: Of the split, px.
    """

    claim: SubmissionClaim
    score_id: int
    images: tuple[int, ...]
    truth_sha256: str
    segments_sha256: str
    min_length: float


@dataclass(frozen=True)
class TotalsClaim:
    """A submission whose images are all scored, to be added up."""

    claim: SubmissionClaim
    score_id: int
    segments_sha256: str
    truth_sha256: str
    min_length: float


ScoringClaim = ValidationClaim | PartClaim | TotalsClaim


@dataclass(frozen=True)
class InHand:
    """What the dispatcher works on already.

    Attributes:
        images: Pairs of score and split image.
        totals: Scores that are being added up.
    """

    images: Collection[tuple[int, int]] = ()
    totals: Collection[int] = ()
