"""How much a foreign file may hold; checked before memory is taken for it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SegmentLimits:
    """Bounds of the segments of one image.

    Attributes:
        file_bytes: Size of one file as it comes, and of its members after unpacking.
        json_bytes: Size of one JSON file; parsed, it takes up to twenty times as much.
        segments: Segments of one image.
        points: Points of all segments of one image.
    """

    file_bytes: int = 128 * 2**20
    json_bytes: int = 32 * 2**20
    segments: int = 100_000
    points: int = 5_000_000


@dataclass(frozen=True)
class SetLimits:
    """Bounds of one file that holds the segments of many images.

    Attributes:
        file_bytes: Size of the file as it comes, and of its members after unpacking.
        json_bytes: Size of the file if it is JSON.
        images: Images of the set.
        segments: Segments of all images together.
        points: Points of all images together.
        image: Bounds of each image.
    """

    file_bytes: int = 512 * 2**20
    json_bytes: int = 64 * 2**20
    images: int = 20_000
    segments: int = 2_000_000
    points: int = 40_000_000
    image: SegmentLimits = SegmentLimits()


@dataclass(frozen=True)
class ArchiveLimits:
    """Bounds of an uploaded zip.

    Attributes:
        members: Files and folders in it, ignored ones included.
        member_bytes: One file after unpacking.
        total_bytes: All files after unpacking.
        ratio: Unpacked over packed size of one file of more than 1 MiB; deflate itself ends at 1032.
        name_bytes: One path, in UTF-8.
    """

    members: int = 20_000
    member_bytes: int = 512 * 2**20
    total_bytes: int = 8 * 2**30
    ratio: float = 200.0
    name_bytes: int = 1_000


SEGMENT_LIMITS = SegmentLimits()
SET_LIMITS = SetLimits()
ARCHIVE_LIMITS = ArchiveLimits()

COORDINATE_LIMIT = 1e6
"""Largest coordinate in px: far outside any image, and float32 still resolves 1/16 px there."""
