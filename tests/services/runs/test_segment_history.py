"""Which segments have a history, and what is told of it."""

from __future__ import annotations

import numpy as np
import pytest
from sqlalchemy import update

from app.db.models import Image, Run, Segment
from app.errors import NoHistory, NotFound
from app.services.score_parts import score_parts
from app.services.segment_history import Found, detection_behind, tell
from app.vision.history import SegmentHistory
from app.vision.native.records import FINDING
from app.vision.scoring import INTERCEPT, WEIGHTS, measure_features


def behind(bench, segment_id: int) -> Found:
    with bench.database.read() as session:
        return detection_behind(session, segment_id)


def change(bench, table, **values) -> None:
    with bench.database.write() as session:
        session.execute(update(table).values(**values))


def test_the_detection_behind_a_candidate_is_its_run_s(bench) -> None:
    run_id = bench.detect(20, 40, min_length=33, operating_point="recall")
    image = bench.images[0]
    found = behind(bench, bench.at(image, 40))
    assert (found.image_id, found.image_name, found.run_id) == (image, "frame-0", run_id)
    assert (found.parameters["min_length"], found.parameters["operating_point"]) == (33, "recall")
    assert set(np.frombuffer(found.points, "<f4")[1::2]) == {40.0}


def test_a_candidate_that_a_later_run_replaced_keeps_its_own(bench) -> None:
    first = bench.detect(20)
    old = bench.at(bench.images[0], 20)
    second = bench.detect(20.25)
    assert behind(bench, old).run_id == first
    assert behind(bench, bench.at(bench.images[0], 20.25)).run_id == second


@pytest.mark.parametrize(("origin", "word"), [("manual", "drew"), ("import", "imported")])
def test_what_the_pipeline_didn_t_find_has_none(small_bench, origin: str, word: str) -> None:
    small_bench.detect(20)
    segment = small_bench.at(small_bench.images[0], 20)
    change(small_bench, Segment, origin=origin)
    with pytest.raises(NoHistory, match=word) as caught:
        behind(small_bench, segment)
    assert (caught.value.status, caught.value.code) == (404, "no-history")


def test_a_run_that_is_gone_takes_the_history_along(small_bench) -> None:
    small_bench.detect(20)
    segment = small_bench.at(small_bench.images[0], 20)
    change(small_bench, Segment, run_image_id=None)
    with pytest.raises(NoHistory, match="deleted for good") as caught:
        behind(small_bench, segment)
    assert caught.value.hint


def test_parameters_of_another_version_mean_that_it_was_another(small_bench) -> None:
    small_bench.detect(20)
    segment = small_bench.at(small_bench.images[0], 20)
    change(small_bench, Run, parameters={"min_length": 50, "bygone": 1}, code_version="0.0.7")
    with pytest.raises(NoHistory, match="another version") as caught:
        behind(small_bench, segment)
    assert "0.0.7" in (caught.value.expected or "")


def test_unknown_segments_and_deleted_images_are_not_found(small_bench) -> None:
    small_bench.detect(20)
    segment = small_bench.at(small_bench.images[0], 20)
    with pytest.raises(NotFound, match="no segment 999"):
        behind(small_bench, 999)
    change(small_bench, Image, deleted_at=small_bench.now)
    with pytest.raises(NotFound, match="deleted"):
        behind(small_bench, segment)


def test_a_history_is_told_in_plain_numbers(small_bench) -> None:
    small_bench.detect(20)
    found = behind(small_bench, small_bench.at(small_bench.images[0], 20))
    features = dict.fromkeys(WEIGHTS, 0.5)
    history = SegmentHistory(
        pieces=np.array([[[0, 20], [30, 20]], [[33, 24], [100, 24]]], float),
        gaps=np.array([[[30, 20], [33, 24]]], float),
        costs=np.array([2.5]),
        flipped=np.array([True]),
        rounds=("flipping",),
        extended=(4.0, 0.0),
        trimmed=(0.0, 1.5),
        features=features,
        score=0.25,
    )
    told = tell(found, history, dict.fromkeys(WEIGHTS, 0.0))
    assert [(piece.start, piece.end, piece.length) for piece in told.pieces] == [
        ((0, 20), (30, 20), 30),
        ((33, 24), (100, 24), 67),
    ]
    (join,) = told.joins
    assert (join.start, join.end, join.gap, join.cost) == ((30, 20), (33, 24), 5, 2.5)
    assert (join.flipped, join.round) == (True, "flipping")
    assert (told.extended, told.trimmed, told.score, told.intercept) == ((4, 0), (0, 1.5), 0.25, INTERCEPT)
    assert {part.name: part.value for part in told.score_parts} == features
    with pytest.raises(NoHistory, match="another version"):
        tell(found, None, {})


def test_parts_of_a_score_are_told_as_they_were_measured() -> None:
    finding = np.zeros(1, FINDING)
    for name, value in (("chord", 120), ("samples", 100), ("close", 80), ("mean_norm", 240)):
        finding[name] = value
    for name, value in (("rms", 0.25), ("longest_gap", 6), ("contrast", -44)):
        finding[name] = value
    features = {name: float(values[0]) for name, values in measure_features(finding).items()}
    parts = {part.name: part for part in score_parts(features, dict.fromkeys(features, 0.0))}
    assert {name: (pytest.approx(part.measured), part.unit) for name, part in parts.items()} == {
        "length": (120, "px"),
        "closeness": (0.8, "share"),
        "edge strength": (240, "grey levels"),
        "roughness": (0.25, "px"),
        "longest gap": (6, "px"),
        "contrast": (44, "grey levels"),
    }
    assert {name: part.weight for name, part in parts.items()} == WEIGHTS
