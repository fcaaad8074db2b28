"""Which false positives are lines that people rejected, and why."""

from __future__ import annotations

import io

import numpy as np
import pytest
from numpy.typing import NDArray

from app.errors import InvalidFile, InvalidSegments
from app.evaluation.ground_truth import ground_truth
from app.evaluation.image_record import ImageRecord
from app.evaluation.rejected_lines import (
    NO_REASON,
    RejectedLines,
    reason_name,
    reason_strata,
    reason_tallies,
    reasons_of,
)
from app.evaluation.split_image import ScoredImage, SplitImageInfo
from app.evaluation.submission_scoring import score_image, score_totals
from app.verdicts import REASONS
from app.vision.segments import Segments


def rows(*heights: float) -> Segments:
    x = np.arange(10.0, 131.0)
    return Segments.from_list([np.stack([x, np.full_like(x, height)], axis=1) for height in heights])


REJECTED = RejectedLines(rows(20, 60, 100), np.array([REASONS.index(name) for name in ("car", "car", "shadow")]))


def tallies_of(rejected: RejectedLines | None, wrong: Segments) -> NDArray[np.float64]:
    return reason_tallies(rejected, reasons_of(rejected, wrong))


def test_each_candidate_is_counted_once_however_often_it_is_hit() -> None:
    wrong = rows(20, 20.5, 101, 150)
    assert [reason_name(place) for place in reasons_of(REJECTED, wrong)] == ["car", None, "shadow", None]
    tallies = tallies_of(REJECTED, wrong)
    assert tallies[REASONS.index("car")].tolist() == [1, 2]
    assert tallies[REASONS.index("shadow")].tolist() == [1, 1]
    assert tallies.sum(axis=0).tolist() == [2, 3]


def test_strata_name_what_there_was_to_fall_for() -> None:
    tallies = np.array([tallies_of(REJECTED, rows(20)), tallies_of(REJECTED, rows()), tallies_of(None, rows(20))])
    car, shadow = reason_strata(tallies, np.arange(3), 200, 0)
    interval = car.pop("share")
    assert car == {"name": "car", "tp": 0, "fp": 1, "fn": 0, "candidates": 4}
    # of the draws with candidates, those without the first image have 0, those with no other one have 1 of 2
    assert interval == {"value": 0.25, "low": 0.0, "high": 0.5}
    assert shadow == {
        "name": "shadow",
        "tp": 0,
        "fp": 0,
        "fn": 0,
        "candidates": 2,
        "share": {"value": 0.0, "low": 0.0, "high": 0.0},
    }
    assert reason_strata(np.zeros((3, 5, 2)), np.arange(3), 200, 0) == []


def test_nothing_is_said_of_the_interval_of_a_single_image() -> None:
    (car, _) = reason_strata(tallies_of(REJECTED, rows(20))[None], np.zeros(1, np.int64), 200, 0)
    assert car["share"] == {"value": 0.5, "low": None, "high": None}


def alone(value: float) -> dict[str, float | None]:
    return {"value": value, "low": None, "high": None}


def scored(rejected: RejectedLines | None) -> ImageRecord:
    predictions = rows(20, 60, 140)
    image = ScoredImage(SplitImageInfo("a", 200, 160), ground_truth(rows(60, 140)), predictions, rejected)
    return score_image(image)[0]


def test_a_label_that_is_found_is_no_false_positive_of_any_reason() -> None:
    record = scored(REJECTED)
    assert record.reasons.sum(axis=0).tolist() == [1, 3]
    assert [reason_name(place) for place in record.prediction_reasons] == ["car", None, None]


def test_where_short_lines_do_not_count_nobody_falls_for_one() -> None:
    short = Segments.from_list([*rows(20), rows(60)[0][:40]])
    rejected = RejectedLines(short, np.array([REASONS.index("curved")] * 2))
    predictions = Segments.from_list([rows(60)[0][:40], *rows(20, 140)])
    image = ScoredImage(SplitImageInfo("a", 200, 160), ground_truth(rows(140)), predictions, rejected)
    record, _ = score_image(image, min_length=50)
    assert record.reasons[REASONS.index("curved")].tolist() == [1, 1]
    assert [reason_name(place) for place in record.prediction_reasons] == [None, "curved", None]
    assert score_image(image)[0].reasons[REASONS.index("curved")].tolist() == [2, 2]


def test_reasons_change_no_other_number() -> None:
    info = [SplitImageInfo("a", 200, 160)]
    without, known = (score_totals(info, [scored(rejected)], draws=10) for rejected in (None, REJECTED))
    assert known["strata"].pop("reason") == [
        {"name": "car", "tp": 0, "fp": 1, "fn": 0, "candidates": 2, "share": alone(0.5)},
        {"name": "shadow", "tp": 0, "fp": 0, "fn": 0, "candidates": 1, "share": alone(0.0)},
    ]
    assert "reason" not in without["strata"]
    assert known == without


def test_records_keep_them_and_older_ones_have_none() -> None:
    record = scored(REJECTED)
    again = ImageRecord.from_npz(record.as_npz())
    assert again.reasons.tolist() == record.reasons.tolist()
    assert again.prediction_reasons.tolist() == record.prediction_reasons.tolist()
    with np.load(io.BytesIO(record.as_npz())) as file:
        arrays = {name: file[name] for name in file.files if name not in ("reasons", "prediction_reasons")}
    older = io.BytesIO()
    np.savez(older, **arrays)
    read = ImageRecord.from_npz(older.getvalue())
    assert not read.reasons.any()
    assert read.prediction_reasons.tolist() == [NO_REASON] * 3
    assert read.prediction_errors.tolist() == record.prediction_errors.tolist()


def test_rejected_lines_are_read_as_they_were_written() -> None:
    again = RejectedLines.from_npz(REJECTED.as_npz())
    assert again.reasons.tolist() == REJECTED.reasons.tolist()
    assert np.array_equal(again.segments.points, REJECTED.segments.points)
    assert np.array_equal(again.segments.offsets, REJECTED.segments.offsets)


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04", REJECTED.as_npz()[:-30], scored(None).as_npz()])
def test_anything_else_is_refused(data: bytes) -> None:
    with pytest.raises(InvalidFile):
        RejectedLines.from_npz(data)


@pytest.mark.parametrize("reasons", [[0], [0, 1, 5], [0, 1, -1]])
def test_every_line_has_a_reason_that_there_is(reasons: list[int]) -> None:
    with pytest.raises(InvalidSegments):
        RejectedLines(REJECTED.segments, np.array(reasons))
