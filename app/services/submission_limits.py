"""The bounds of a submission, as the settings say."""

from __future__ import annotations

from app.formats.submission_limits import SubmissionLimits
from app.settings import Settings


def submission_limits(settings: Settings) -> SubmissionLimits:
    """Return how much a submission may hold."""
    return SubmissionLimits(
        upload_bytes=settings.max_submission_bytes,
        members=settings.max_submission_files,
        member_bytes=min(SubmissionLimits.member_bytes, settings.max_submission_unpacked_bytes),
        unpacked_bytes=settings.max_submission_unpacked_bytes,
        segments=settings.max_submission_segments,
        image_segments=settings.max_image_segments,
        points=settings.max_submission_points,
        segment_points=settings.max_segment_points,
    )
