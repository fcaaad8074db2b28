"""Slugs: the short ASCII names of datasets in addresses."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container

MAX_LENGTH = 80
FALLBACK = "dataset"

# letters that Unicode doesn't take apart into a base letter and a mark
_LETTERS = str.maketrans(
    {"ß": "ss", "æ": "ae", "œ": "oe", "ø": "o", "đ": "d", "ð": "d", "þ": "th", "ł": "l", "ħ": "h", "ı": "i"}
)


def slug_of(name: str) -> str:
    """Return a slug of ``a-z``, ``0-9`` and single hyphens; a fallback for names without a Latin letter or digit."""
    letters = unicodedata.normalize("NFKD", name.lower().translate(_LETTERS))
    plain = letters.encode("ascii", "ignore").decode().lower()
    return re.sub(r"[^a-z0-9]+", "-", plain).strip("-")[:MAX_LENGTH].rstrip("-") or FALLBACK


def free_slug(base: str, taken: Container[str]) -> str:
    """Return the slug itself, else with the first free number from 2 on."""
    slug, number = base, 1
    while slug in taken:
        number += 1
        slug = f"{base}-{number}"
    return slug
