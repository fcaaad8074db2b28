"""Ranks of a leaderboard as far as its images can tell them.

A row's rank is an interval: from one more than the number of rows that are surely better, to the number of all but the
rows that are surely worse, where "surely" means that the interval of the paired difference lies on one side of 0.
Every row is measured on the same draws. Source: Mogstad, Romano, Shaikh and Wilhelm, "Inference for ranks with
applications to mobility across neighbourhoods and academic achievement across countries" (Review of Economic Studies
2024), here with an interval for each pair at the level, not for all pairs at once. Ranks within each draw, the other
custom, promise too much for rows that are close (Hall and Miller, "Using the bootstrap to quantify the authority of an
empirical ranking", Annals of Statistics 2009), and they need not agree with who is tied with whom; these always do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.errors import InvalidInput
from app.evaluation.bootstrap import DRAWS, FEWEST_CLUSTERS, LEVEL, Measure, bootstrap, interval
from app.evaluation.comparison import is_tied


@dataclass(frozen=True)
class Rank:
    """Where a row stands.

    Attributes:
        low: Best rank that the images allow, from 1.
        high: Worst rank that they allow.
        tied_with: Places of the other rows that they can't tell from this one, ascending;
            ``high - low`` is their number.
    """

    low: int
    high: int
    tied_with: tuple[int, ...]


def rank_board(
    measures: Sequence[Measure],
    clusters: ArrayLike,
    draws: int = DRAWS,
    *,
    seed: int,
    metric: str = "f1",
    level: float = LEVEL,
) -> list[Rank]:
    """Rank submissions that were scored on the same images.

    Args:
        measures: Metrics of each row under weightings of the images.
        clusters: int ``(I,)``, the cluster of each image.
        draws: B, number of draws; the same for all rows.
        seed: Of the draws.
        metric: The rank key; more is better.
        level: Share of draws within the interval of a difference.

    Returns:
        One rank per row, in the order given. Where there are fewer than two clusters, all are tied.

    Raises:
        InvalidInput: When there are no images or no draws, or the level isn't in (0, 1).
    """
    cluster = np.asarray(clusters)
    if not measures or len(np.unique(cluster)) < FEWEST_CLUSTERS:
        return ranks(np.zeros((len(measures), 1)), level)

    def of_rows(weights: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        return {"rows": np.stack([measure(weights)[metric] for measure in measures], axis=1)}

    return ranks(bootstrap(of_rows, cluster, draws, seed=seed)["rows"].T, level)


def ranks(drawn: NDArray[np.float64], level: float = LEVEL) -> list[Rank]:
    """Rank rows by the draws of their scores.

    Args:
        drawn: float64 ``(R, B)``, one score per row and draw; the draws of all rows are of the same images.
        level: Share of draws within the interval of a difference.

    Raises:
        InvalidInput: When ``drawn`` isn't a matrix, or the level isn't in (0, 1).

    Example:
        >>> ranks(np.array([[0.9, 0.8], [0.5, 0.6], [0.6, 0.5]]))
        [Rank(low=1, high=1, tied_with=()), Rank(low=2, high=3, tied_with=(2,)), Rank(low=2, high=3, tied_with=(1,))]
    """
    if drawn.ndim != 2:
        raise InvalidInput(f"draws of shape {drawn.shape} rank nothing", where="draws", expected="(rows, draws)")
    rows = len(drawn)
    surely_better = np.zeros((rows, rows), bool)  # [i, j]: i than j
    for row in range(rows - 1):
        low, high = interval((drawn[row] - drawn[row + 1 :]).T, level)
        surely_better[row, row + 1 :] = ~is_tied(low, high) & (low > 0)
        surely_better[row + 1 :, row] = ~is_tied(low, high) & (high < 0)
    tied = ~(surely_better | surely_better.T)
    np.fill_diagonal(tied, False)
    return [
        Rank(
            low=1 + int(surely_better[:, row].sum()),
            high=rows - int(surely_better[row].sum()),
            tied_with=tuple(np.flatnonzero(tied[row]).tolist()),
        )
        for row in range(rows)
    ]
