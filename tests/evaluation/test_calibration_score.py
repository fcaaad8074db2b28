from __future__ import annotations

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from app.evaluation import ground_truth
from app.evaluation.calibration_score import CalibrationScore, score_calibration, total_calibration
from app.evaluation.ground_truth import GroundTruth
from app.vision.brown import Brown
from app.vision.frame import center_of, half_diagonal
from app.vision.segments import Segments

WIDTH, HEIGHT = 1200, 800
LENS = Brown(WIDTH, HEIGHT, center_of(WIDTH, HEIGHT), half_diagonal(WIDTH, HEIGHT), (0.25, 0.0, 0.0))


def seen_through(lens: Brown, count: int, seed: int, noise: float = 0.05) -> Segments:
    """Straight lines of a scene as the lens shows them."""
    random = np.random.default_rng(seed)
    lines: list[NDArray[np.float64]] = []
    while len(lines) < count:
        ends = random.uniform(0.03, 0.97, (2, 2)) * [WIDTH, HEIGHT]
        length = float(np.hypot(*(ends[1] - ends[0])))
        if length > 150:
            first, last = lens.undistort(ends)
            points = lens.distort(first + np.linspace(0, 1, int(length))[:, None] * (last - first))
            lines.append(points + random.normal(0, noise, points.shape))
    return Segments.from_list(lines)


@pytest.fixture(scope="module")
def truths() -> list[GroundTruth]:
    return [ground_truth(seen_through(LENS, 30, seed)) for seed in range(2)]


def test_good_segments_straighten_the_labels_and_find_the_lens(truths: list[GroundTruth]) -> None:
    submitted = [seen_through(LENS, 60, seed) for seed in (10, 11)]
    score = score_calibration("front", truths, submitted, (WIDTH, HEIGHT), reference=LENS)
    assert score.accepted
    assert score.rms is not None
    assert score.rms_uncorrected is not None
    assert score.rms < 0.1
    assert score.rms_uncorrected > 10 * score.rms
    assert score.grid is not None
    assert score.grid_uncorrected is not None
    assert score.grid < 1
    assert score.grid_uncorrected > 10 * score.grid


@pytest.mark.parametrize("count", [0, 1])
def test_too_few_segments_count_as_no_correction(truths: list[GroundTruth], count: int) -> None:
    submitted = [seen_through(LENS, count, 1), Segments.empty()]
    score = score_calibration("front", truths, submitted, (WIDTH, HEIGHT), reference=LENS)
    assert not score.accepted
    assert score.reasons
    assert (score.rms, score.grid) == (score.rms_uncorrected, score.grid_uncorrected)


def test_ignored_labels_do_not_count_and_without_labels_there_is_no_straightness() -> None:
    bent = np.stack([np.arange(200.0), 0.01 * np.arange(200.0) ** 2], axis=1)
    straight = seen_through(Brown.identity(WIDTH, HEIGHT), 5, 0, noise=0.0)
    truth = ground_truth(straight, Segments.from_list([bent]))
    score = score_calibration("front", [truth], [Segments.empty()], (WIDTH, HEIGHT))
    assert score.rms == pytest.approx(0, abs=1e-3)
    assert score.grid is None
    nothing = score_calibration("front", [ground_truth(Segments.empty())], [straight], (WIDTH, HEIGHT))
    assert (nothing.rms, nothing.points) == (None, 0)


def test_each_px_of_line_counts_alike_however_its_points_lie() -> None:
    along = np.arange(301.0)
    arc = np.stack([along + 100, 300 + 0.0002 * (along - 150) ** 2], axis=1)
    crowded = np.concatenate([arc[:100], np.repeat(arc[100:140], 20, axis=0), arc[140:]])
    even, uneven = (
        score_calibration("a", [ground_truth(Segments.from_list([line]))], [Segments.empty()], (WIDTH, HEIGHT)).rms
        for line in (arc, crowded)
    )
    assert even == pytest.approx(uneven, rel=1e-3)


def test_squares_are_averaged_over_points_and_over_cameras() -> None:
    def of(points: int, rms: float | None, grid: float | None) -> CalibrationScore:
        return CalibrationScore("c", 1, True, (), rms, rms, points, grid, grid)

    total = total_calibration([of(100, 1.0, 3.0), of(300, 2.0, None), of(0, None, 4.0)])
    assert total.rms == pytest.approx(np.sqrt((100 + 300 * 4) / 400))
    assert total.grid == pytest.approx(np.sqrt(12.5))
    assert total_calibration([]).rms is None
    assert total_calibration([]).grid is None


def test_a_score_is_json(truths: list[GroundTruth]) -> None:
    score = score_calibration("front", truths, [Segments.empty()] * 2, (WIDTH, HEIGHT))
    content = json.loads(json.dumps(score.as_dict(), allow_nan=False))
    assert content["camera"] == "front"
    assert content["grid"] is None


def test_the_estimator_is_the_one_that_scores_were_made_with(truths: list[GroundTruth]) -> None:
    """If these numbers move, stored calibration scores can't be compared with new ones: raise SCORER_VERSION."""
    submitted = [seen_through(LENS, 40, seed, noise=0.3) for seed in (20, 21)]
    score = score_calibration("front", truths, submitted, (WIDTH, HEIGHT), reference=LENS)
    assert (score.rms, score.grid) == pytest.approx((0.040392, 0.071101), rel=0.01)
