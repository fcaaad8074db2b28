"""Samples about every px along edges of the street, as the lens shows them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.synthesis.projection import NEAR, View
from app.synthesis.sensor import LensMap

_NODES, _FEW_NODES = 33, 5  # where along an edge its length through the lens is measured, and is estimated
_SURELY_SHORT = 0.9  # of an estimate, which is never more and hardly less than the length
STEP = 1.0  # px of the photo from sample to sample
_RIM = 2.0  # px of the ideal picture in which nothing is asked


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples in order along edges, those of one edge together.

    Attributes:
        points: In the photo, float64 ``(n, 2)`` px.
        places: In the ideal picture, float64 ``(n, 2)`` px.
        inverse_depths: float64 ``(n,)`` 1/m.
        owners: The edge each belongs to, int64 ``(n,)``.
    """

    points: NDArray[np.float64]
    places: NDArray[np.float64]
    inverse_depths: NDArray[np.float64]
    owners: NDArray[np.int64]


def sample_edges(
    starts: NDArray[np.float64], ends: NDArray[np.float64], view: View, lens_map: LensMap, shortest: float
) -> Samples:
    """Sample straight edges ``(n, 3)`` to ``(n, 3)`` about every px of the photo.

    What lies outside the ideal picture is cut off first; of what is left, edges shorter than `shortest` px are left
    out.
    """
    rays_a, rays_b, depth_a, depth_b, owners = _clip(starts, ends, view)
    if shortest > 0:  # most edges are far and short
        likely = _arcs(rays_a, rays_b, lens_map, _FEW_NODES)[:, -1] >= _SURELY_SHORT * shortest
        rays_a, rays_b, depth_a, depth_b = (values[likely] for values in (rays_a, rays_b, depth_a, depth_b))
        owners = owners[likely]
    arcs = _arcs(rays_a, rays_b, lens_map, _NODES)
    long = arcs[:, -1] >= shortest
    rays_a, rays_b, depth_a, depth_b, arcs = (values[long] for values in (rays_a, rays_b, depth_a, depth_b, arcs))
    owners = owners[long]
    along = np.linspace(0, 1, _NODES)
    total = arcs[:, -1]
    counts = np.maximum(np.rint(total / STEP).astype(np.int64), 1) + 1
    row = np.repeat(np.arange(len(counts)), counts)
    position = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    wanted = position / (counts[row] - 1) * total[row]
    # one interpolation for all edges: each one's arcs are lifted above those of the one before
    lift = np.cumsum(total + 1) - (total + 1)
    nodes_at = along + 2.0 * np.arange(len(arcs))[:, None]
    share = np.interp(wanted + lift[row], (arcs + lift[:, None]).ravel(), nodes_at.ravel()) if len(arcs) else wanted
    share = (share - 2.0 * row).clip(0, 1)
    rays = _blend(rays_a[row], rays_b[row], share[:, None])
    return Samples(
        points=lens_map.lens.to_pixels(rays),
        places=rays * view.matrix[[0, 1], [0, 1]] + view.matrix[:2, 2],
        inverse_depths=_blend(depth_a[row], depth_b[row], share),
        owners=owners[row],
    )


def _arcs(
    rays_a: NDArray[np.float64], rays_b: NDArray[np.float64], lens_map: LensMap, count: int
) -> NDArray[np.float64]:
    """Lengths in the photo from edges' beginnings to `count` nodes of each, ``(n, count)`` px."""
    # in the ideal picture a line stays a line and its inverse depth is linear along it
    nodes = lens_map.lens.to_pixels(_blend(rays_a[:, None], rays_b[:, None], np.linspace(0, 1, count)[None, :, None]))
    x, y = np.diff(nodes[..., 0], axis=1), np.diff(nodes[..., 1], axis=1)
    arcs = np.zeros((len(nodes), count))
    np.cumsum(np.sqrt(x * x + y * y), axis=1, out=arcs[:, 1:])
    return arcs


def _blend(a: NDArray[np.float64], b: NDArray[np.float64], share: NDArray[np.float64]) -> NDArray[np.float64]:
    return a * (1 - share) + b * share


def _clip(
    starts: NDArray[np.float64], ends: NDArray[np.float64], view: View
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Cut edges to the view (Liang and Barsky 1984): rays and inverse depths at both ends, and whose they are."""
    a, b = view.pose.to_camera(starts), view.pose.to_camera(ends)
    low, high = np.zeros(len(a)), np.ones(len(a))
    inverse = np.linalg.inv(view.matrix)
    left, top = (inverse @ [_RIM, _RIM, 1])[:2]
    right, bottom = (inverse @ [view.width - 1 - _RIM, view.height - 1 - _RIM, 1])[:2]
    # the planes that bound what is seen, each as a value that is positive inside
    bounds = (
        ([0, 0, 1], -NEAR),
        ([1, 0, -left], 0.0),
        ([-1, 0, right], 0.0),
        ([0, 1, -top], 0.0),
        ([0, -1, bottom], 0.0),
    )
    for plane, offset in bounds:
        at_a, at_b = a @ np.array(plane, float) + offset, b @ np.array(plane, float) + offset
        with np.errstate(divide="ignore", invalid="ignore"):
            cut = at_a / (at_a - at_b)
        low = np.where((at_a < 0) & (at_b >= 0), np.maximum(low, cut), low)
        high = np.where((at_a >= 0) & (at_b < 0), np.minimum(high, cut), high)
        high = np.where((at_a < 0) & (at_b < 0), -1.0, high)
    inside = high > low
    a, b, low, high = a[inside], b[inside], low[inside, None], high[inside, None]
    first, last = _blend(a, b, low), _blend(a, b, high)
    return (
        first[:, :2] / first[:, 2:],
        last[:, :2] / last[:, 2:],
        1 / first[:, 2],
        1 / last[:, 2],
        np.flatnonzero(inside),
    )


def across(points: NDArray[np.float64], owners: NDArray[np.int64]) -> NDArray[np.float64]:
    """Unit normals along edges, ``(n, 2)``, from the neighbours of the same edge."""
    step = np.zeros((2, len(points)))
    if len(points) < 2:
        return step.T
    to_next = np.where(owners[1:] == owners[:-1], np.diff(points.T), 0.0)
    step[:, :-1] = to_next
    step[:, 1:] += to_next
    step /= np.maximum(np.sqrt(step[0] * step[0] + step[1] * step[1]), 1e-12)
    return np.stack([-step[1], step[0]], axis=1)
