"""What the benchmark of scoring scores, and the plain loop it is timed against."""

from __future__ import annotations

import numpy as np
import pytest

from app.evaluation import clearlines_v2, ground_truth, official_v1
from app.evaluation.tallies import metrics
from benchmarks.shared.plain_official import precision_and_recall
from benchmarks.shared.scored_scenes import scene


def test_a_scene_has_as_many_segments_and_points_as_asked_for() -> None:
    truth, predictions = scene(3, 40, 60)
    assert truth.segments.counts.tolist() == predictions.counts.tolist() == [60] * 40
    assert truth.ignored.sum() == 2
    again, _ = scene(3, 40, 60)
    assert again.segments == truth.segments


def test_a_scene_has_hits_copies_misses_and_false_alarms() -> None:
    truth, predictions = scene(4, 60, 100)
    found = metrics(clearlines_v2.score_image(truth, predictions).tallies)
    assert 0.3 < found["precision"] < 0.9
    assert 0.3 < found["recall"] < 0.9
    assert found["fragmentation"] > 1


@pytest.mark.parametrize("seed", [1, 2])
def test_the_plain_loop_computes_official_v1(seed: int) -> None:
    truth, predictions = scene(seed, 30, 50)
    plain = [[tuple(point) for point in line.tolist()] for line in truth.segments]
    found = [[tuple(point) for point in line.tolist()] for line in predictions]
    score = official_v1.score_image(ground_truth(truth.segments), predictions)
    assert precision_and_recall(plain, found) == pytest.approx((score.precision, score.recall), rel=0, abs=1e-12)
    assert np.isfinite(score.best_iou).all()
