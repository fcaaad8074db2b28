"""What an import takes, and what it says at its end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from app.formats.limits import ARCHIVE_LIMITS, ArchiveLimits
from app.services.image_summaries import ImageSummary


@dataclass(frozen=True)
class ImportLimits:
    """How much an import takes.

    Attributes:
        max_pixels: Width times height of one image.
        file_bytes: Size of one image or label file.
        archive: Bounds of a zip.
    """

    max_pixels: int = 40_000_000
    file_bytes: int = 256 * 2**20
    archive: ArchiveLimits = ARCHIVE_LIMITS


@dataclass(frozen=True)
class ExistingImage:
    """A file whose content is in the dataset already."""

    name: str
    image_id: int


@dataclass(frozen=True)
class FailedFile:
    """A file that wasn't taken, and why (see ``ClearLinesError.as_dict``)."""

    name: str
    error: dict[str, Any]


@dataclass(frozen=True)
class ImportReport:
    """What became of each file.

    Attributes:
        labels: Images that got labels.
    """

    added: tuple[ImageSummary, ...] = ()
    existing: tuple[ExistingImage, ...] = ()
    failed: tuple[FailedFile, ...] = ()
    labels: int = 0


@dataclass(frozen=True)
class FolderImport:
    """The dataset that a folder went into, and what became of each file."""

    slug: str
    report: ImportReport
