"""Merging arcs that lie on one circle.

Best first, as a heap would: of all pairs that may be merged, those that are the best choice of both their arcs are
merged at once; what they become is compared anew, until nothing is left to merge. A fit of a pair needs no points
(moments are additive), so all pairs of a round are fitted together.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from app.vision.arcs import Arcs, fit_arcs
from app.vision.circle import shift_sums
from app.vision.edges import Gradient
from app.vision.gaps import effective_gaps


@dataclass(frozen=True)
class MergeRule:
    """What two arcs must fulfil to become one.

    Attributes:
        same_polarity: Whether the bright side must be the same.
        angle: Largest angle between the facing ends in degrees.
        offset: Largest sideways distance of the facing ends in px, without a gap...
        offset_per_gap: ...and what each px of gap adds.
        rms: Largest root mean square distance from the common arc in px.
        largest: Largest distance of any of the four ends from the common arc in px.
        reach: Longest gap in px; a gap is also at most 0.6 times both lengths + 6.
        limit: Longest effective gap in px (see `app.vision.gaps`)...
        limit_per_length: ...and what each px of the arcs' length, up to 200, adds.
    """

    same_polarity: bool
    angle: float
    offset: float
    offset_per_gap: float
    rms: float
    largest: float
    reach: float
    limit: float
    limit_per_length: float


FOLLOWING = MergeRule(True, 8.0, 1.5, 0.06, 0.6, 1.5, 80.0, 10.0, 0.05)
# facades and poles flip the bright side along one straight edge
FLIPPING = MergeRule(False, 4.0, 1.0, 0.03, 0.4, 1.0, 36.0, 12.0, 0.0)

_OVERLAP = 2.0
# bounds the memory of large images
_PAIRS_AT_ONCE = 500_000


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Ends that face each other: end ``2 i`` is the start of arc ``i``, ``2 i + 1`` its end."""

    leave: NDArray[np.int64]
    enter: NDArray[np.int64]
    cost: NDArray[np.float64]

    def take(self, index: NDArray[np.bool_]) -> _Pairs:
        return _Pairs(self.leave[index], self.enter[index], self.cost[index])


def merge(arcs: Arcs, field: Gradient, rule: MergeRule) -> Arcs:
    """Merge arcs until no pair fulfils the rule.

    Args:
        arcs: Arcs of one image.
        field: Gradient of the equalised image, for the evidence in the gaps.
        rule: What pairs must fulfil.
    """
    alive = np.ones(len(arcs), bool)
    changed = np.arange(len(arcs))
    pairs = _Pairs(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))
    while len(changed):
        leave, enter = _neighbours(arcs, alive, changed, rule)
        parts = [pairs]
        for begin in range(0, len(leave), _PAIRS_AT_ONCE):
            part = slice(begin, begin + _PAIRS_AT_ONCE)
            parts.append(_examine(arcs, leave[part], enter[part], field, rule))
        pairs = _Pairs(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(_Pairs)))
        best = _mutually_best(pairs, len(arcs))
        if not best.any():
            break
        chosen = pairs.take(best)
        first, second = chosen.leave // 2, chosen.enter // 2
        joined = _join(arcs, chosen.leave, chosen.enter)
        arcs = _replaced(arcs, first, joined)
        alive[second] = False
        touched = np.zeros(len(arcs), bool)
        touched[first] = touched[second] = True
        pairs = pairs.take(~(touched[pairs.leave // 2] | touched[pairs.enter // 2]))
        changed = first
    return arcs.take(alive)


def _neighbours(
    arcs: Arcs, alive: NDArray[np.bool_], changed: NDArray[np.int64], rule: MergeRule
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of near ends of which one belongs to a changed arc, each once, in a fixed order."""
    ends = _end_points(arcs)
    lengths = np.maximum(arcs.lengths, 1.0)
    # a gap is at most 0.6 (L1 + L2) + 6, so the longer arc's length bounds it
    reach = np.minimum(1.2 * lengths + 6.0, rule.reach)
    is_changed = np.zeros(len(arcs), bool)
    is_changed[changed] = True
    everything = np.flatnonzero(np.repeat(alive, 2))
    fresh = np.flatnonzero(np.repeat(is_changed, 2))
    one, two = _within(ends, reach, fresh, everything)
    # every pair once: from the end with the longer reach, of equals from the lower number
    longer, equal = reach[one // 2] > reach[two // 2], reach[one // 2] == reach[two // 2]
    once = longer | (equal & ((one < two) | ~is_changed[two // 2]))
    one, two = one[once], two[once]
    if len(fresh) < len(everything):
        others = np.flatnonzero(np.repeat(alive & ~is_changed, 2))
        back_one, back_two = _within(ends, reach, others, fresh)
        longer = reach[back_one // 2] > reach[back_two // 2]
        one, two = np.concatenate([one, back_one[longer]]), np.concatenate([two, back_two[longer]])
    different = one // 2 != two // 2
    if rule.same_polarity:
        different &= one % 2 != two % 2
    one, two = one[different], two[different]
    # the end that is left comes first: an arc's end before a start, else the lower number
    swap = (one % 2 < two % 2) | ((one % 2 == two % 2) & (one > two))
    return np.where(swap, two, one), np.where(swap, one, two)


def _within(
    ends: NDArray[np.float64], reach: NDArray[np.float64], source: NDArray[np.int64], target: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of ends no farther apart than the source's reach, classed by reach to keep the searches narrow."""
    found = [(np.zeros(0, np.int64), np.zeros(0, np.int64))]
    if len(source) and len(target):
        tree = KDTree(ends[target])
        low = 0.0
        for high in (15.0, 25.0, 45.0, 80.0, np.inf):
            own = source[(reach[source // 2] > low) & (reach[source // 2] <= high)]
            low = high
            if len(own):
                radius = float(reach[own // 2].max())
                near = KDTree(ends[own]).sparse_distance_matrix(tree, radius, output_type="ndarray")
                one, two = own[near["i"]], target[near["j"]]
                good = near["v"] <= reach[one // 2]
                found.append((one[good], two[good]))
    first, second = (np.concatenate(part) for part in zip(*found, strict=True))
    return first, second


def _examine(
    arcs: Arcs, leave: NDArray[np.int64], enter: NDArray[np.int64], field: Gradient, rule: MergeRule
) -> _Pairs:
    """Keep the pairs that fulfil the rule, with the cost that orders them."""
    ends, outward = _end_points(arcs), _outward(arcs)
    lengths = np.maximum(arcs.lengths, 1.0)
    # the cheapest test that refuses most comes first
    facing = -(outward[leave] * outward[enter]).sum(axis=1) >= np.cos(np.radians(rule.angle))
    leave, enter = leave[facing], enter[facing]
    both = lengths[leave // 2] + lengths[enter // 2]
    vector = ends[enter] - ends[leave]
    gap = np.hypot(vector[:, 0], vector[:, 1])
    sideways = rule.offset + rule.offset_per_gap * gap
    good = gap <= np.minimum(0.6 * both + 6.0, rule.reach)
    for direction in (outward[leave], -outward[enter]):
        good &= (vector * direction).sum(axis=1) >= -_OVERLAP
        good &= np.abs(direction[:, 0] * vector[:, 1] - direction[:, 1] * vector[:, 0]) <= sideways
    leave, enter, both = leave[good], enter[good], both[good]

    joined = _join(arcs, leave, enter)
    worst = np.zeros(len(joined))
    for end in (leave, enter, leave ^ 1, enter ^ 1):
        worst = np.maximum(worst, np.abs(joined.project(slice(None), ends[end])[1]))
    fits = (joined.rms <= rule.rms) & (worst <= rule.largest)
    leave, enter, both, rms = leave[fits], enter[fits], both[fits], joined.rms[fits]

    cost = effective_gaps(arcs, leave // 2, enter // 2, ends[leave], ends[enter], rule.same_polarity, field)
    cost *= 1 + 2 * rms
    accepted = cost <= rule.limit + rule.limit_per_length * np.minimum(both, 200.0)
    return _Pairs(leave[accepted], enter[accepted], (cost + rms)[accepted])


def _mutually_best(pairs: _Pairs, count: int) -> NDArray[np.bool_]:
    """Mask of the pairs that are the cheapest of both their arcs."""
    rank = np.empty(len(pairs.cost), np.int64)
    rank[np.lexsort((pairs.enter, pairs.leave, pairs.cost))] = np.arange(len(rank))
    best = np.full(count, len(rank))
    np.minimum.at(best, pairs.leave // 2, rank)
    np.minimum.at(best, pairs.enter // 2, rank)
    return (best[pairs.leave // 2] == rank) & (best[pairs.enter // 2] == rank)


def _join(arcs: Arcs, leave: NDArray[np.int64], enter: NDArray[np.int64]) -> Arcs:
    """Arcs through both arcs of each pair; the direction is that of the longer one."""
    first, second = leave // 2, enter // 2
    ends = _end_points(arcs)
    sums = arcs.sums[first] + shift_sums(arcs.sums[second], arcs.origin[first] - arcs.origin[second])
    begin, finish = ends[leave ^ 1], ends[enter ^ 1]
    with_first, with_second = leave % 2 == 1, enter % 2 == 0
    longer_first = arcs.lengths[first] >= arcs.lengths[second]
    onward = np.where(longer_first, with_first, with_second)[:, None]
    traits_first, traits_second = arcs.traits[first], arcs.traits[second]
    # a flipped arc's dark side is the other one's bright side
    flipped = (with_first != with_second)[:, None]
    lesser_first = np.where(longer_first[:, None], traits_first, traits_first[:, [1, 0, 2]])
    lesser_second = np.where(longer_first[:, None], traits_second[:, [1, 0, 2]], traits_second)
    traits = np.where(flipped, lesser_first + lesser_second, traits_first + traits_second)
    return fit_arcs(arcs.origin[first], sums, traits, np.where(onward, begin, finish), np.where(onward, finish, begin))


def _replaced(arcs: Arcs, index: NDArray[np.int64], by: Arcs) -> Arcs:
    columns = []
    for field in fields(Arcs):
        column = getattr(arcs, field.name).copy()
        column[index] = getattr(by, field.name)
        columns.append(column)
    return Arcs(*columns)


def _end_points(arcs: Arcs) -> NDArray[np.float64]:
    both = (arcs.positions(slice(None), arcs.low), arcs.positions(slice(None), arcs.high))
    return np.stack(both, axis=1).reshape(-1, 2)


def _outward(arcs: Arcs) -> NDArray[np.float64]:
    both = (-arcs.directions(slice(None), arcs.low), arcs.directions(slice(None), arcs.high))
    return np.stack(both, axis=1).reshape(-1, 2)
