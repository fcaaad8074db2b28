"""What a blob is called: the SHA-256 of its content; and content as it comes in, piece by piece."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import BinaryIO

from app.errors import InvalidInput

CHUNK = 2**20
NAME = re.compile(r"[0-9a-f]{64}")
FAN = re.compile(r"[0-9a-f]{2}")

Content = bytes | BinaryIO | Iterable[bytes]


def key_of(sha256: str) -> str:
    """Return a blob's place in any store, ``ab/cd/abcd...``.

    Raises:
        InvalidInput: If it isn't 64 hexadecimal digits in lower case.
    """
    if not NAME.fullmatch(sha256):
        raise InvalidInput("this is no SHA-256", where=sha256[:80], expected="64 hexadecimal digits in lower case")
    return f"{sha256[:2]}/{sha256[2:4]}/{sha256}"


def is_name(text: str) -> bool:
    """Whether a file of that name may be a blob."""
    return NAME.fullmatch(text) is not None


def is_fan(text: str) -> bool:
    """Whether blobs may lie below a folder of that name."""
    return FAN.fullmatch(text) is not None


def pieces_of(content: Content) -> Iterable[bytes]:
    """Return the content in pieces; a stream is read to its end."""
    if isinstance(content, bytes):
        return [content]
    read = getattr(content, "read", None)
    return content if read is None else iter(lambda: read(CHUNK), b"")
