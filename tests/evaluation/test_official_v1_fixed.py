from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.evaluation import Outcome, ground_truth
from app.evaluation.boxes import box_iou, padded_boxes
from app.evaluation.official_v1_fixed import ImageScore, metrics, score_image
from app.vision.segments import Segments

Line = NDArray[np.floating]


def score(labels: Sequence[Line], predictions: Sequence[Line], ambiguous: Sequence[Line] = ()) -> ImageScore:
    truth = ground_truth(Segments.from_list(labels), Segments.from_list(ambiguous))
    return score_image(truth, Segments.from_list(predictions))


def totals(*scores: ImageScore) -> dict[str, float]:
    return {name: value.item() for name, value in metrics(np.sum([each.tallies for each in scores], axis=0)).items()}


def test_five_copies_of_one_correct_line_count_once(line) -> None:
    result = score([line(300, 20)], [line(300, 20)] * 5)
    assert (result.precision, result.recall) == (0.2, 1.0)
    assert totals(result)["fixed_f1"] == pytest.approx(1 / 3)


def test_boxes_still_take_a_cross_for_the_line(line) -> None:
    assert score([line(300, 45)], [line(300, 135)]).precision == 1


@pytest.mark.parametrize(("angle", "hits"), [(0, 1), (45, 0)])
def test_of_two_halves_that_share_the_cut_point_one_counts_at_most(line, angle, hits) -> None:
    whole = line(400, angle)
    result = score([whole], [whole[:201], whole[200:]])
    assert (result.precision, result.recall) == (hits / 2, hits)


def test_the_greatest_sum_goes_before_the_most_pairs() -> None:
    def box(x: float) -> Line:
        return np.array([[x, 0.0], [x + 100, 100.0]])

    # three pairs of .504 each, or two of 1
    result = score([box(0), box(33), box(66)], [box(-33), box(0), box(33)])
    assert result.matches.row.tolist() == [1, 2]
    assert result.matches.value.tolist() == [1, 1]


def test_micro_counts_segments_and_macro_averages_images(line) -> None:
    lines = [line(200, 15 * k, (100.0 + 150 * k, 500.0)) for k in range(4)]
    wrong = [line(30, 0, (900.0, 50.0 * k)) for k in range(3)]
    one, four = score(lines[:1], lines[:1]), score(lines, [lines[0], *wrong])
    found = totals(one, four)
    assert (found["fixed_precision"], found["fixed_recall"]) == (2 / 5, 2 / 5)
    assert (found["fixed_macro_precision"], found["fixed_macro_recall"]) == ((1 + 1 / 4) / 2, (1 + 1 / 4) / 2)
    assert found["fixed_macro_f1"] == pytest.approx(0.625)


def test_empties_are_defined(line) -> None:
    nothing, silent, unlabelled = score([], []), score([line(100)], []), score([], [line(100)])
    assert (nothing.precision, nothing.recall) == (1, 1)
    assert (silent.precision, silent.recall) == (0, 0)
    assert (unlabelled.precision, unlabelled.recall) == (0, None)
    assert totals(nothing)["fixed_f1"] == 1
    assert totals(unlabelled, nothing)["fixed_macro_recall"] == 1
    assert totals(unlabelled)["fixed_macro_f1"] == 0


def test_an_ambiguous_label_excuses_whatever_lies_best_on_it(line) -> None:
    real, unsure, wrong = line(200), line(200, 90, (100.0, 100.0)), line(200, 0, (900.0, 900.0))
    result = score([real], [real, unsure, unsure, wrong], [unsure])
    assert result.outcomes.predictions.tolist() == [
        Outcome.HIT,
        Outcome.IGNORED,
        Outcome.IGNORED,
        Outcome.FALSE_ALARM,
    ]
    assert (result.precision, result.recall) == (0.5, 1.0)
    assert result.best_label.tolist() == [0, 1, 1, -1]


corner = st.integers(0, 12).map(float)
diagonal = st.tuples(corner, corner, corner, corner).map(lambda ends: np.array(ends).reshape(2, 2) * 5)


@settings(deadline=None, max_examples=80)
@given(st.lists(diagonal, min_size=1, max_size=4), st.lists(diagonal, min_size=1, max_size=4))
def test_is_the_best_of_all_assignments(labels: list[Line], predictions: list[Line]) -> None:
    iou = box_iou(*(padded_boxes(Segments.from_list(side)) for side in (predictions, labels)))
    worth = np.where(iou >= 0.5, iou, 0.0)
    if len(predictions) > len(labels):
        worth = worth.T
    best = max(
        sum(worth[row, column] for row, column in enumerate(columns))
        for columns in permutations(range(worth.shape[1]), worth.shape[0])
    )
    assert score(labels, predictions).matches.value.sum() == pytest.approx(best)
