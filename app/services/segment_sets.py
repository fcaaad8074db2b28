"""Files that hold the segments of all images, read once for all their images."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from threading import Lock

from app.formats.labelled import LabelledSegments
from app.formats.npz import read_npz_set
from app.storage import BlobStore

MOST_SETS = 4
"""Truth and segments of two submissions: one that ends and one that begins, or two that are compared."""


class SegmentSets:
    """Reads npz files for all images from the store and remembers the latest. Safe to use from several threads.

    Args:
        blobs: The store.
    """

    def __init__(self, blobs: BlobStore) -> None:
        self._blobs = blobs
        self._latest: OrderedDict[str, Mapping[str, LabelledSegments]] = OrderedDict()
        self._lock = Lock()

    def read(self, sha256: str) -> Mapping[str, LabelledSegments]:
        """Return the segments of all images by name.

        Raises:
            NotFound: When there is no such blob.
            InvalidFile: When it is no such file.
        """
        with self._lock:
            if sha256 not in self._latest:
                self._latest[sha256] = read_npz_set(self._blobs.read(sha256), where=sha256)
            self._latest.move_to_end(sha256)
            while len(self._latest) > MOST_SETS:
                self._latest.popitem(last=False)
            return self._latest[sha256]
