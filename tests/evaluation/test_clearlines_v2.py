from __future__ import annotations

import math
import pickle
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.errors import TooLarge
from app.evaluation import Outcome, ground_truth, long_enough
from app.evaluation.clearlines_v2 import ImageScore, score_image
from app.evaluation.tallies import LAYOUT, metrics
from app.vision.segments import Segments

Line = NDArray[np.floating]

ANGLES = [0, 23, 45, 60, 90, 151]


def score(labels: Sequence[Line], predictions: Sequence[Line], ambiguous: Sequence[Line] = ()) -> ImageScore:
    truth = ground_truth(Segments.from_list(labels), Segments.from_list(ambiguous))
    return score_image(truth, Segments.from_list(predictions))


def counts(result: ImageScore) -> tuple[float, float, float]:
    part = LAYOUT.unpack(result.tallies)
    return float(part["tp"]), float(part["fp"]), float(part["fn"])


def values(result: ImageScore) -> dict[str, float]:
    return {name: value.item() for name, value in metrics(result.tallies).items() if not value.ndim}


def normal(angle: float) -> NDArray[np.float64]:
    return np.array([-np.sin(np.radians(angle)), np.cos(np.radians(angle))])


# What official-v1 gets wrong.


@pytest.mark.parametrize("angle", ANGLES)
def test_copies_of_a_correct_line_are_false_positives(line, angle) -> None:
    result = score([line(300, angle)], [line(300, angle)] * 5)
    assert counts(result) == (1, 4, 0)
    assert values(result)["precision"] == 0.2
    assert values(result)["recall"] == 1.0
    assert values(result)["f1"] == pytest.approx(1 / 3)
    assert values(result)["redundancy"] == pytest.approx(0.8)
    assert values(result)["fragmentation"] == 5


@pytest.mark.parametrize("angle", ANGLES)
def test_a_cross_is_a_false_positive_and_the_line_is_missed(line, angle) -> None:
    result = score([line(300, angle)], [line(300, angle + 90)])
    assert counts(result) == (0, 1, 1)
    assert values(result)["completeness"] == 0


def test_an_arc_104_px_off_is_a_false_positive() -> None:
    radius = 104 / (1 - math.sqrt(0.5))
    angle = np.linspace(0, np.pi / 2, 600)
    arc = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    assert counts(score([np.linspace(arc[0], arc[-1], 600)], [arc])) == (0, 1, 1)


@pytest.mark.parametrize("angle", ANGLES)
def test_a_shift_is_accepted_up_to_3_px_in_every_direction(line, angle) -> None:
    label = line(400, angle)
    assert counts(score([label], [label + 2.99 * normal(angle)])) == (1, 0, 0)
    assert counts(score([label], [label + 3.02 * normal(angle)])) == (0, 1, 1)


@pytest.mark.parametrize("angle", ANGLES)
def test_a_turn_is_accepted_up_to_1_28_degrees_in_every_direction(line, angle) -> None:
    assert counts(score([line(400, angle)], [line(400, angle + 1.27)])) == (1, 0, 0)
    assert counts(score([line(400, angle)], [line(400, angle + 1.31)])) == (0, 1, 1)


@pytest.mark.parametrize("angle", ANGLES)
def test_half_the_line_is_enough_in_every_direction(line, angle) -> None:
    whole = line(400, angle)
    assert counts(score([whole], [whole[:201]])) == (1, 0, 0)
    assert counts(score([whole], [whole[:192]])) == (0, 1, 1)


@pytest.mark.parametrize("angle", ANGLES)
def test_of_two_halves_that_share_the_cut_point_one_is_a_hit_in_every_direction(line, angle) -> None:
    whole = line(400, angle)
    result = score([whole], [whole[:201], whole[200:]])
    assert counts(result) == (1, 1, 0)
    assert values(result)["fragmentation"] == 2
    assert values(result)["completeness"] == pytest.approx(1)


# Empties.


def test_nothing_to_find_and_nothing_found_is_perfect() -> None:
    found = values(score([], []))
    assert (found["f1"], found["precision"], found["recall"], found["mean_f1"]) == (1, 1, 1, 1)
    assert (found["completeness"], found["correctness"], found["quality"]) == (1, 1, 1)
    assert all(math.isnan(found[name]) for name in ("fragmentation", "merge", "offset_mean", "bias", "mean_liou"))


def test_predictions_without_labels_are_false_positives(line) -> None:
    result = score([], [line(100), line(100, 90)])
    assert counts(result) == (0, 2, 0)
    assert (values(result)["f1"], values(result)["recall"], values(result)["correctness"]) == (0, 0, 0)
    assert result.best_label.tolist() == [-1, -1]


def test_labels_without_predictions_are_missed(line) -> None:
    result = score([line(100), line(100, 90)], [])
    assert counts(result) == (0, 0, 2)
    assert (values(result)["f1"], values(result)["precision"], values(result)["completeness"]) == (0, 0, 0)
    assert result.outcomes.labels.tolist() == [Outcome.MISS, Outcome.MISS]


def test_segments_of_one_point_match_nothing(line) -> None:
    point = np.array([[500.0, 500.0]])
    assert counts(score([point, line(100)], [point])) == (0, 1, 2)


# Labels that don't count.


def test_a_prediction_on_an_ambiguous_label_counts_neither_way(line) -> None:
    real, unsure, wrong = line(200), line(200, 90, (100.0, 100.0)), line(200, 0, (900.0, 900.0))
    result = score([real], [real, unsure, wrong], [unsure])
    assert counts(result) == (1, 1, 0)
    assert result.outcomes.predictions.tolist() == [Outcome.HIT, Outcome.IGNORED, Outcome.FALSE_ALARM]
    assert result.outcomes.labels.tolist() == [Outcome.HIT, Outcome.IGNORED]
    assert result.best_label.tolist() == [0, 1, -1]
    assert values(result)["correctness"] == pytest.approx(0.5)


def test_every_copy_on_an_ambiguous_label_is_ignored(line) -> None:
    assert counts(score([], [line(200)] * 3, [line(200)])) == (0, 0, 0)


def test_ignoring_is_decided_after_matching(line) -> None:
    # it fits the ambiguous label better, yet the real one is free: a hit
    real = line(200)
    assert counts(score([real], [real[:150]], [real[:150]])) == (1, 0, 0)
    # the real one is taken: what is left lies best on the ambiguous one
    assert counts(score([real], [real, real[:150]], [real[:150]])) == (1, 0, 0)


def test_a_prediction_that_fits_a_real_label_better_isn_t_excused(line) -> None:
    real = line(200)
    result = score([real], [real, real], [real[:150]])
    assert counts(result) == (1, 1, 0)


def test_an_ambiguous_label_excuses_nobody_below_the_threshold(line) -> None:
    unsure = line(400)
    assert counts(score([], [unsure[:192]], [unsure])) == (0, 1, 0)
    assert counts(score([], [unsure[:201]], [unsure])) == (0, 0, 0)


def test_what_lies_on_an_ambiguous_label_alone_isn_t_incorrect_length(line) -> None:
    unsure = line(400)
    found = values(score([], [unsure[:192]], [unsure]))
    assert (found["fp"], found["correctness"]) == (1, 1)  # nothing predicted that counts, nothing to find


def test_short_labels_are_ignored_and_short_predictions_left_out(line) -> None:
    labels = Segments.from_list([line(200), line(90, 90)])
    truth = ground_truth(labels, min_length=100)
    # 110 px over the ignored label of 90 px: long enough to be scored, and excused
    predictions = Segments.from_list([line(200), line(110, 90), line(80, 90)])
    result = score_image(truth, long_enough(predictions, 100))
    assert counts(result) == (1, 0, 0)
    assert result.outcomes.predictions.tolist() == [Outcome.HIT, Outcome.IGNORED]


# The score as a whole.


def test_the_grid_has_the_rank_key_at_3_px_and_one_half(line) -> None:
    lines = [line(300, 10 * k, (300.0 + 40 * k, 500.0)) for k in range(6)]
    shifts = (0, 0.9, 1.9, 2.9, 3.9, 4.9)
    predictions = [each + shift * normal(10 * k) for k, (each, shift) in enumerate(zip(lines, shifts, strict=True))]
    found = metrics(score(lines, predictions).tallies)
    assert found["f1_grid"].shape == (4, 10)
    assert found["f1_grid"][2, 0] == found["f1"]
    assert (np.diff(found["f1_grid"], axis=0) >= 0).all()
    assert (np.diff(found["f1_grid"], axis=1) <= 0).all()
    # two of the shifts are within 1 px, three within 2 px, and so on
    assert found["f1_grid"][:, 0].tolist() == pytest.approx([2 / 6, 3 / 6, 4 / 6, 1])
    assert found["mean_f1"] == pytest.approx(found["f1_grid"].mean())


@st.composite
def scenes(draw: st.DrawFn) -> tuple[list[Line], list[Line], list[Line]]:
    def lines(most: int) -> list[Line]:
        place = st.floats(0, 120, allow_subnormal=False)
        ends = draw(st.lists(st.tuples(place, place, place, place), max_size=most))
        return [np.array(each).reshape(2, 2) for each in ends]

    labels = lines(5)
    moved = [label + draw(st.floats(-4, 4)) for label in labels if draw(st.booleans())]
    return labels, moved + lines(3), lines(2)


@settings(max_examples=60, deadline=None)
@given(scenes())
def test_counts_add_up_and_values_keep_to_their_ranges(scene: tuple[list[Line], list[Line], list[Line]]) -> None:
    labels, predictions, ambiguous = scene
    result = score(labels, predictions, ambiguous)
    tp, fp, fn = counts(result)
    ignored = (result.outcomes.predictions == Outcome.IGNORED).sum()
    assert tp + fn == len(labels)
    assert tp + fp + ignored == len(predictions)
    assert tp == len(result.matches.row) == (result.outcomes.labels == Outcome.HIT).sum()
    assert (result.matches.value >= 0.5 - 1e-9).all()
    assert (result.matches.column < len(labels)).all()
    found = values(result)
    for name in ("f1", "precision", "recall", "mean_f1", "completeness", "correctness", "quality", "merge"):
        assert math.isnan(found[name]) or 0 <= found[name] <= 1 + 1e-12
    for name in ("offset_mean", "offset_median", "offset_p95", "translation_error"):
        assert math.isnan(found[name]) or 0 <= found[name] <= 3 + 1e-6
    assert math.isnan(found["angle_error"]) or 0 <= found["angle_error"] <= np.radians(15) + 1e-9
    assert math.isnan(found["fragmentation"]) or found["fragmentation"] >= 1


@pytest.mark.parametrize("far", [1e7, 3e38])
def test_segments_that_would_fill_the_memory_are_refused(line, far: float) -> None:
    endless = np.array([[0.0, 0.0], [far, 0.0]])
    with pytest.raises(TooLarge, match="predictions"):
        score([line(100)], [endless])
    with pytest.raises(TooLarge, match="labels"):
        score([endless], [line(100)])


def test_a_score_survives_the_way_between_processes(line) -> None:
    result = score([line(300)], [line(300)])
    again = pickle.loads(pickle.dumps(result))
    assert (again.tallies == result.tallies).all()
    assert (again.precision, again.recall) == (1.0, 1.0)
