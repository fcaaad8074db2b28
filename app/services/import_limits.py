"""The bounds of an import, as the settings say."""

from __future__ import annotations

from dataclasses import replace

from app.formats.limits import ARCHIVE_LIMITS
from app.services.imports import ImportLimits
from app.settings import Settings


def import_limits(settings: Settings) -> ImportLimits:
    """Return how much an import takes."""
    archive = replace(
        ARCHIVE_LIMITS,
        members=settings.max_archive_members,
        total_bytes=settings.max_archive_bytes,
        member_bytes=settings.max_file_bytes,
    )
    return ImportLimits(settings.max_image_pixels, settings.max_file_bytes, archive)
