"""Train the model that suggests before anything was learnt: python tools/train_prior.py [--scenes N].

It learns from synthetic scenes alone, so that no photo's labels are in the package; app/review/prior.json is written
anew. Photos differ from scenes, and fewer of their candidates are true: the log odds are brought nearer to each other,
and lowered, so that the prior promises less.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]  # as the benchmarks are run

from app.review.features import FEATURES  # noqa: E402
from app.review.prior import PRIOR_FILE  # noqa: E402
from app.review.suggestion_model import SuggestionModel  # noqa: E402
from app.review.training import TrainingSet, train  # noqa: E402
from benchmarks.shared.review_images import synthetic_images  # noqa: E402

SCENES = 60
FIRST_SEED = 1000
MODESTY = 0.6
"""Share of the slope that is left."""
SHARE_KEPT = 0.5
"""Of the scenes' candidates, by the prior: between the 0.7 that are true there and the 0.24 to 0.46 of photos."""


def train_prior(scenes: int, first_seed: int) -> SuggestionModel:
    """Return the prior, trained on scenes of seeds from the first one on."""
    images = list(synthetic_images(scenes, first_seed))
    examples = TrainingSet(
        np.concatenate([image.features for image in images]),
        np.concatenate([image.kept for image in images]),
        np.repeat(np.arange(len(images)), [len(image.kept) for image in images]),
    )
    nothing = np.zeros(len(FEATURES))
    blank = SuggestionModel(0.0, nothing, np.ones(len(FEATURES)), nothing)
    trained = train(examples, seed=0, prior=blank)
    print(trained.report)
    return modest(trained.model, examples)


def modest(model: SuggestionModel, examples: TrainingSet) -> SuggestionModel:
    """Return the model with a smaller slope, and the offset that makes it keep `SHARE_KEPT` of the examples."""
    slope = MODESTY * model.slope
    evidence = slope * model.evidence(examples.features)
    low, high = -20.0, 20.0
    for _ in range(60):
        middle = (low + high) / 2
        mean = float(np.mean(1 / (1 + np.exp(-(evidence + middle)))))
        low, high = (middle, high) if mean < SHARE_KEPT else (low, middle)
    return replace(model, slope=slope, offset=(low + high) / 2)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=SCENES, help="how many scenes to learn from")
    parser.add_argument("--first-seed", type=int, default=FIRST_SEED, help="seed of the first scene")
    options = parser.parse_args()
    model = train_prior(options.scenes, options.first_seed)
    PRIOR_FILE.write_text(json.dumps(model.as_dict(), separators=(",", ":")) + "\n")


if __name__ == "__main__":
    main()
