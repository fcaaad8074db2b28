"""A camera's name where it is safe: in the name of a file and inside one.

Names come from people and may hold anything; most formats have no escape, or one that their own readers get wrong.
"""

from __future__ import annotations

import re
import unicodedata

FILE_LENGTH = 60
"""Most characters of a camera's name in a file's name."""
TEXT_LENGTH = 120
"""Most characters of a camera's name within a file."""
UNNAMED = "camera"

QUOTES = str.maketrans({"'": "’", "`": "’", '"': "”", "\\": "/"})


def file_stem(camera_name: str) -> str:
    """Return the name as letters, digits, ``-`` and ``_`` of ASCII, to begin a file's name with; never empty."""
    plain = unicodedata.normalize("NFKD", camera_name).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9]+", "_", plain).strip("_")[:FILE_LENGTH].strip("_") or UNNAMED


def one_line(camera_name: str) -> str:
    """Return the name as one line without quotes, backslashes and characters that can't be seen; never empty.

    What is left can stand in a comment or between quotes of any format here but XML, where it is escaped.
    """
    seen = "".join(character if character.isprintable() else " " for character in camera_name)
    return " ".join(seen.translate(QUOTES).split())[:TEXT_LENGTH].strip() or UNNAMED
