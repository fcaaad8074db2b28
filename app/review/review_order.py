"""What is most worth a look: candidates in the order of their expected value.

Three orders: the most uncertain first, where a verdict tells the model most; the most informative for the lens first,
as a bend grows with the square of the length and the distance from the centre; and the value of both.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput
from app.review.strands import strands
from app.vision.segments import Segments

Array = NDArray[np.float64]
Order = Literal["uncertain", "lens", "value", "place"]
ORDERS: tuple[Order, ...] = ("value", "uncertain", "lens", "place")


def uncertainty(probability: ArrayLike) -> Array:
    """Return the entropy of a verdict in bits, float64 ``(S,)`` in [0, 1]."""
    p = np.clip(np.asarray(probability, np.float64), 1e-9, 1 - 1e-9)
    return -(p * np.log2(p) + (1 - p) * np.log2(1 - p))


def lens_information(segments: Segments, size: tuple[int, int]) -> Array:
    """Return what each candidate would tell of the lens if it is straight, float64 ``(S,)`` in [0, 1] within the image.

    The bend that a change of k1 gives a line of length l at distance d from the centre grows with l^2 d, and what is
    known of it with the square root of the number of points.
    """
    traced = strands(segments, size)
    centre = np.array([(traced.width - 1) / 2, (traced.height - 1) / 2])
    lever = np.abs(np.einsum("sd,sd->s", traced.middle - centre, traced.normal)) / traced.diagonal
    bend = (traced.length / traced.diagonal) ** 2 * lever * np.sqrt(segments.counts)
    most = bend.max(initial=0.0)
    return bend / most if most > 0 else bend


def review_values(probability: ArrayLike, segments: Segments, size: tuple[int, int]) -> Array:
    """Return what a look at each candidate is worth: uncertain and long first, float64 ``(S,)`` in [0, 1]."""
    return look_values(probability, lens_information(segments, size))


def look_values(probability: ArrayLike, information: ArrayLike) -> Array:
    """Return `review_values` from what each candidate would tell of the lens, ``(S,)`` in [0, 1]."""
    p = np.asarray(probability, np.float64)
    return 0.7 * uncertainty(p) + 0.3 * p * np.asarray(information, np.float64)


def review_order(
    probability: ArrayLike, segments: Segments, size: tuple[int, int], order: Order = "value"
) -> NDArray[np.int64]:
    """Return candidates in the order of review, int64 ``(S,)``.

    Args:
        probability: That a person keeps each, ``(S,)``.
        segments: S candidates, px.
        size: Width and height of the image, px.
        order: What comes first: ``"value"`` of a look, the ``"uncertain"``, those informative for the ``"lens"``, or
            from left to right.

    Raises:
        InvalidInput: On another order.
    """
    p = np.asarray(probability, np.float64)
    if order == "value":
        keys = -review_values(p, segments, size)
    elif order == "uncertain":
        keys = -uncertainty(p)
    elif order == "lens":
        keys = -p * lens_information(segments, size)
    elif order == "place":
        keys = strands(segments, size).middle[:, 0]
    else:
        raise InvalidInput(f"{order!r} is no order", where="order", expected=", ".join(ORDERS))
    return np.argsort(keys, kind="stable").astype(np.int64)
