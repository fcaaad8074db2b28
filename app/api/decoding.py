"""Images are decoded for whoever looks at them a few at a time: each takes up to 30 bytes of memory per pixel."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import BoundedSemaphore

from app.errors import Unavailable

PLACES = 4
PATIENCE = 20.0
"""Seconds that somebody waits for a place."""


class Decoding:
    """Places for those who decode an image in a thread of the server. Safe to use from several threads.

    Args:
        places: How many there are.
        patience: How long somebody waits for one, s.
    """

    def __init__(self, places: int = PLACES, patience: float = PATIENCE) -> None:
        self._room = BoundedSemaphore(places)
        self._patience = patience

    @contextmanager
    def place(self) -> Iterator[None]:
        """Take a place for as long as the block runs; nobody who waits for one holds a session of the database.

        Raises:
            Unavailable: When none gets free.
        """
        if not self._room.acquire(timeout=self._patience):
            raise Unavailable("many images are being decoded", hint="try again in a moment")
        try:
            yield
        finally:
            self._room.release()
