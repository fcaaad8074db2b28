"""What protocol official-v1 does that its reader should know, said wherever its numbers stand."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from app.evaluation.official_v1 import IOU_THRESHOLD, PROTOCOL, ImageScore

_NAMES_SHOWN = 5


def consequences(names: Sequence[str], scores: Sequence[ImageScore]) -> list[str]:
    """Return the known consequences of the protocol that these scores show, one sentence each."""
    scored = list(zip(names, scores, strict=True))

    found = [
        f"{PROTOCOL} compares bounding boxes, not lines: lines that cross can count as equal, and how far a line may be"
        " off depends on its direction."
    ]
    repeated = sum(_repeated(score) for score in scores)
    if repeated:
        found.append(
            f"Nothing is matched one-to-one: {repeated} of {sum(score.true_positives for score in scores)} true"
            " positives have their best overlap with a label that another prediction already had."
        )
    above_one = [name for name, score in scored if score.recall is not None and score.recall > 1]
    if above_one:
        found.append(f"Recall exceeds 1 in {_named(above_one)}, as several predictions count for one label.")
    empty = [name for name, score in scored if not score.labels and not score.predictions]
    if empty:
        found.append(f"No labels and no predictions in {_named(empty)}: counted with precision and recall 0.")
    unlabelled = [name for name, score in scored if score.recall is None]
    if unlabelled:
        found.append(f"Predictions but no labels in {_named(unlabelled)}: precision 0, left out of the mean recall.")
    silent = [name for name, score in scored if score.labels and not score.predictions]
    if silent:
        found.append(f"No predictions in {_named(silent)}: counted with precision 0.")
    if not any(score.true_positives for score in scores):
        found.append("Precision and recall are both 0, so F1 is set to 0.")
    return found


def _repeated(score: ImageScore) -> int:
    labels = score.best_label[score.best_iou >= IOU_THRESHOLD]
    return len(labels) - len(np.unique(labels))


def _named(names: Iterable[str]) -> str:
    names = list(names)
    shown = ", ".join(names[:_NAMES_SHOWN])
    more = f" and {len(names) - _NAMES_SHOWN} more" if len(names) > _NAMES_SHOWN else ""
    return f"{len(names)} {'image' if len(names) == 1 else 'images'} ({shown}{more})"
