"""How much a submission may hold; checked before memory is taken for it."""

from __future__ import annotations

from dataclasses import dataclass

from app.formats.limits import ArchiveLimits, SegmentLimits


@dataclass(frozen=True)
class SubmissionLimits:
    """Bounds of one submission, all its files together unless said otherwise.

    Attributes:
        upload_bytes: The upload as it comes.
        members: Files in it, those left out included.
        member_bytes: One file after unpacking.
        unpacked_bytes: All files after unpacking.
        segments: Segments of all images.
        image_segments: Segments of one image.
        points: Points of all images.
        segment_points: Points of one segment.
        image_length: Arc length of all segments of one image, px: what scoring an image costs grows with it.
        problems: Complaints that are told one by one; the others are counted.
    """

    upload_bytes: int = 256 * 2**20
    members: int = 20_000
    member_bytes: int = 128 * 2**20
    unpacked_bytes: int = 1024 * 2**20
    segments: int = 500_000
    image_segments: int = 20_000
    points: int = 20_000_000
    segment_points: int = 20_000
    image_length: float = 5_000_000.0
    problems: int = 1_000

    @property
    def archive(self) -> ArchiveLimits:
        """The same as bounds of an archive."""
        return ArchiveLimits(self.members, self.member_bytes, self.unpacked_bytes)

    @property
    def file(self) -> SegmentLimits:
        """The same as bounds of one file."""
        return SegmentLimits(self.member_bytes, self.member_bytes // 2, self.segments, self.points)


SUBMISSION_LIMITS = SubmissionLimits()
