from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.evaluation import ground_truth
from app.evaluation.average_precision import Ranked, average_precision
from app.evaluation.clearlines_v2 import score_image
from app.vision.segments import Segments

Line = NDArray[np.floating]


def ranked(
    labels: Sequence[Line], predictions: Sequence[Line], scores: Sequence[float], ambiguous: Sequence[Line] = ()
) -> Ranked:
    truth = ground_truth(Segments.from_list(labels), Segments.from_list(ambiguous))
    found = score_image(truth, Segments.from_list(predictions, scores)).ranked
    assert found is not None
    return found


def image(scores: Sequence[float], hits: Sequence[bool], labels: int) -> Ranked:
    return Ranked(np.array(scores, np.float32), np.array(hits, bool), labels)


def literal(images: Sequence[Ranked]) -> float:
    """The definition, one recall level and one score at a time."""
    rows = [(score, hit) for each in images for score, hit in zip(each.scores.tolist(), each.hit.tolist(), strict=True)]
    labels = sum(each.labels for each in images)
    if not labels:
        return float(not rows)
    points = []
    for cut in {score for score, _ in rows}:
        kept = [hit for score, hit in rows if score >= cut]
        points.append((sum(kept) / labels, sum(kept) / len(kept)))
    levels = [level / 100 for level in range(101)]
    return sum(max((p for r, p in points if r >= level - 1e-9), default=0.0) for level in levels) / 101


def test_a_perfect_ranking_has_1(line) -> None:
    lines = [line(200), line(200, 50), line(200, 90)]
    assert average_precision([ranked(lines, lines, [0.9, 0.5, 0.7])]) == 1


def test_false_positives_below_all_hits_cost_nothing(line) -> None:
    lines, wrong = [line(200), line(200, 50)], line(200, 0, (900.0, 900.0))
    assert average_precision([ranked(lines, [*lines, wrong], [0.9, 0.8, 0.1])]) == 1
    assert average_precision([ranked(lines, [*lines, wrong], [0.8, 0.7, 0.9])]) == pytest.approx(2 / 3)


def test_a_copy_with_a_lower_score_is_a_false_positive(line) -> None:
    found = ranked([line(200)], [line(200), line(200)], [0.4, 0.6])
    assert found.scores.tolist() == pytest.approx([0.6, 0.4])
    assert found.hit.tolist() == [True, False]


def test_the_higher_score_takes_the_label_even_if_it_fits_less(line) -> None:
    found = ranked([line(200)], [line(200), line(200)[:150]], [0.4, 0.6])
    assert found.hit.tolist() == [True, False]
    assert found.scores.tolist() == pytest.approx([0.6, 0.4])


def test_equal_scores_are_one_group_whatever_their_order(line) -> None:
    right, wrong = line(200), line(200, 0, (900.0, 900.0))
    for predictions in ([right, wrong], [wrong, right]):
        assert average_precision([ranked([right], predictions, [0.5, 0.5])]) == pytest.approx(0.5)
    assert average_precision([image([0.5], [True], 1), image([0.5], [False], 0)]) == pytest.approx(0.5)


def test_within_a_group_as_many_as_possible_are_matched(line) -> None:
    # the whole line fits either label; the half fits the second one alone
    first, second = line(200), line(130)
    assert ranked([first, second], [line(150), line(100)], [0.5, 0.5]).hit.all()


def test_an_excused_prediction_isn_t_ranked(line) -> None:
    unsure = line(200, 90)
    found = ranked([line(200)], [line(200), unsure], [0.2, 0.9], [unsure])
    assert found.hit.tolist() == [True]
    assert average_precision([found]) == 1


def test_absent_without_scores_and_defined_without_predictions(line) -> None:
    truth = ground_truth(Segments.from_list([line(100)]))
    assert score_image(truth, Segments.from_list([line(100)])).ranked is None
    nothing = score_image(truth, Segments.from_list([])).ranked
    assert nothing is not None
    assert average_precision([nothing]) == 0
    assert average_precision([image([], [], 0)]) == 1
    assert average_precision([image([0.3], [False], 0)]) == 0


images = st.lists(
    st.tuples(
        st.lists(st.tuples(st.sampled_from([0.1, 0.25, 0.5, 0.75]), st.booleans()), max_size=6), st.integers(0, 3)
    ),
    min_size=1,
    max_size=4,
).map(
    lambda rows: [
        image([score for score, _ in pairs], [hit for _, hit in pairs], sum(hit for _, hit in pairs) + missed)
        for pairs, missed in ((sorted(pairs, reverse=True), missed) for pairs, missed in rows)
    ]
)


@settings(deadline=None)
@given(images)
def test_equals_its_definition(found: list[Ranked]) -> None:
    assert average_precision(found) == pytest.approx(literal(found))


@settings(deadline=None, max_examples=50)
@given(images, st.integers(0, 2**32 - 1))
def test_a_weight_counts_an_image_that_often(found: list[Ranked], seed: int) -> None:
    weights = np.random.default_rng(seed).poisson(1.0, (5, len(found)))
    together = average_precision(found, weights.astype(float))
    for value, weight in zip(together, weights, strict=True):
        repeated = [each for each, times in zip(found, weight, strict=True) for _ in range(times)]
        assert value == pytest.approx(literal(repeated))


def test_weights_of_another_shape_are_refused() -> None:
    with pytest.raises(InvalidInput, match="weights"):
        average_precision([image([0.5], [True], 1)], np.ones((3, 2)))
