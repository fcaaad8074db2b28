from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.evaluation.outcome import Outcome, Outcomes
from app.evaluation.strata import COUNT, STRATA, strata_of, stratum_metrics, stratum_tallies
from app.vision.segments import Segments

SIZE = (1001, 1001)


def named(segments: Segments, kind: str, size: tuple[int, int] = SIZE) -> list[str]:
    return [STRATA[kind][place] for place in strata_of(segments, size)[kind]]


@pytest.mark.parametrize(
    ("length", "name"),
    [
        (99, "under 100 px"),
        (100, "100-200 px"),
        (199, "100-200 px"),
        (200, "200-400 px"),
        (399, "200-400 px"),
        (400, "400 px and more"),
        (900, "400 px and more"),
    ],
)
def test_a_length_is_in_the_stratum_that_begins_with_it(line, length: int, name: str) -> None:
    assert named(Segments.from_list([line(length)]), "length") == [name]


def test_the_length_is_along_the_line() -> None:
    there_and_back = np.array([[0.0, 0.0], [90.0, 0.0], [0.0, 0.0]])
    assert named(Segments.from_list([there_and_back]), "length") == ["100-200 px"]


@pytest.mark.parametrize(
    ("angle", "name"),
    [
        *((angle, "horizontal") for angle in (0, 22, -22, 158.5, 180)),
        *((angle, "diagonal") for angle in (23, 45, -45, 67, 135)),
        *((angle, "vertical") for angle in (68, 90, -90, 112)),
    ],
)
def test_the_orientation_is_that_of_the_chord_without_direction(line, angle: float, name: str) -> None:
    assert named(Segments.from_list([line(200, angle)]), "orientation") == [name]
    assert named(Segments.from_list([line(200, angle)[::-1]]), "orientation") == [name]


@pytest.mark.parametrize(("share", "name"), [(0.1, "inner third"), (0.5, "middle third"), (0.8, "outer third")])
def test_the_distance_is_measured_in_half_diagonals(line, share: float, name: str) -> None:
    for width, height in (SIZE, (3001, 401)):
        center = np.array([(width - 1) / 2, (height - 1) / 2])
        short = line(2, 30, tuple(center * (1 - share)))
        assert named(Segments.from_list([short]), "distance", (width, height)) == [name]


def test_hits_and_misses_stand_where_the_label_is_and_false_alarms_where_the_prediction_is(line) -> None:
    labels = Segments.from_list([line(150), line(300), line(500), line(60)])
    predictions = Segments.from_list([line(80), line(250), line(90)])
    outcomes = Outcomes(
        np.array([Outcome.HIT, Outcome.FALSE_ALARM, Outcome.IGNORED], np.int8),
        np.array([Outcome.HIT, Outcome.MISS, Outcome.MISS, Outcome.IGNORED], np.int8),
    )
    tallies = stratum_tallies(labels, predictions, outcomes, SIZE)
    assert tallies[: len(STRATA["length"])].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 1], [0, 0, 1]]
    found = stratum_metrics(tallies[: len(STRATA["length"])])
    assert found["f1"].tolist() == [1, 1, 0, 0]
    assert found["recall"].tolist() == [1, 1, 0, 0]


outcome_lists = st.lists(st.sampled_from([Outcome.HIT, Outcome.FALSE_ALARM, Outcome.IGNORED]), max_size=6)


@given(predicted=outcome_lists, labelled=outcome_lists, seed=st.integers(0, 99))
def test_the_strata_of_a_kind_add_up_to_the_whole(predicted: list[Outcome], labelled: list[Outcome], seed: int) -> None:
    random = np.random.default_rng(seed)
    predictions = Segments.from_list([random.uniform(0, 1000, (5, 2)) for _ in predicted])
    labels = Segments.from_list([random.uniform(0, 1000, (5, 2)) for _ in labelled])
    of_labels = [Outcome.MISS if outcome is Outcome.FALSE_ALARM else outcome for outcome in labelled]
    outcomes = Outcomes(np.array(predicted, np.int8), np.array(of_labels, np.int8))
    tallies = stratum_tallies(labels, predictions, outcomes, SIZE)
    assert tallies.shape == (COUNT, 3)
    whole = [of_labels.count(Outcome.HIT), predicted.count(Outcome.FALSE_ALARM), of_labels.count(Outcome.MISS)]
    first = 0
    for names in STRATA.values():
        assert tallies[first : first + len(names)].sum(axis=0).tolist() == whole
        first += len(names)


def test_without_a_size_nothing_is_counted_by_distance(line) -> None:
    labels = Segments.from_list([line(150)])
    outcomes = Outcomes(np.zeros(0, np.int8), np.array([Outcome.MISS], np.int8))
    tallies = stratum_tallies(labels, Segments.empty(), outcomes, None)
    assert tallies.shape == (COUNT, 3)
    assert tallies[-len(STRATA["distance"]) :].sum() == 0
    assert tallies.sum() == len(STRATA) - 1
