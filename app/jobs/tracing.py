"""Tracing edges on request, in a worker of its own that remembers the edges of the latest images.

Finding the edge points of an image takes a tenth of a second for two million pixels, tracing one edge among them a
hundredth: whoever draws one line traces it many times while the pointer moves.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import BrokenExecutor, CancelledError, Executor
from dataclasses import dataclass
from functools import lru_cache
from threading import BoundedSemaphore
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.errors import Unavailable
from app.images.decode import decode_gray
from app.jobs.executor import make_executor
from app.jobs.on_demand import OnDemandWorker
from app.jobs.tasks import errors_that_travel
from app.storage import BlobStore
from app.vision.distortion import DistortionEstimate
from app.vision.division import Division
from app.vision.edge_following import follow_edge
from app.vision.edges import EdgeMap
from app.vision.measured_points import edges_of_image
from app.vision.tracing import Trace, measured_trace, straight_line, trace_edge

LONGEST_WAIT = 30.0
"""Seconds; what takes longer isn't waited for."""
MOST_WAITING = 8
"""Who trace at once; each of them keeps a thread of the server's and a copy of an image's file."""


@dataclass(frozen=True, eq=False)
class Wanted:
    """An edge to trace.

    Attributes:
        sha256: Of the image's file.
        image_name: For messages.
        distortion: The image's lens as ``DistortionEstimate.as_dict`` gives it; ``None`` where it isn't known.
        points: float64 ``(k, 2)`` px: points clicked along the edge, or the segment to extend.
        how: ``edge`` between the points, ``straight`` through them as drawn, or ``extend`` them at both ends.
        reach: px beside a clicked point that the edge may lie.
    """

    sha256: str
    image_name: str
    distortion: Mapping[str, Any] | None
    points: NDArray[np.float64]
    how: str
    reach: float


class Tracer:
    """Traces edges. Safe to use from several threads.

    Args:
        blobs: Where the images' bytes are.
        max_pixels: Greatest number of pixels that is decoded.
        executors: Makes an executor of so many workers; called again when one broke.
    """

    def __init__(
        self, blobs: BlobStore, max_pixels: int, *, executors: Callable[[int], Executor] = make_executor
    ) -> None:
        self._blobs = blobs
        self._max_pixels = max_pixels
        self._worker = OnDemandWorker(executors)
        self._room = BoundedSemaphore(MOST_WAITING)

    def trace(self, wanted: Wanted) -> Trace:
        """Trace an edge; waits for the worker.

        Raises:
            InvalidInput: On points that make no line, or lie outside the image.
            NoEdge: When no edge runs there.
            NotFound: When the image's file is gone.
            Unavailable: When too many wait, the worker was killed, or it takes too long.
            ClearLinesError: When the image can't be decoded.
        """
        if not self._room.acquire(blocking=False):
            raise Unavailable("other edges are being traced", hint="try again in a moment")
        try:
            return self._traced(wanted)
        finally:
            self._room.release()

    def stop(self) -> None:
        """End the worker at once; whoever waits is told that it was killed."""
        self._worker.stop()

    def _traced(self, wanted: Wanted) -> Trace:
        content = self._blobs.read(wanted.sha256)
        future = self._worker.submit(trace_task, content, wanted, max_pixels=self._max_pixels)
        try:
            return future.result(LONGEST_WAIT)
        except TimeoutError:
            future.cancel()  # what hasn't begun would be traced for nobody
            raise Unavailable("tracing takes long", where=wanted.image_name, hint="try again in a moment") from None
        except (BrokenExecutor, CancelledError):
            raise Unavailable(
                "the process that traced was killed",
                where=wanted.image_name,
                hint="most often memory ran out: a large image needs some 25 bytes per pixel",
            ) from None


def trace_task(content: bytes, wanted: Wanted, *, max_pixels: int) -> Trace:
    """Trace an edge in an image file.

    Args:
        content: The image file.
        wanted: What to trace.
        max_pixels: Greatest number of pixels that is decoded.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel(wanted.image_name, "tracing"):
        lens = lens_from(wanted.distortion)
        edges = _edges(content, max_pixels)
        height, width = edges.gray.shape
        if wanted.how == "straight":
            return straight_line(wanted.points, (width, height), lens=lens)
        if wanted.how == "extend":
            return measured_trace(follow_edge(edges, wanted.points), (width, height), lens)
        return trace_edge(edges, wanted.points, lens=lens, reach=wanted.reach)


def lens_from(distortion: Mapping[str, Any] | None) -> Division | None:
    """Return the lens of an estimate that was accepted; ``None`` for one that wasn't."""
    estimate = None if distortion is None else DistortionEstimate.from_dict(distortion)
    return estimate.division if estimate is not None and estimate.accepted else None


@lru_cache(maxsize=2)
def _edges(content: bytes, max_pixels: int) -> EdgeMap:
    """Of an image file; each that is remembered takes some 13 bytes per pixel of this process's memory."""
    return edges_of_image(decode_gray(content, max_pixels=max_pixels))
