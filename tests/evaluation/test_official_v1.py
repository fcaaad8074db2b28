from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.evaluation import Outcome, ground_truth
from app.evaluation.official_v1 import ImageScore, score_image, total
from app.vision.segments import Segments

Line = NDArray[np.floating]


def score(labels: Sequence[Line], predictions: Sequence[Line], ambiguous: Sequence[Line] = ()) -> ImageScore:
    truth = ground_truth(Segments.from_list(labels), Segments.from_list(ambiguous))
    return score_image(truth, Segments.from_list(predictions))


# An independent recomputation: the definition, word by word, one pair of segments at a time.


def literal_box(points: Line) -> tuple[float, float, float, float]:
    xs, ys = zip(*points.tolist(), strict=True)
    sides = []
    for values in (xs, ys):
        low, high = min(values), max(values)
        short = 10 - (high - low)
        if short > 0:
            low, high = low - short / 2, high + short / 2
        sides.append((low, high))
    (x0, x1), (y0, y1) = sides
    return x0, y0, x1, y1


def literal_iou(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    ax0, ay0, ax1, ay1 = a
    bx0, by0, bx1, by1 = b
    width = max(0.0, min(ax1, bx1) - max(ax0, bx0))
    height = max(0.0, min(ay1, by1) - max(ay0, by0))
    common = width * height
    return common / ((ax1 - ax0) * (ay1 - ay0) + (bx1 - bx0) * (by1 - by0) - common)


def literal(images: Sequence[tuple[Sequence[Line], Sequence[Line]]]) -> tuple[float, float, float]:
    precisions, recalls = [], []
    for labels, predictions in images:
        boxes = [literal_box(label) for label in labels]
        hits = 0
        for prediction in predictions:
            box = literal_box(prediction)
            if labels and max(literal_iou(box, other) for other in boxes) >= 0.5:
                hits += 1
        precisions.append(hits / len(predictions) if predictions else 0.0)
        if labels:
            recalls.append(hits / len(labels))
        elif not predictions:
            recalls.append(0.0)
    precision = math.fsum(precisions) / len(precisions)
    recall = math.fsum(recalls) / len(recalls) if recalls else 0.0
    return precision, recall, 2 * precision * recall / (precision + recall) if precision + recall else 0.0


def assert_equals_the_literal_computation(images: Sequence[tuple[Sequence[Line], Sequence[Line]]]) -> None:
    totals = total([score(labels, predictions) for labels, predictions in images])
    assert (totals.precision, totals.recall, totals.f1) == pytest.approx(literal(images), rel=0, abs=1e-12)


coordinate = st.integers(0, 240).map(lambda value: value / 4)
polyline = st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=4).map(np.array)
image = st.tuples(st.lists(polyline, max_size=5), st.lists(polyline, max_size=7))


@settings(max_examples=150, deadline=None)
@example([([], [])])
@example([([], [np.zeros((2, 2))]), ([np.zeros((2, 2))], [])])
@given(st.lists(image, min_size=1, max_size=4))
def test_equals_the_literal_computation_on_random_images(images: list[tuple[list[Line], list[Line]]]) -> None:
    assert_equals_the_literal_computation(images)


def test_equals_the_literal_computation_on_york(york_lines: dict[str, list[Line]]) -> None:
    random = np.random.default_rng(3)
    images = []
    for labels in york_lines.values():
        lines = labels[:60]  # plain Python takes its time
        moved = [line + random.normal(0, 4, 2) for line in lines if random.random() < 0.8]
        cut = [line[: max(1, int(len(line) * random.uniform(0.3, 0.9)))] for line in lines]
        images.append((lines, [*moved, *cut]))
    assert_equals_the_literal_computation(images)
    precision, recall, _ = literal(images)
    assert 0.3 < precision < 0.9
    assert recall > precision


def test_a_perfect_result_has_precision_recall_and_f1_of_1(line) -> None:
    lines = [line(200, 0), line(200, 40), line(150, 90, (100, 300))]
    result = score(lines, lines)
    totals = total([result])
    assert (totals.precision, totals.recall, totals.f1) == (1, 1, 1)
    assert result.best_label.tolist() == [0, 1, 2]
    assert result.best_iou.tolist() == [1, 1, 1]


# The known consequences.


def test_five_copies_of_one_correct_line_give_recall_5(line) -> None:
    totals = total([score([line(300, 20)], [line(300, 20)] * 5)])
    assert (totals.precision, totals.recall) == (1.0, 5.0)
    assert totals.f1 == pytest.approx(5 / 3)


def test_a_perpendicular_cross_through_the_line_has_iou_1(line) -> None:
    result = score([line(300, 45)], [line(300, 135)])
    assert result.best_iou[0] == pytest.approx(1.0, abs=1e-6)
    assert result.true_positives == 1


def test_an_arc_104_px_off_has_iou_1() -> None:
    # a quarter of a circle and its chord have one box; the middle of the arc is (1 - sqrt(1/2)) of the radius away
    radius = 104 / (1 - math.sqrt(0.5))
    angle = np.linspace(0, np.pi / 2, 600)
    arc = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    chord = np.linspace(arc[0], arc[-1], 600)
    sagitta = np.abs(arc.sum(axis=1) / math.sqrt(2) - radius * math.sqrt(0.5)).max()
    assert sagitta == pytest.approx(104, abs=0.1)
    assert score([chord], [arc]).best_iou[0] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(("angle", "accepted"), [(0, 10 / 3), (90, 10 / 3), (45, 73.4)])
def test_the_shift_of_a_400_px_line_that_is_accepted_depends_on_its_direction(line, angle, accepted) -> None:
    label = line(400, angle)
    normal = np.array([-np.sin(np.radians(angle)), np.cos(np.radians(angle))])

    def hits(shift: float) -> int:
        return score([label], [label + shift * normal]).true_positives

    assert hits(accepted - 0.1) == 1
    assert hits(accepted + 0.1) == 0


@pytest.mark.parametrize(("angle", "precision", "recall"), [(0, 1, 2), (45, 0, 0)])
def test_a_line_in_two_halves_that_share_the_cut_point(line, angle, precision, recall) -> None:
    whole = line(400, angle)
    result = score([whole], [whole[:201], whole[200:]])
    assert (result.precision, result.recall) == (precision, recall)


def test_predictions_where_there_are_no_labels_have_precision_0_and_no_recall(line) -> None:
    empty = score([], [line(100), line(100)])
    assert (empty.precision, empty.recall) == (0.0, None)
    assert empty.best_label.tolist() == [-1, -1]
    perfect = score([line(100)], [line(100)])
    totals = total([empty, perfect])
    assert (totals.precision, totals.recall, totals.without_recall) == (0.5, 1.0, 1)
    assert total([empty]).recall == 0.0


def test_neither_labels_nor_predictions_count_as_0(line) -> None:
    nothing = score([], [])
    assert (nothing.precision, nothing.recall) == (0.0, 0.0)
    totals = total([nothing, score([line(100)], [line(100)])])
    assert (totals.precision, totals.recall, totals.f1) == (0.5, 0.5, 0.5)


def test_f1_is_0_where_precision_and_recall_are(line) -> None:
    totals = total([score([line(100)], [line(100, 0, (900.0, 900.0))])])
    assert (totals.precision, totals.recall, totals.f1) == (0, 0, 0)


def test_no_predictions_have_precision_0(line) -> None:
    missed = score([line(100)], [])
    assert (missed.precision, missed.recall, missed.labels) == (0.0, 0.0, 1)
    assert missed.outcomes.labels.tolist() == [Outcome.MISS]


def test_no_images_are_refused() -> None:
    with pytest.raises(InvalidInput, match="no images"):
        total([])


def test_iou_of_exactly_a_half_is_a_hit() -> None:
    label = np.array([[0.0, 0], [20, 10]])
    assert score([label], [np.array([[0.0, 0], [10, 10]])]).best_iou.tolist() == [0.5]
    assert score([label], [np.array([[0.0, 0], [10, 10]])]).true_positives == 1


def test_the_first_of_equally_good_labels_is_named(line) -> None:
    assert score([line(50, 0, (9.0, 9.0)), line(80), line(80)], [line(80)]).best_label.tolist() == [1]


# Labels that don't count.


def test_a_prediction_on_an_ambiguous_label_alone_is_left_out(line) -> None:
    real, unsure, wrong = line(200), line(200, 90, (100.0, 100.0)), line(200, 0, (900.0, 900.0))
    result = score([real], [real, unsure, wrong], [unsure])
    assert (result.precision, result.recall) == (0.5, 1.0)
    assert (result.predictions, result.labels) == (2, 1)
    assert result.outcomes.predictions.tolist() == [Outcome.HIT, Outcome.IGNORED, Outcome.FALSE_ALARM]
    assert result.outcomes.labels.tolist() == [Outcome.HIT, Outcome.IGNORED]
    assert result.best_label.tolist() == [0, -1, -1]


def test_a_real_label_goes_before_an_ambiguous_one_that_fits_better(line) -> None:
    real = line(200)
    result = score([real], [real[:150]], [real[:150]])
    assert result.outcomes.predictions.tolist() == [Outcome.HIT]
    assert result.best_iou.tolist() == pytest.approx([149 / 200])


def test_an_image_with_only_ambiguous_labels_found_counts_as_empty(line) -> None:
    result = score([], [line(100)], [line(100)])
    assert (result.precision, result.recall, result.predictions) == (0.0, 0.0, 0)


def test_short_labels_are_ignored_like_ambiguous_ones(line) -> None:
    labels = Segments.from_list([line(200), line(60, 90)])
    truth = ground_truth(labels, min_length=100)
    assert truth.ignored.tolist() == [False, True]
    result = score_image(truth, labels)
    assert (result.precision, result.recall, result.predictions) == (1.0, 1.0, 1)
