from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.evaluation import ground_truth
from app.evaluation.clearlines_v2 import score_image
from app.evaluation.error_types import FALSE_NEGATIVES, FALSE_POSITIVES, ErrorType, ErrorTypes, error_types
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.outcome import Outcome
from app.vision.segments import Segments

CENTER = np.array([500.0, 500.0])


def types_of(truth: GroundTruth, predictions: Segments) -> ErrorTypes:
    return error_types(truth, predictions, score_image(truth, predictions))


def names(labels, predictions, ambiguous=()) -> tuple[list[str], list[str]]:
    truth = ground_truth(Segments.from_list(labels), Segments.from_list(ambiguous))
    found = types_of(truth, Segments.from_list(predictions))
    return _names(found.predictions), _names(found.labels)


def _names(kinds: np.ndarray) -> list[str]:
    return [ErrorType(kind).name.lower() for kind in kinds]


def turned(points: np.ndarray, degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return (points - CENTER) @ np.array([[c, s], [-s, c]]) + CENTER


def moved(points: np.ndarray, x: float, y: float) -> np.ndarray:
    return points + np.array([x, y])


ORIENTATIONS = pytest.mark.parametrize("angle", [0.0, 30.0, 45.0, 90.0, 137.0])


@ORIENTATIONS
def test_each_way_to_be_wrong_is_told_in_every_direction(line, angle: float) -> None:
    label = line(400)
    cases = {
        "fragment": [label[:150], label[100:250], moved(label[:150], 0, 2)],
        "over_extended": [line(1000), moved(line(1000), 350, 0)],
        "offset": [moved(label, x, y) for x, y in ((0, 8), (0, -11.5), (30, 4))] + [moved(label[:150], 0, 8)],
        "wrong_angle": [
            turned(label, 1.5),
            turned(label, 3),
            turned(label, -5),
            turned(line(40), 20),
            turned(line(10), 90),
        ],
        "background": [moved(label, 0, 13), turned(label, 90), turned(label, 45), moved(line(60), 0, 200)],
    }
    for kind, wrong in cases.items():
        for prediction in wrong:
            of_predictions, of_labels = names([turned(label, angle)], [turned(prediction, angle)])
            assert of_predictions == [kind]
            assert of_labels == ["missed"]


@ORIENTATIONS
def test_copies_of_a_found_label_are_duplicates(line, angle: float) -> None:
    label = line(400, angle)
    of_predictions, of_labels = names([label], [label, label, label[::-1]])
    assert sorted(of_predictions) == ["duplicate", "duplicate", "none"]
    assert of_labels == ["none"]


def test_a_piece_beside_the_whole_is_a_fragment_and_the_label_is_found(line) -> None:
    label = line(400)
    assert names([label], [label, label[:150]]) == (["none", "fragment"], ["none"])


def test_a_label_in_pieces_is_fragmented_and_one_with_too_few_is_missed(line) -> None:
    label = line(400)
    pieces = [label[:101], label[120:221], label[240:341]]
    assert names([label], pieces) == (["fragment"] * 3, ["fragmented"])
    assert names([label], pieces[:1]) == (["fragment"], ["missed"])


def test_copies_of_one_piece_do_not_make_a_label_fragmented(line) -> None:
    label = line(400)
    assert names([label], [label[:150]] * 3) == (["fragment"] * 3, ["missed"])


def test_one_line_over_several_labels_is_over_extended_and_they_are_missed(line) -> None:
    whole = line(900)
    labels = [whole[50:200], whole[300:450], whole[600:750]]
    assert names(labels, [whole]) == (["over_extended"], ["missed"] * 3)


def test_the_label_with_the_most_in_common_is_the_one_that_is_meant(line) -> None:
    """It crosses over the end of a long label, of which it is a piece, onto a short one that it covers."""
    whole = line(900)
    assert names([whole[:600], whole[600:640]], [whole[450:660]])[0] == ["fragment"]


@ORIENTATIONS
def test_a_shift_along_the_label_is_offset_too(line, angle: float) -> None:
    shifted = moved(turned(line(400), 0.2), 160, 0)
    assert names([line(400, angle)], [turned(shifted, angle)])[0] == ["offset"]


def test_a_shift_with_a_slight_turn_is_offset_and_a_turn_with_a_slight_shift_is_an_angle(line) -> None:
    label = line(300)
    assert names([label], [moved(turned(label, 0.5), 0, 8)])[0] == ["offset"]
    assert names([label], [moved(turned(label, 4.0), 0, 1)])[0] == ["wrong_angle"]


def test_the_nearer_of_two_labels_is_the_one_that_is_meant(line) -> None:
    level, slanted = line(300), moved(turned(line(300), 5), 0, 22)
    prediction = moved(level, 0, 6)
    assert names([level, slanted], [prediction])[0] == ["offset"]
    assert names([slanted, level], [prediction])[0] == ["offset"]


def test_what_is_ignored_has_no_type_but_is_something_to_lie_on(line) -> None:
    label, unsure = line(400), line(400, 0, (500.0, 800.0))
    of_predictions, of_labels = names([label], [unsure, unsure[:150], label], [unsure])
    assert of_predictions == ["none", "fragment", "none"]
    assert of_labels == ["none", "none"]


def test_a_label_whose_only_match_went_to_its_twin_is_missed_not_fragmented(line) -> None:
    label = line(400)
    assert sorted(names([label, label], [label])[1]) == ["missed", "none"]


def test_points_without_length_are_background(line) -> None:
    assert names([line(400)], [np.array([[100.0, 100.0]])])[0] == ["background"]
    assert names([], [line(100)]) == (["background"], [])
    assert names([line(100)], []) == ([], ["missed"])


def scene(seed: int) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Labels anywhere, and predictions that are off by a little of everything."""
    random = np.random.default_rng(seed)
    labels, predictions = [], []
    for _ in range(12):
        length, angle, center = random.uniform(60, 300), random.uniform(0, np.pi), random.uniform(200, 800, 2)
        along = np.linspace(-length / 2, length / 2, round(length) + 1)[:, None]
        label = center + along * [np.cos(angle), np.sin(angle)]
        labels.append(label)
        first = random.integers(0, round(length / 2))
        tilt = angle + random.normal(0, 0.05)
        moved_center = center + random.normal(0, 4, 2)
        piece = label[: round(length / random.uniform(2.5, 5))]
        predictions += [label[first:], moved_center + along * [np.cos(tilt), np.sin(tilt)], label, piece]
    return labels, predictions


@pytest.mark.parametrize("seed", range(8))
def test_turning_mirroring_and_reversing_everything_changes_no_type(seed: int) -> None:
    labels, predictions = scene(seed)
    plain = names(labels, predictions)
    assert {"none", "duplicate", "fragment"} < set(plain[0])
    quarter = np.array([[0.0, 1.0], [-1.0, 0.0]])
    mirror = np.array([[-1.0, 0.0], [0.0, 1.0]])
    for change in (
        lambda points: turned(points, 33),
        lambda points: (points - CENTER) @ quarter + CENTER,
        lambda points: (points - CENTER) @ mirror + CENTER,
        lambda points: points[::-1],
        lambda points: points + 40,
    ):
        assert names([change(line) for line in labels], [change(line) for line in predictions]) == plain


coordinates = st.floats(0, 300, width=32)
segments = st.lists(st.lists(st.tuples(coordinates, coordinates), min_size=1, max_size=4), max_size=5)


@settings(max_examples=60)
@given(labels=segments, predictions=segments, ignored=st.integers(0, 5))
def test_every_error_has_one_type_and_nothing_else_has(labels, predictions, ignored: int) -> None:
    mask = np.arange(len(labels)) < ignored
    truth, found = GroundTruth(Segments.from_list(labels), mask), Segments.from_list(predictions)
    score = score_image(truth, found)
    types = error_types(truth, found, score)
    for kinds, outcomes, wrong, allowed in (
        (types.predictions, score.outcomes.predictions, Outcome.FALSE_ALARM, FALSE_POSITIVES),
        (types.labels, score.outcomes.labels, Outcome.MISS, FALSE_NEGATIVES),
    ):
        assert [kind in allowed for kind in kinds] == (outcomes == wrong).tolist()
        assert (kinds[outcomes != wrong] == ErrorType.NONE).all()
    assert types.counts().sum() == score.outcomes.counted(Outcome.FALSE_ALARM) + score.outcomes.counted(Outcome.MISS)
