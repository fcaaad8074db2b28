"""From finished images to a camera's lens to the straightness of each candidate, step by step."""

from __future__ import annotations

import numpy as np
import pytest
from sqlalchemy import func, select

from app.db.models import Camera, CameraEstimate, Image, RunImage, Segment
from app.services.lens_estimates import (
    EstimateStep,
    JudgeStep,
    candidates_to_judge,
    give_up_judging,
    lens_segments_of,
    pending_estimates,
    pending_judgements,
    store_estimate,
    store_straightness,
)
from app.services.run_queue import fail_image
from app.services.runs import retry_run

LENS = {"model": "brown", "accepted": True, "reasons": []}


@pytest.fixture
def run_id(bench) -> int:
    """A joint run whose images are detected, three lines in each, nothing estimated yet."""
    run_id = bench.start()
    for claim in bench.claim():
        assert bench.store_lines(claim, 20, 40, 60)
    return run_id


def steps(bench) -> tuple[list[EstimateStep], list[JudgeStep]]:
    with bench.database.read() as session:
        return pending_estimates(session), pending_judgements(session, 10)


def estimate(bench) -> bool:
    [step], _ = steps(bench)
    with bench.database.write() as session:
        return store_estimate(session, step, LENS, bench.now)


def judge(bench, step: JudgeStep, *values: float) -> bool:
    straightness = np.array(values, np.float32)
    with bench.database.write() as session:
        return store_straightness(session, step, straightness, 1 - straightness, bench.now)


def test_nothing_is_estimated_while_images_are_at_work(bench) -> None:
    bench.start()
    first, second = bench.claim()
    bench.store_lines(first, 20)
    assert steps(bench) == ([], [])
    bench.store_lines(second, 20)
    [step], judgements = steps(bench)
    assert ((step.width, step.height), judgements) == ((200, 160), [])


def test_a_run_ends_once_every_candidate_is_judged(bench, run_id) -> None:
    assert bench.finish() == []
    assert estimate(bench)
    estimates, judgements = steps(bench)
    assert (estimates, len(judgements)) == ([], 2)
    assert bench.finish() == []
    assert judge(bench, judgements[0], 0.9, 0.2, 0.5)
    assert bench.finish() == []
    assert judge(bench, judgements[1], 0.9, 0.2, 0.5)
    assert steps(bench) == ([], [])
    assert bench.finish() == [run_id]
    entries = bench.segments(judgements[0].image_id)
    assert [entry.straight for entry in entries] == [True, False, True]
    assert [entry.residual for entry in entries] == pytest.approx([0.1, 0.8, 0.5])
    [camera] = bench.summary(run_id).cameras
    assert (camera.name, camera.distortion) == ("front", LENS)


def test_steps_stored_twice_change_nothing(bench, run_id) -> None:
    [step], _ = steps(bench)
    assert estimate(bench)
    with bench.database.write() as session:
        assert not store_estimate(session, step, LENS, bench.now)
    _, [first, _] = steps(bench)
    assert judge(bench, first, 0.9, 0.9, 0.9)
    assert not judge(bench, first, 0.1, 0.1, 0.1)
    assert [entry.straightness for entry in bench.segments(first.image_id)] == pytest.approx([0.9] * 3)
    with bench.database.read() as session:
        assert session.scalar(select(func.count()).select_from(CameraEstimate)) == 1
        assert session.get_one(Image, first.image_id).revision == 2


def test_discarding_drops_what_fails_and_nobody_decided_on(bench) -> None:
    run_id = bench.start(discard=True)
    for claim in bench.claim():
        bench.store_lines(claim, 20, 40, 60)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20): "keep"})
    estimate(bench)
    for step in steps(bench)[1]:
        assert judge(bench, step, 0.2, 0.3, 0.7)
    assert bench.finish() == [run_id]
    assert bench.by_height(image) == {20: "keep", 60: "undecided"}
    assert bench.by_height(bench.images[1]) == {60: "undecided"}
    assert bench.summary(run_id).changes.discarded == 3
    with bench.database.read() as session:
        assert session.get_one(Image, image).n_candidates == 2


def test_what_cannot_be_judged_does_not_hold_the_run_up(bench, run_id) -> None:
    estimate(bench)
    reason = {"code": "error", "message": "no"}
    for step in steps(bench)[1]:
        with bench.database.write() as session:
            give_up_judging(session, step, reason)
    assert bench.finish() == [run_id]
    assert {entry.straight for entry in bench.segments(bench.images[0])} == {True}


def test_each_camera_is_estimated_from_its_own_images(bench, run_id) -> None:
    with bench.database.write() as session:
        other = Camera(dataset_id=bench.dataset_id, name="rear", width=200, height=160, created_at=bench.now)
        session.add(other)
        session.flush()
        session.get_one(Image, bench.images[1]).camera_id = other.id
    estimates, _ = steps(bench)
    assert len(estimates) == 2
    with bench.database.read() as session:
        assert [len(lens_segments_of(session, step)) for step in estimates] == [1, 1]


def test_a_worker_gets_points_and_lens(bench, run_id) -> None:
    estimate(bench)
    _, [step, _] = steps(bench)
    with bench.database.read() as session:
        candidates, distortion = candidates_to_judge(session, step)
    assert [line[0].tolist() for line in candidates] == [[10, 20], [10, 40], [10, 60]]
    assert distortion == LENS


def test_a_retry_estimates_the_lens_anew(bench) -> None:
    run_id = bench.start()
    first, second = bench.claim()
    bench.store_lines(first, 20)
    with bench.database.write() as session:
        fail_image(session, second, {"message": "broken"}, bench.now)
    estimate(bench)
    [step] = steps(bench)[1]
    judge(bench, step, 0.9)
    assert bench.finish() == [run_id]
    with bench.database.write() as session:
        retry_run(session, run_id, bench.now)
    with bench.database.read() as session:
        assert session.get_one(RunImage, first.run_image_id).camera_estimate_id is None
    [again] = bench.claim()
    bench.store_lines(again, 20)
    assert estimate(bench)
    assert len(steps(bench)[1]) == 2
    with bench.database.read() as session:
        assert session.scalar(select(func.count()).select_from(Segment)) == 2
