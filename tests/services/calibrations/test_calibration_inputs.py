"""What a calibration reads of a camera's images: which lines, how many, and what it says of those it left out."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.calibration.work_order import CalibrationInputs
from app.db.models import Image, Review
from app.services import calibration_inputs as inputs_module
from app.services.calibration_inputs import calibration_inputs, fair_share, spread
from app.services.calibrations import cancel_calibration
from app.services.datasets import get_dataset
from app.services.images import delete_images


def read(bench: Any, source: str = "labels") -> CalibrationInputs:
    calibration = bench.start(source)
    claim = bench.claim()
    with bench.database.read() as session:
        found = calibration_inputs(session, claim)
    with bench.database.write() as session:
        cancel_calibration(session, calibration, bench.now)
    return found


def test_kept_lines_of_all_images_count_whatever_their_review(bench) -> None:
    one = bench.image("b/one", ["keep", "reject", "keep", "ambiguous", "undecided"])
    two = bench.image("a/two", ["keep", "undecided"])
    bench.image("c/three", ["undecided"] * 4)
    gone = bench.image("a/gone", ["keep"] * 5)
    with bench.database.write() as session:
        session.get_one(Review, one).status = "done"
        delete_images(session, get_dataset(session, "bench"), [gone], bench.now, grace=timedelta(days=7))
    found = read(bench)
    assert [image.name for image in found.images] == ["a/two", "b/one"]
    assert found.images[1].segment_ids.tolist() == [bench.segments(one)[place] for place in (0, 2)]
    assert found.images[0].probability is None
    assert len(found.images[1].segments[0]) == 40
    assert found.parameters["images"] == [two, one]
    expected = {"segments": 3, "images_available": 2, "segments_available": 3}
    assert {name: found.parameters[name] for name in expected} == expected
    assert [image.name for image in found.unlabelled] == ["c/three"]


def test_candidates_are_as_likely_as_the_detection_says(bench) -> None:
    image = bench.image("a", ["keep", "reject", "undecided", "ambiguous"], straightness=0.7, score=0.1)
    bench.image("b", ["undecided"], score=0.2)
    bench.image("c", ["undecided"])
    found = read(bench, "candidates")
    probabilities = [None if each.probability is None else each.probability.tolist() for each in found.images]
    assert probabilities == [pytest.approx([1.0, 0.7, 0.7]), pytest.approx([0.2]), [0.5]]
    assert bench.segments(image)[1] not in found.images[0].segment_ids


def test_of_too_many_lines_the_longest_of_images_all_over_are_read(
    small_bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number in range(5):
        small_bench.image(f"{number}", ["keep"] * (2 if number == 0 else 6))
    monkeypatch.setattr(inputs_module, "MOST_IMAGES", 3)
    monkeypatch.setattr(inputs_module, "MOST_SEGMENTS", 10)
    found = read(small_bench)
    assert [image.name for image in found.images] == ["0", "2", "4"]
    assert [len(image.segments) for image in found.images] == [2, 4, 4]
    with small_bench.database.read() as session:
        image = session.query(Image).filter_by(name="2").one()
    lengths = {
        segment: float(np.hypot(*(points[-1] - points[0])))
        for segment, points in zip(found.images[1].segment_ids.tolist(), found.images[1].segments, strict=True)
    }
    assert len(small_bench.segments(image.id)) == 6
    assert len(lengths) == 4
    assert found.parameters["images_available"] == 5
    assert found.parameters["segments_available"] == 26
    assert found.parameters["segments"] == 10


def test_points_are_bounded_too(small_bench, monkeypatch: pytest.MonkeyPatch) -> None:
    small_bench.image("a", ["keep"] * 6)
    monkeypatch.setattr(inputs_module, "MOST_POINTS", 130)
    assert len(read(small_bench).images[0].segments) == 3  # of 40 points each


@given(st.lists(st.integers(1, 5000), min_size=1, max_size=60), st.integers(60, 40_000))
def test_a_fair_share_fills_the_room_and_no_more(numbers: list[int], most: int) -> None:
    share = fair_share(numbers, most)
    taken = sum(min(number, share) for number in numbers)
    assert taken <= most
    if share < max(numbers):
        assert sum(min(number, share + 1) for number in numbers) > most


@given(st.integers(0, 1000), st.integers(2, 200))
def test_what_is_spread_reaches_both_ends(count: int, most: int) -> None:
    chosen = spread(count, most)
    assert len(chosen) == len(set(chosen)) == min(count, most)
    assert chosen == sorted(chosen)
    if count:
        assert (chosen[0], chosen[-1]) == (0, count - 1)
