"""A scorer written independently of this project, where it lies beside it: a program that is run, not copied."""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from app.vision import Segments

REFERENCE_SCORER = Path(__file__).resolve().parents[3] / "shared" / "bench" / "score.py"
_COUNTS = ("tp", "fp", "fn", "covered", "labelled")


class ScoreImage(Protocol):
    """Score one image; lengths are in samples, one per px."""

    def __call__(self, labels: Sequence[NDArray[np.float32]], predictions: Sequence[NDArray[np.float32]]) -> Mapping:
        """Return the counts by name."""
        ...


def load_reference_scorer(path: Path = REFERENCE_SCORER) -> ScoreImage | None:
    """Return the program's function, or ``None`` where the file isn't there."""
    specification = importlib.util.spec_from_file_location("reference_scorer", path) if path.is_file() else None
    if specification is None or specification.loader is None:
        return None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module.score_image


def reference_counts(score: ScoreImage, labels: Sequence[Segments], found: Sequence[Segments]) -> dict[str, float]:
    """Add up what the reference counts in each image."""
    total: dict[str, float] = dict.fromkeys(_COUNTS, 0.0)
    for truth, predictions in zip(labels, found, strict=True):
        counted = score(list(truth), list(predictions))
        total = {name: value + counted[name] for name, value in total.items()}
    return total
