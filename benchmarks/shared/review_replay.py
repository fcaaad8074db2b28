"""A person who knows the truth and wastes nothing: the fewest actions found that set all verdicts of an image right.

Only what the label page offers is used, and every key, click and stroke is an action:

- a click or a stroke while a brush key is held; pressing and holding that key is one more;
- a click that selects a candidate, and a key that judges its family;
- ``S`` accepts the suggestions, ``R`` rejects all that is undecided.

Of several plans the cheapest counts: which brush first, with families or without, and how much harm a stroke may do.
Ways (b) and (c) differ in what is there to begin with, and are played by the same plans.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

KEEP, REJECT, OPEN = 1, 0, -1
HARMS = (0.5, 1.0)
"""What a verdict that a stroke makes wrong is taken to cost later, in actions."""
MOST_PHASES = 8
WORTH_A_FAMILY = 3.0
"""Verdicts that a family must put right: a click and a key, where a held brush needs a click for each."""


@dataclass(frozen=True, eq=False)
class Page:
    """An image of S candidates on the label page.

    Attributes:
        strokes: float32 ``(K, S)``, 1 where a stroke touches a candidate.
        truth: int64 ``(S,)``, `KEEP` or `REJECT`.
        family: int64 ``(S,)``, its family, -1 alone.
    """

    strokes: NDArray[np.float32]
    truth: NDArray[np.int64]
    family: NDArray[np.int64]


class Effort(NamedTuple):
    """What it took.

    Attributes:
        actions: Keys, clicks and strokes.
        wrong: Verdicts that are wrong in the end.
        strokes: Of the actions, strokes that touch several candidates.
        families: Families judged, two actions each.
    """

    actions: int
    wrong: int
    strokes: int
    families: int


def keep_then_reject(page: Page) -> Effort:
    """Way (b): keep the true ones, then reject the rest."""
    return _cheapest(page, np.full(len(page.truth), OPEN), before=0)


def keep_by_clicks(page: Page) -> Effort:
    """Way (b) without strokes and families: one click each with the brush held, then reject the rest."""
    true = int((page.truth == KEEP).sum())
    return Effort(true + (true > 0) + 1, 0, 0, 0)


def with_suggestions(
    page: Page, probability: NDArray[np.float64], keep: float, reject: float, without: Effort
) -> Effort:
    """Way (c): accept the suggestions, then put right what is wrong, and judge what was left.

    Args:
        page: The image.
        probability: ``(S,)``, of being kept.
        keep: Least probability that is suggested to be kept.
        reject: Probability below which it is suggested to reject.
        without: Way (b), for an image whose suggestions are not worth accepting.
    """
    state = np.full(len(page.truth), OPEN)
    state[probability >= keep] = KEEP
    state[probability < reject] = REJECT
    return min(_cheapest(page, state, before=1), without, key=lambda effort: (effort.wrong, effort.actions))


def _cheapest(page: Page, state: NDArray[np.int64], *, before: int) -> Effort:
    plans = [_plan(page, state, *way) for way in product((KEEP, REJECT), HARMS, (False, True))]
    best = min(plans, key=lambda plan: (plan.wrong, plan.actions))
    return best._replace(actions=best.actions + before)


def _plan(page: Page, state: NDArray[np.int64], first: int, harm: float, by_family: bool) -> Effort:
    """Take one brush, then the other, until all is right or will be when the rest is rejected."""
    state = state.copy()
    any_open = bool((state == OPEN).any())
    effort = Effort(int(any_open), 0, 0, 0)
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

    def gain() -> NDArray[np.float32]:
        """What it is worth to give each candidate the verdict now."""
        return np.where(_settled(state) == verdict, 0.0, np.where(wanted, 1.0, -harm)).astype(np.float32)

    families = _judge_families(page, state, verdict, gain) if by_family else 0
    strokes = 0
    useful = page.strokes[page.strokes @ (gain() > 0).astype(np.float32) > 1]
    held = bool((gain() > 0).any())
    while len(useful):
        worth = useful @ gain()
        best = int(np.argmax(worth))
        if worth[best] <= 1:
            break
        state[useful[best] > 0] = verdict
        strokes += 1
    clicked = gain() > 0
    state[clicked] = verdict
    return Effort(2 * families + held + strokes + int(clicked.sum()), 0, strokes, families)


def _judge_families(page: Page, state: NDArray[np.int64], verdict: int, gain: Callable[[], NDArray[np.float32]]) -> int:
    families = 0
    for number in np.unique(page.family[page.family >= 0]):
        members = page.family == number
        if gain()[members].sum() >= WORTH_A_FAMILY:
            state[members] = verdict
            families += 1
    return families
