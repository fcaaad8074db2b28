"""What a foreign file system raises, said in our own words and without the secrets that it was opened with."""

from __future__ import annotations

import logging
import re
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit, urlunsplit

from app.errors import ClearLinesError, Unavailable

logger = logging.getLogger(__name__)

HARMLESS = frozenset(
    {"endpoint_url", "region_name", "region", "signature_version", "addressing_style", "mode", "host", "project"}
)
"""Options whose values may be shown; every other text among the options is taken for a secret."""

SHORTEST_SECRET = 4
LONGEST_REASON = 300
USER = re.compile(r"//[^/@\s]+@")


def shown_address(url: str) -> str:
    """Return an address without the user, password and query in it."""
    parts = urlsplit(url)
    return urlunsplit((parts.scheme, parts.netloc.rpartition("@")[2], parts.path, "", ""))


def secrets_in(options: Mapping[str, Any]) -> frozenset[str]:
    """Return the texts among the options that nobody may see, at whatever depth they stand."""
    return frozenset(text for text in _texts(options) if len(text) >= SHORTEST_SECRET)


def _texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for name, inner in value.items():
            if name not in HARMLESS:
                yield from _texts(inner)
    elif isinstance(value, list | tuple):
        for inner in value:
            yield from _texts(inner)


def reason_of(error: BaseException, secrets: Collection[str]) -> str:
    """Return an error's kind and words, cut to a line, with each secret struck out."""
    words = " ".join(str(error).split())
    for secret in sorted(secrets, key=len, reverse=True):
        words = words.replace(secret, "***")
    words = USER.sub("//***@", words)
    return f"{type(error).__name__}: {words}"[:LONGEST_REASON] if words else type(error).__name__


def refusal(error: BaseException, address: str, secrets: Collection[str]) -> Unavailable:
    """Return the error to raise for one of a file system, whose own words are for the log, and not for strangers."""
    what, hint = _said(error)
    logger.warning("%s: %s: %s", address, what, reason_of(error, secrets))
    return Unavailable(what, where=address, hint=f"{hint}; the log says more")


def _said(error: BaseException) -> tuple[str, str]:
    """Return what happened, and what helps."""
    name = type(error).__name__
    if isinstance(error, PermissionError) or "Credentials" in name:
        return (
            "the store of the uploaded files refuses",
            "look at CLEARLINES_BLOB_OPTIONS: key, secret, and whether they may list, read, write and delete",
        )
    if isinstance(error, TimeoutError) or "Timeout" in name:
        return "the store of the uploaded files doesn't answer in time", "try again later"
    if isinstance(error, TypeError | ValueError | LookupError):
        return (
            "the store of the uploaded files can't be used",
            "look at CLEARLINES_BLOB_URL and CLEARLINES_BLOB_OPTIONS",
        )
    return (
        "the store of the uploaded files can't be reached",
        "try again; if that doesn't help, look at CLEARLINES_BLOB_URL and at the endpoint_url in its options",
    )


@contextmanager
def told(address: str, secrets: Collection[str]) -> Iterator[None]:
    """Turn what a file system raises into `Unavailable`; what a missing file means, others know."""
    try:
        yield
    except (ClearLinesError, FileNotFoundError):
        raise
    except Exception as error:  # each file system has its own tree of errors
        raise refusal(error, address, secrets) from None  # the error itself may hold a secret


def missing_root(address: str) -> Unavailable:
    """Return the error for a bucket, or a folder, that isn't there."""
    return Unavailable(
        "the store of the uploaded files isn't there",
        where=address,
        expected="a bucket or folder that exists",
        hint="make it, or correct CLEARLINES_BLOB_URL",
    )
