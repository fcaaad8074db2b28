"""A new run never orphans a decision."""

from __future__ import annotations

from datetime import timedelta

import numpy as np
import pytest
from sqlalchemy import select

from app.db.models import Decision, Image, Review, RunImage, Segment
from app.services.carrying import match_to_current
from app.services.detections import FoundCandidates, store_detection
from app.services.labelling import history
from app.services.reviews import set_review
from app.vision.segments import Segments


def test_the_first_run_stores_every_candidate(bench) -> None:
    run_id = bench.detect(20, 40, 60)
    summary = bench.summary(run_id)
    assert summary.candidates == 6
    assert summary.changes.retired == summary.changes.carried == 0
    with bench.database.read() as session:
        image = session.get_one(Image, bench.images[0])
        work = session.get_one(RunImage, image.current_run_image_id)
    assert (image.revision, image.n_candidates, image.n_keep) == (1, 3, 0)
    assert (work.status, work.milliseconds, work.attempts, work.error) == ("done", 12.0, 1, None)


def test_verdicts_follow_to_what_matches(bench) -> None:
    bench.detect(20, 40, 60, 80, 100)
    image = bench.images[0]
    old = {height: bench.at(image, height) for height in (20, 40, 60, 80, 100)}
    bench.decide(image, {old[20]: "keep", old[40]: "reject", old[60]: "ambiguous", old[80]: "keep"})
    # found again a little off: 20, 40, 60; new: 120; not found again: 80 (kept) and 100 (undecided)
    run_id = bench.detect(21, 41.5, 60.5, 120)
    assert bench.by_height(image) == {21: "keep", 41.5: "reject", 60.5: "ambiguous", 120: "undecided", 80: "keep"}
    with bench.database.read() as session:
        work = session.scalars(select(RunImage).where(RunImage.run_id == run_id, RunImage.image_id == image)).one()
        stored = session.get_one(Image, image)
        replaced = {row.id: row.replaced_by_id for row in session.scalars(select(Segment)) if row.retired_at}
        carried = [row for row in history(session, image) if row.kind == "carry"]
    assert work.changes == {
        "candidates": 4,
        "carried": 3,
        "kept_unmatched": 1,
        "already_there": 0,
        "retired": 4,
        "reopened": False,
    }
    assert (stored.n_candidates, stored.n_keep, stored.n_reject, stored.n_ambiguous) == (5, 2, 1, 1)
    new = {height: bench.at(image, height) for height in (21, 41.5, 60.5)}
    assert {key: replaced[old[key]] for key in (20, 40, 60, 100)} == {
        20: new[21],
        40: new[41.5],
        60: new[60.5],
        100: None,
    }
    assert [(row.segment_id, row.verdict, row.previous, row.person) for row in carried] == [
        (new[21], "keep", "undecided", "owner"),
        (new[41.5], "reject", "undecided", "owner"),
        (new[60.5], "ambiguous", "undecided", "owner"),
    ]


def test_a_rejected_line_that_is_not_found_again_goes(small_bench) -> None:
    bench = small_bench
    bench.detect(20, 40)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20): "reject"})
    bench.detect(40)
    assert bench.by_height(image) == {40: "undecided"}


def test_decisions_survive_any_number_of_runs(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20): "keep", bench.at(image, 40): "ambiguous"})
    for shift in (1.0, 2.0, 3.0):
        run_id = bench.detect(20 + shift, 40 + shift)
        assert bench.by_height(image) == {20 + shift: "keep", 40 + shift: "ambiguous"}
        assert bench.summary(run_id).changes.carried == 2


def test_a_kept_line_that_was_missed_once_is_matched_when_found_again(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20): "keep"})
    bench.detect(100)
    assert bench.by_height(image) == {20: "keep", 100: "undecided"}
    bench.detect(20.5, 100)
    assert bench.by_height(image) == {20.5: "keep", 100: "undecided"}


def test_matching_is_one_to_one(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20): "keep"})
    run_id = bench.detect(19.5, 21)
    assert sorted(bench.by_height(image).values()) == ["keep", "undecided"]
    assert bench.summary(run_id).changes.carried == 1


def test_imported_and_drawn_segments_stay_and_are_not_stored_twice(bench) -> None:
    image = bench.images[0]
    x = np.arange(10, 131, dtype="<f4")
    with bench.database.write() as session:
        for height, origin in ((20.0, "import"), (40.0, "manual")):
            points = np.stack([x, np.full_like(x, height)], axis=1).astype("<f4")
            session.add(
                Segment(
                    image_id=image,
                    ordinal=0,
                    n_points=len(x),
                    points=points.tobytes(),
                    x0=10,
                    y0=height,
                    x1=130,
                    y1=height,
                    length=120,
                    origin=origin,
                )
            )
    run_id = bench.detect(20.5, 40.5, 60)
    assert bench.by_height(image) == {60: "undecided", 40: "undecided", 20: "undecided"}
    changes = bench.summary(run_id).changes
    assert (changes.already_there, changes.retired) == (2, 0)
    run_id = bench.detect(60)
    assert sorted(bench.by_height(image)) == [20, 40, 60]
    assert bench.summary(run_id).changes.retired == 1 + 3  # 60 here; 20.5, 40.5 and 60 on the other image


def test_new_candidates_open_a_done_image(bench) -> None:
    bench.detect(20)
    for image in bench.images:
        bench.decide(image, {bench.at(image, 20): "keep"})
        with bench.database.write() as session:
            set_review(session, image, "done", now=bench.now)
    run_id = bench.start()
    first, second = bench.claim()
    line = np.stack([np.arange(10, 131), np.full(121, 20.0)], axis=1)
    bench.store(first, Segments.from_list([line], [0.5]))
    bench.store(second, Segments.from_list([line, line + np.array([0, 30])], [0.5, 0.5]))
    with bench.database.read() as session:
        status = {image: session.get_one(Review, image).status for image in bench.images}
    assert status == {first.image_id: "done", second.image_id: "open"}
    assert bench.summary(run_id).changes.reopened == 1


def test_a_result_that_comes_twice_changes_nothing(bench) -> None:
    bench.start()
    first, _ = bench.claim()
    line = Segments.from_list([np.stack([np.arange(10, 131), np.full(121, 20.0)], axis=1)], [0.5])
    assert bench.store(first, line)
    before = bench.segments(first.image_id)
    assert not bench.store(first, line)
    assert bench.segments(first.image_id) == before
    with bench.database.read() as session:
        assert session.get_one(Image, first.image_id).revision == 1


def test_a_matching_made_before_a_change_is_made_again(small_bench) -> None:
    bench = small_bench
    bench.detect(20, 40)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20): "keep"})
    line = Segments.from_list([np.stack([np.arange(10, 131), np.full(121, 20.5)], axis=1)], [0.5])
    bench.start()
    claim = next(claim for claim in bench.claim() if claim.image_id == image)
    with bench.database.read() as session:
        early = match_to_current(session, session.get_one(Image, image), Segments.empty())
    assert early.successors == {}
    with bench.database.write() as session:
        session.get_one(Image, image).revision += 1
    with bench.database.write() as session:
        store_detection(session, claim, FoundCandidates(line, None, 1.0), bench.now, matching=early)
    assert bench.by_height(image) == {20.5: "keep"}


@pytest.mark.parametrize("verdict", ["keep", "reject", "ambiguous"])
def test_a_decision_for_a_replaced_candidate_goes_to_its_successor(bench, verdict) -> None:
    bench.detect(20)
    image = bench.images[0]
    old = bench.at(image, 20)
    bench.detect(21)
    bench.detect(22)
    stored = bench.decide(image, {old: verdict})
    assert bench.by_height(image) == {22: verdict}
    assert getattr(stored.verdicts, verdict) == 1
    with bench.database.read() as session:
        judged, carried = history(session, image)
    assert (judged.segment_id, judged.kind) == (old, "judge")
    assert (carried.segment_id, carried.kind, carried.verdict) == (bench.at(image, 22), "carry", verdict)


@pytest.mark.parametrize(("verdict", "current"), [("keep", True), ("ambiguous", True), ("reject", False)])
def test_a_decision_for_a_candidate_without_successor_is_not_lost(small_bench, verdict, current) -> None:
    bench = small_bench
    bench.detect(20)
    image = bench.images[0]
    old = bench.at(image, 20)
    bench.detect(100)
    with bench.database.read() as session:
        revision = session.get_one(Image, image).revision
    bench.decide(image, {old: verdict})
    assert bench.by_height(image) == {100: "undecided"} | ({20: verdict} if current else {})
    with bench.database.read() as session:
        assert session.get_one(Image, image).revision == revision + current
        assert session.scalars(select(Decision)).one().verdict == verdict


def test_a_candidate_keeps_its_place_in_time(bench) -> None:
    """Segments are listed by origin, then in the order of their detection, whatever the run."""
    bench.detect(20, 40)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 40): "keep"})
    bench.detect(100, 120)
    assert [entry.box[1] for entry in bench.segments(image)] == [100, 40, 120]
    assert bench.summary(1, timedelta(0)).changes.carried == 0
