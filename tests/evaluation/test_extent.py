from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from app.evaluation import ground_truth
from app.evaluation.clearlines_v2 import ImageScore, score_image
from app.evaluation.tallies import metrics
from app.vision.segments import Segments

Line = NDArray[np.floating]


def score(labels: Sequence[Line], predictions: Sequence[Line], ambiguous: Sequence[Line] = ()) -> ImageScore:
    truth = ground_truth(Segments.from_list(labels), Segments.from_list(ambiguous))
    return score_image(truth, Segments.from_list(predictions))


def row(begin: float, end: float, y: float = 100.0) -> Line:
    return np.stack([np.arange(begin, end + 1), np.full(int(end - begin) + 1, y)], axis=1)


def test_completeness_and_correctness_are_lengths_not_counts() -> None:
    # 300 of 400 px found (and 3 px that tau reaches beyond), by a line that is right along its whole length
    found = metrics(score([row(0, 400)], [row(0, 300)]).tallies)
    assert found["completeness"] == pytest.approx(304 / 401)
    assert found["correctness"] == pytest.approx(1)
    assert found["quality"] == pytest.approx(304 / 401)
    # and the reverse: a line that runs on beyond its label
    found = metrics(score([row(0, 300)], [row(0, 400)]).tallies)
    assert found["completeness"] == pytest.approx(1)
    assert found["correctness"] == pytest.approx(304 / 401)


def test_length_that_several_predictions_cover_counts_once() -> None:
    found = metrics(score([row(0, 400)], [row(0, 250), row(150, 400)]).tallies)
    assert found["completeness"] == pytest.approx(1)
    # 500 px of predictions for 400 px of label
    assert found["redundancy"] == pytest.approx(1 - 400 / 500)


def test_a_label_in_pieces_is_detected_by_their_sum() -> None:
    thirds = [row(0, 130), row(134, 266), row(270, 400)]
    result = score([row(0, 400)], thirds)
    assert len(result.matches.row) == 0
    assert result.extent.detected.tolist() == [True]
    assert result.extent.pieces.tolist() == [3]
    assert metrics(result.tallies)["fragmentation"] == 3


def test_a_piece_that_covers_too_little_detects_nothing() -> None:
    result = score([row(0, 400)], [row(0, 130)])
    assert result.extent.detected.tolist() == [False]
    assert np.isnan(metrics(result.tallies)["fragmentation"])


def test_a_line_over_two_labels_is_a_merge_if_it_is_a_hit() -> None:
    labels = [row(0, 250), row(260, 400)]
    result = score(labels, [row(0, 400)])
    assert result.matches.column.tolist() == [0]
    assert result.extent.merged.tolist() == [2]
    assert metrics(result.tallies)["merge"] == 1
    assert metrics(score(labels, labels).tallies)["merge"] == 0


def test_crossing_lines_cover_nothing_of_one_another() -> None:
    column = row(0, 400)[:, ::-1] + [100.0, -100.0]
    found = metrics(score([row(0, 400)], [column]).tallies)
    assert (found["completeness"], found["correctness"], found["quality"]) == (0, 0, 0)
    assert np.isnan(found["redundancy"])


def test_an_excused_prediction_adds_no_length_anywhere() -> None:
    unsure, real = row(0, 400, 300), row(0, 400)
    found = metrics(score([real], [real, unsure, unsure], [unsure]).tallies)
    assert (found["completeness"], found["correctness"]) == pytest.approx((1, 1))
    assert found["redundancy"] == pytest.approx(0)
    assert found["fragmentation"] == 1
