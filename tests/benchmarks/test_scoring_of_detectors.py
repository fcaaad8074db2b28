"""What the benchmark of detectors counts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.sparse import csr_array

from app.evaluation.matching import match_one_to_one
from app.vision.segments import Segments
from benchmarks.shared.bootstrap import interval
from benchmarks.shared.ranking import gained, rank
from benchmarks.shared.strict_score import count, covered_samples, overlap

SHARES = st.sampled_from([0.0, 0.3, 0.5, 0.9])


@given(arrays(float, (7, 5), elements=SHARES), st.permutations(range(7)))
def test_gains_add_up_to_the_greatest_matching_of_the_first_candidates(matrix: np.ndarray, order: list[int]) -> None:
    gain = gained(csr_array(matrix), np.array(order), 0.5)
    for taken in range(1, 8):
        first = order[:taken]
        assert gain[first].sum() == len(match_one_to_one(matrix[first], 0.5).row)


def test_area_takes_precision_at_each_label_found() -> None:
    # by falling key: a hit, a false alarm, a hit; a third label isn't found
    matrix = csr_array([[0.0, 0.9, 0.0], [0.0, 0.0, 0.0], [0.9, 0.0, 0.0]])
    ranking = rank([np.array([3.0, 2.0, 1.0])], [3], [matrix], 0.5)
    assert ranking.area(np.array([1])) == pytest.approx((1 + 2 / 3) / 3)
    assert ranking.area(np.array([2])) == pytest.approx((1 + 2 / 3) / 3)


def test_candidates_of_one_key_come_together() -> None:
    matrix = csr_array([[0.9], [0.0]])
    for order in ([0, 1], [1, 0]):
        ranking = rank([np.zeros(2)], [1], [matrix[order]], 0.5)
        recall, precision = ranking.curve(np.array([1]))
        assert recall.tolist() == [1.0, 1.0]
        assert precision.tolist() == [0.5, 0.5]


def test_a_length_covered_twice_counts_once() -> None:
    label = Segments.from_list([[[0, 0], [100, 0]]])
    halves = Segments.from_list([[[0, 1], [50, 1]], [[10, -1], [50, -1]], [[80, -20], [80, 20]]])
    covered = covered_samples(label, halves)
    assert len(covered) == 101
    # a sample within 3 px of the end of a piece is covered by it, as the ends are 1 px beside the label
    assert np.flatnonzero(covered).tolist() == list(range(53))


def test_nothing_found_is_counted_as_missed() -> None:
    labels = [Segments.from_list([[[0, 0], [60, 0]]]), Segments.empty()]
    found = [Segments.empty(), Segments.from_list([[[0, 0], [60, 0]]])]
    counts = count(found, labels, overlap(found, labels))
    assert counts.hits.tolist() == [0, 0]
    assert counts.predictions.tolist() == [0, 1]
    assert counts.labels.tolist() == [1, 0]
    assert counts.length_recall(counts.once) == 0.0


def test_interval_of_what_is_the_same_in_all_images_is_a_point() -> None:
    share = np.full(5, 0.25)
    low, high = interval(lambda weights: float(weights @ share / weights.sum()), 5)
    assert (low, high) == pytest.approx((0.25, 0.25))
    widest = interval(lambda weights: float(weights[0]), 5)
    assert widest[0] == 0
    assert widest[1] > 1
