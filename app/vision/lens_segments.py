"""Which candidates of an image may speak for the lens."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.vision.bins import BinnedSegments
from app.vision.segments import Segments

MIN_LENS_LENGTH = 60.0
"""px of chord; what a segment knows of the lens falls with the fifth power of its length."""
BORDER = 6.0
"""px; what runs along the frame's border is often the edge of a black margin left by an earlier correction."""
MOST_FITTED = 4000
"""Segments that one fit takes, the most informative of each image; more add time but no information."""


def lens_mask(segments: Segments, width: int, height: int) -> NDArray[np.bool_]:
    """Tell which segments are long enough and not along the frame's border, bool ``(S,)``.

    Args:
        segments: Segments in px.
        width: Image width in px.
        height: Image height in px.
    """
    if not len(segments):
        return np.zeros(0, bool)
    x, y = segments.points.T
    margin = np.minimum(np.minimum(x, width - 1 - x), np.minimum(y, height - 1 - y))
    at_border = np.bincount(segments.segment_of_point, margin < BORDER, len(segments)) / segments.counts
    return (segments.extents() >= MIN_LENS_LENGTH) & (at_border < 0.5)


def most_informative(binned: BinnedSegments, images: int, most: int = MOST_FITTED) -> BinnedSegments:
    """Keep at most about `most` segments, an equal share of each image, long and smooth ones first.

    Args:
        binned: Segments of one camera.
        images: Number of images they come from.
        most: How many to keep in all; every image keeps at least one.
    """
    if len(binned) <= most:
        return binned
    share = max(1, most // max(images, 1))
    # a bend grows with the square of the length, its noise is sigma
    order = np.lexsort((-(binned.length**2) / binned.sigma, binned.image))
    image = binned.image[order]
    rank = np.arange(len(order)) - np.searchsorted(image, image)
    return binned.select(np.sort(order[rank < share]))
