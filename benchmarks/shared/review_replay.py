"""A person who knows the truth and wastes nothing: the fewest actions found that set all verdicts of an image right.

Only what the label page offers is used, and every key, click and stroke is an action:

- a click or a stroke with a brush; pressing and holding another brush's key than that of the one in hand is one more.
  A brush that is chosen in the tool bar stays in hand from image to image;
- a click that selects a candidate, and a key that judges its family;
- ``S`` accepts the suggestions, ``R`` rejects all that is undecided;
- ``Enter`` ends the image. ``Shift+Enter`` accepts the suggestions wherever nothing was decided, and ends it.

Of several plans the cheapest counts: which brush first, with families or without, and how much harm a stroke may do.
Ways (b) and (c) differ in what is there to begin with, and are played by the same plans. The turn brush goes by the
suggestions in (c), where it is in hand; in (b), where it turns all that it touches, whichever brush suits an image is
taken to be in hand.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .review_strokes import Strokes
from .review_touching import BESIDE
from .review_turning import MIDDLE, turned

KEEP, REJECT, OPEN = 1, 0, -1
HARMS = (0.5, 1.0)
"""What a verdict that a stroke makes wrong is taken to cost later, in actions."""
MOST_PHASES = 8
TURN_PLANS = 4
"""Ways to use the turn brush; all but the first take strokes for a little better or worse than they are."""
SHAKEN = 0.4
"""Actions, standard deviation of that."""
TRIES = 12
"""Strokes that look best by the raster, of which the best by the page's rule is made."""
FINISH = 1
"""The key that ends an image."""
WORTH_A_FAMILY = 3.0
"""Verdicts that a family must put right: a click and a key, where a held brush needs a click for each."""


@dataclass(frozen=True, eq=False)
class Page:
    """An image of S candidates on the label page.

    Attributes:
        strokes: That may be made.
        truth: int64 ``(S,)``, `KEEP` or `REJECT`.
        family: int64 ``(S,)``, its family, -1 alone.
    """

    strokes: Strokes
    truth: NDArray[np.int64]
    family: NDArray[np.int64]


class Effort(NamedTuple):
    """What it took.

    Attributes:
        actions: Keys, clicks and strokes.
        wrong: Verdicts that are wrong in the end.
        strokes: Of the actions, strokes that touch several candidates.
        families: Families judged, two actions each.
        holds: Of the actions, brush keys held.
    """

    actions: int
    wrong: int
    strokes: int
    families: int
    holds: int


def keep_then_reject(page: Page) -> Effort:
    """Way (b): keep the true ones, then reject the rest; or reject all, and turn the true ones."""
    keeping = _cheapest(page, np.full(len(page.truth), OPEN), keys=FINISH, in_hand=True)
    turning = _turn(page, np.full(len(page.truth), REJECT), None, keys=1 + FINISH)
    return min(keeping, turning, key=lambda effort: effort.actions)


def keep_by_clicks(page: Page) -> Effort:
    """Way (b) without strokes and families: one click each with the brush in hand, then reject the rest."""
    return Effort(int((page.truth == KEEP).sum()) + 1 + FINISH, 0, 0, 0, 0)


def by_turning(
    page: Page, probability: NDArray[np.float64], order: NDArray[np.float64], *, keys: int = FINISH
) -> Effort:
    """Put suggestions right by the turn brush alone and accept the rest at the end, by one key with the image's end.

    Args:
        page: The image.
        probability: ``(S,)``, of being kept; what is below 0.5 begins as rejected.
        order: ``(S,)`` in [0, 1], what decides which of the touched candidates lie between a stroke's ends.
        keys: That judge what no stroke turns and end the image.
    """
    return _turn(page, np.where(probability >= MIDDLE, KEEP, REJECT).astype(np.int64), order, keys=keys)


def with_suggestions(
    page: Page,
    probability: NDArray[np.float64],
    keep: float,
    reject: float,
    without: Effort,
    *,
    turning: bool = True,
) -> Effort:
    """Way (c): accept the suggestions, then put right what is wrong, and judge what was left.

    Args:
        page: The image.
        probability: ``(S,)``, of being kept.
        keep: Least probability that is suggested to be kept.
        reject: Probability below which it is suggested to reject.
        without: Way (b), for an image whose suggestions are not worth accepting.
        turning: Whether the turn brush is in hand; it is of use where the suggestions leave nothing open.
    """
    state = np.full(len(page.truth), OPEN)
    state[probability >= keep] = KEEP
    state[probability < reject] = REJECT
    # with the turn brush in hand, the others' keys have to be held
    any_open = bool((state == OPEN).any())
    # what is left open is rejected after the suggestions were accepted, so that one key can't accept and end the image
    keys = FINISH + any_open
    ways = [
        _cheapest(page, state, keys=keys, in_hand=not turning),
        without._replace(actions=without.actions + turning),
    ]
    if turning and not any_open:
        ways.append(_turn(page, state, probability, keys=keys))
    return min(ways, key=lambda effort: (effort.wrong, effort.actions))


def _turn(page: Page, state: NDArray[np.int64], probability: NDArray[np.float64] | None, *, keys: int) -> Effort:
    """Use the turn brush until all is right, plain where no probability is given; and the keys that judge and end."""
    strokes, at_first = page.strokes, state != page.truth
    if not at_first.any():
        return Effort(keys, 0, 0, 0, 0)
    order = np.zeros(len(state)) if probability is None else probability
    lines = np.full_like(strokes.lines, BESIDE) if probability is None else strokes.lines
    sets = turned(strokes.touched, lines, order)
    rows = np.flatnonzero(sets[:, at_first].any(axis=1) & (sets.sum(axis=1) > 1))
    sets = sets[rows].astype(np.float32)

    def exactly(row: int) -> NDArray[np.bool_]:
        chosen = rows[row : row + 1]
        return turned(strokes.exactly(int(chosen[0]))[None], lines[chosen], order)[0]

    plans = []
    for seed in range(TURN_PLANS):
        wrong, made, random = at_first.copy(), 0, np.random.default_rng(seed)
        shaken = random.normal(0.0, SHAKEN if seed else 0.0, len(sets)).astype(np.float32)
        while (best := _best_stroke(sets, np.where(wrong, 1.0, -1.0), exactly, shaken)) is not None:
            wrong ^= best
            made += 1
        plans.append(Effort(keys + made + int(wrong.sum()), 0, made, 0, 0))
    return min(plans, key=lambda plan: plan.actions)


def _cheapest(page: Page, state: NDArray[np.int64], *, keys: int, in_hand: bool) -> Effort:
    plans = [_plan(page, state, *way) for way in product((KEEP, REJECT), HARMS, (False, True))]
    best = min(plans, key=lambda plan: (plan.wrong, plan.actions))
    spared = min(best.holds, 1) if in_hand else 0
    return best._replace(actions=best.actions + keys - spared, holds=best.holds - spared)


def _plan(page: Page, state: NDArray[np.int64], first: int, harm: float, by_family: bool) -> Effort:
    """Take one brush, then the other, until all is right or will be when the rest is rejected."""
    state = state.copy()
    any_open = bool((state == OPEN).any())
    effort = Effort(int(any_open), 0, 0, 0, 0)
    for phase in range(MOST_PHASES):
        if (_settled(state) == page.truth).all():
            break
        verdict = first if phase % 2 == 0 else 1 - first
        effort = _added(effort, _judge(page, state, verdict, harm, by_family))
    return effort._replace(wrong=int((_settled(state) != page.truth).sum()))


def _settled(state: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the verdicts after the rest was rejected."""
    return np.where(state == OPEN, REJECT, state)


def _added(one: Effort, other: Effort) -> Effort:
    return Effort(*(a + b for a, b in zip(one, other, strict=True)))


def _judge(page: Page, state: NDArray[np.int64], verdict: int, harm: float, by_family: bool) -> Effort:
    """Give one verdict to all that need it, changing `state`."""
    wanted = page.truth == verdict

    def gain() -> NDArray[np.float64]:
        """What it is worth to give each candidate the verdict now."""
        return np.where(_settled(state) == verdict, 0.0, np.where(wanted, 1.0, -harm))

    families = _judge_families(page, state, verdict, gain) if by_family else 0
    strokes = 0
    rows = np.flatnonzero(page.strokes.touched[:, gain() > 0].sum(axis=1) > 1)
    useful = page.strokes.touched[rows].astype(np.float32)
    held = bool((gain() > 0).any())
    while (best := _best_stroke(useful, gain(), lambda row: page.strokes.exactly(int(rows[row])))) is not None:
        state[best] = verdict
        strokes += 1
    clicked = gain() > 0
    state[clicked] = verdict
    return Effort(2 * families + held + strokes + int(clicked.sum()), 0, strokes, families, int(held))


def _best_stroke(
    touched: NDArray[np.float32],
    gain: NDArray[np.float64],
    exactly: Callable[[int], NDArray[np.bool_]],
    shaken: NDArray[np.float32] | None = None,
) -> NDArray[np.bool_] | None:
    """Return what the best stroke judges by the page's rule; ``None`` if none is worth more than a click."""
    worth = touched @ gain.astype(np.float32)
    if shaken is not None:
        worth = np.where(worth > 1, worth + shaken, worth)
    likely = np.argpartition(-worth, min(TRIES, len(worth) - 1))[:TRIES] if len(worth) else np.zeros(0, np.int64)
    found, most = None, 1.0
    for row in likely[np.argsort(-worth[likely], kind="stable")]:
        if worth[row] <= most:
            break
        judged = exactly(int(row))
        value = float(gain[judged].sum())
        if value > 1:
            extra = 0.0 if shaken is None else float(shaken[row])
            if value + extra > most:
                found, most = judged, value + extra
    return found


def _judge_families(page: Page, state: NDArray[np.int64], verdict: int, gain: Callable[[], NDArray[np.float64]]) -> int:
    families = 0
    for number in np.unique(page.family[page.family >= 0]):
        members = page.family == number
        if gain()[members].sum() >= WORTH_A_FAMILY:
            state[members] = verdict
            families += 1
    return families
