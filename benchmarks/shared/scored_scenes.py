"""Made-up images to score: labels, and predictions with scores that find most of them, some in pieces or twice."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.evaluation import GroundTruth, ground_truth
from app.vision import Segments

SIZE = (1920, 1200)
"""Width and height of an image, px."""


def scene(seed: int, segments: int, points: int) -> tuple[GroundTruth, Segments]:
    """Return as many labels as predictions, of as many points each about 1 px apart.

    Of the predictions, two in three lie on a label, off by a normal error of 1 px; every fifth of those on the label
    that the one before it lies on. The others lie anywhere. One label in twenty is ignored.
    """
    random = np.random.default_rng(seed)
    labels = [_bent_line(random, points) for _ in range(segments)]
    on_label = 2 * segments // 3
    predictions = []
    for index in range(on_label):
        label = labels[index - 1 if index % 5 == 4 else index]
        along = (label[-1] - label[0]) * random.normal(0, 0.05)
        predictions.append(label + along + random.normal(0, 1.0, 2) + random.normal(0, 0.05, label.shape))
    predictions += [_bent_line(random, points) for _ in range(segments - on_label)]
    ambiguous = segments // 20
    truth = ground_truth(Segments.from_list(labels[ambiguous:]), Segments.from_list(labels[:ambiguous]))
    return truth, Segments.from_list(predictions, random.random(segments))


def _bent_line(random: np.random.Generator, points: int) -> NDArray[np.float64]:
    """A line with up to 5 px of sagitta per 200 px, in any direction."""
    along = np.arange(points) - (points - 1) / 2
    curve = np.stack([along, random.uniform(-1, 1) * 5e-4 * along**2], axis=1)
    angle = random.uniform(0, np.pi)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return curve @ turn + random.uniform((0, 0), SIZE)
