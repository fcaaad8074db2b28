"""Which predictions take which labels, and which of the others an ignored label excuses, for any threshold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.evaluation.covering import SLACK
from app.evaluation.line_iou import Overlaps
from app.evaluation.matching import Matches, match_pairs


@dataclass(frozen=True, eq=False)
class Rivalry:
    """Which labels P predictions compete for, at one tau.

    Attributes:
        pairs: Pairs of a prediction (``row``) and a label that counts (``column``).
        best_liou: float64 ``(P,)``, highest line IoU of each prediction over all labels, ignored ones included.
        best_label: int64 ``(P,)``, the first label with it; -1 where it is 0.
        on_ignored: bool ``(P,)``, whether that label is ignored.
    """

    pairs: Overlaps
    best_liou: NDArray[np.float64]
    best_label: NDArray[np.int64]
    on_ignored: NDArray[np.bool_]

    def matches(self, threshold: float) -> Matches:
        """Return the one-to-one matching: as many pairs as possible, and among those the greatest sum of line IoU."""
        return match_pairs(self.pairs.row, self.pairs.column, self.pairs.iou, threshold)

    def excused(self, threshold: float) -> NDArray[np.bool_]:
        """Whether each prediction is ignored if it takes no label, bool ``(P,)``.

        So it is when its highest line IoU over all labels is at least the threshold, and with an ignored label.
        """
        return self.on_ignored & (self.best_liou >= threshold - SLACK)

    def counts(self, threshold: float) -> tuple[int, int]:
        """Return the numbers of true and of false positives."""
        matched = self.matches(threshold).row
        excused = self.excused(threshold)
        excused[matched] = False
        return len(matched), len(excused) - len(matched) - int(excused.sum())


def rivalry(overlaps: Overlaps, ignored: NDArray[np.bool_], predictions: int) -> Rivalry:
    """Tell the labels that count from those that excuse.

    Args:
        overlaps: All pairs of a prediction and a label that run along one another, at one tau.
        ignored: bool ``(L,)``, which labels are ignored.
        predictions: P.
    """
    best = np.zeros(predictions)
    label = np.full(predictions, -1, np.int64)
    order = np.lexsort((-overlaps.column, overlaps.iou))  # of equal rows the last one is stored
    best[overlaps.row[order]] = overlaps.iou[order]
    label[overlaps.row[order]] = overlaps.column[order]
    return Rivalry(overlaps.select(~ignored[overlaps.column]), best, label, np.append(ignored, False)[label])
