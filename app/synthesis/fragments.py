"""Small surfaces of one colour, all at once: which pixels each covers, and how much of them.

Most surfaces of a street are a few px wide. Working out their pixels one surface at a time takes longer than painting
them, so it is done for all together; only the painting itself goes one by one, from the far to the near.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Fragments:
    """Pixels of S surfaces, those of one surface together.

    Attributes:
        offsets: int64 ``(S + 1,)``: surface s has the fragments ``offsets[s]`` to ``offsets[s + 1]``.
        pixels: int64 ``(F,)``: row times picture width plus column.
        cover: float32 ``(F,)``: share of the pixel inside, above 0.
    """

    offsets: NDArray[np.int64]
    pixels: NDArray[np.int64]
    cover: NDArray[np.float32]


def cover_small(
    boxes: NDArray[np.int64], edges: Sequence[NDArray[np.float32]], opacities: NDArray[np.float32], width: int
) -> Fragments:
    """Cover the pixels of S small polygons: boxes ``(S, 4)``, edge functions ``(c, 3)`` each, opacities ``(S,)``."""
    counts = np.array([len(each) for each in edges], np.int64)
    owners, pixels, covers = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)], [np.zeros(0, np.float32)]
    for count in np.unique(counts):
        chosen = np.flatnonzero(counts == count)
        owner, columns, rows = _box_pixels(boxes[chosen])
        functions = np.stack([edges[index] for index in chosen.tolist()])
        x, y = columns.astype(np.float32), rows.astype(np.float32)
        cover = np.ones(len(x), np.float32)
        for edge in range(count):
            a, b, c = functions[:, edge].T
            np.minimum(cover, a[owner] * x + b[owner] * y + (c + np.float32(0.5))[owner], out=cover)
        inside = np.flatnonzero(cover > 0)
        owner = chosen[owner[inside]]
        owners.append(owner)
        pixels.append(rows[inside] * width + columns[inside])
        covers.append(cover[inside] * opacities[owner])
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    offsets = np.searchsorted(owner[order], np.arange(len(edges) + 1))
    return Fragments(offsets, np.concatenate(pixels)[order], np.concatenate(covers)[order])


def _box_pixels(boxes: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """All pixels of boxes ``(n, 4)``: which box, column and row of each."""
    wide = boxes[:, 2] - boxes[:, 0]
    sizes = wide * (boxes[:, 3] - boxes[:, 1])
    owner = np.repeat(np.arange(len(boxes)), sizes)
    place = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    row, column = np.divmod(place, wide[owner])
    return owner, boxes[owner, 0] + column, boxes[owner, 1] + row
