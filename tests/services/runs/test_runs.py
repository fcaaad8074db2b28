"""Runs as rows: started, claimed, failed, retried, cancelled, deleted and restored."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta

import numpy as np
import pytest

from app.db.models import Dataset, Image, RunImage
from app.errors import Conflict, InvalidInput, NotFound
from app.services.lens_estimates import finish_settled_runs
from app.services.run_progress import list_runs, run_images, run_summary
from app.services.run_queue import Claim, charge_attempt, fail_image, has_queued_images, put_back, release_lost
from app.services.runs import cancel_run, delete_run, restore_run, retry_run
from app.vision.code_version import code_version
from app.vision.segments import Segments

GRACE = timedelta(days=7)
REASON = {"code": "invalid-image", "message": "it is broken"}


def fail(bench, claim: Claim) -> None:
    with bench.database.write() as session:
        assert fail_image(session, claim, REASON, bench.now)


def states(bench, run_id: int) -> list[tuple[str, int]]:
    with bench.database.read() as session:
        return [(row.status, row.attempts) for row in run_images(session, run_id).items]


def test_a_run_is_queued_over_all_images_that_are_not_deleted(bench) -> None:
    with bench.database.write() as session:
        session.get_one(Image, bench.images[1]).deleted_at = bench.now
    run_id = bench.start(min_length=40, operating_point=None)
    summary = bench.summary(run_id)
    assert (summary.status, summary.total, summary.counts.queued, summary.seconds_left) == ("queued", 1, 1, None)
    assert summary.parameters["min_length"] == 40.0
    assert summary.parameters["operating_point"] == "balanced"
    assert (summary.parameters["camera"], summary.parameters["discard"]) == ("joint", False)
    assert summary.code_version == code_version()


@pytest.mark.parametrize(
    "parameters",
    [{"min_length": -1}, {"camera": "both"}, {"discard": "yes"}, {"shortest": 3}, {"operating_point": "x"}],
)
def test_parameters_that_cannot_be_are_refused(small_bench, parameters) -> None:
    bench = small_bench
    with pytest.raises(InvalidInput):
        bench.start(**parameters)


def test_of_many_that_start_at_once_one_has_the_images(bench) -> None:
    together = threading.Barrier(6)

    def start(_number: int) -> bool:
        together.wait()
        try:
            bench.start()
        except Conflict:
            return False
        return True

    with ThreadPoolExecutor(6) as threads:
        assert sum(threads.map(start, range(6))) == 1


def test_a_dataset_without_images_has_nothing_to_run_on(small_bench) -> None:
    bench = small_bench
    with bench.database.write() as session:
        for image in bench.images:
            session.get_one(Image, image).deleted_at = bench.now
    with pytest.raises(Conflict, match="no images"):
        bench.start()


def test_only_images_of_the_dataset_can_be_named(small_bench) -> None:
    bench = small_bench
    with pytest.raises(InvalidInput) as caught:
        bench.start([bench.images[0], 999])
    assert caught.value.details == {"images": [999]}


def test_two_runs_never_work_on_the_same_image(bench) -> None:
    first = bench.start([bench.images[0]])
    with pytest.raises(Conflict, match=f"run {first}"):
        bench.start()
    assert bench.start([bench.images[1]]) > first


def test_claims_count_attempts_and_start_the_run(bench) -> None:
    run_id = bench.start()
    [claim] = bench.claim(1)
    assert (claim.attempts, claim.image_name) == (1, "frame-0")
    summary = bench.summary(run_id)
    assert (summary.status, summary.started_at, summary.counts.running, summary.counts.queued) == (
        "running",
        bench.now,
        1,
        1,
    )
    assert [other.image_name for other in bench.claim()] == ["frame-1"]
    assert bench.claim() == []


def test_older_runs_come_first(small_bench) -> None:
    bench = small_bench
    first, second = bench.start([bench.images[1]]), bench.start([bench.images[0]])
    with bench.database.read() as session:
        runs = {row: session.get_one(RunImage, row).run_id for row in (1, 2)}
    assert [runs[claim.run_image_id] for claim in bench.claim()] == [first, second]


def test_one_image_fails_alone_and_can_be_retried(bench) -> None:
    run_id = bench.start(camera="per-image")
    broken, good = bench.claim()
    fail(bench, broken)
    assert bench.store(good, Segments.empty())
    assert bench.finish() == [run_id]
    summary = bench.summary(run_id)
    assert (summary.status, summary.counts.done, summary.counts.failed, summary.error) == ("done", 1, 1, None)
    with bench.database.read() as session:
        [row] = run_images(session, run_id, status="failed").items
    assert (row.image.name, row.error, row.attempts) == ("frame-0", REASON, 1)

    with bench.database.write() as session:
        assert retry_run(session, run_id, bench.now) == 1
    assert bench.summary(run_id).status == "running"
    [again] = bench.claim()
    assert (again.run_image_id, again.attempts) == (broken.run_image_id, 1)
    assert bench.store(again, Segments.empty())
    assert bench.finish() == [run_id]
    assert states(bench, run_id) == [("done", 1), ("done", 1)]


def test_a_run_of_which_every_image_failed_has_failed(bench) -> None:
    run_id = bench.start()
    for claim in bench.claim():
        fail(bench, claim)
    assert bench.finish() == [run_id]
    summary = bench.summary(run_id)
    assert summary.status == "failed"
    assert summary.error is not None
    assert summary.error["message"] == "none of its 2 images could be pre-labelled: it is broken"


def test_nothing_to_retry_is_a_conflict(small_bench) -> None:
    bench = small_bench
    run_id = bench.detect(20)
    with pytest.raises(Conflict, match="done again"), bench.database.write() as session:
        retry_run(session, run_id, bench.now)


def test_images_that_a_later_run_took_over_are_not_retried(bench) -> None:
    run_id = bench.start(camera="per-image")
    for claim in bench.claim():
        fail(bench, claim)
    bench.finish()
    later = bench.start([bench.images[0]], camera="per-image")
    with bench.database.write() as session:
        assert retry_run(session, run_id, bench.now) == 1
    assert states(bench, run_id) == [("failed", 1), ("queued", 0)]
    assert bench.summary(later).counts.queued == 1


def test_cancelling_keeps_what_is_finished_and_drops_what_arrives_later(bench) -> None:
    run_id = bench.start(camera="per-image")
    done, running = bench.claim()
    assert bench.store(done, Segments.empty())
    with bench.database.write() as session:
        cancel_run(session, run_id, bench.now)
    assert not bench.store(running, Segments.empty())
    summary = bench.summary(run_id)
    assert (summary.status, summary.counts.done, summary.counts.cancelled) == ("cancelled", 1, 1)
    assert bench.claim() == []
    with pytest.raises(Conflict, match="over already"), bench.database.write() as session:
        cancel_run(session, run_id, bench.now)
    with bench.database.write() as session:
        assert retry_run(session, run_id, bench.now) == 1
    assert [claim.run_image_id for claim in bench.claim()] == [running.run_image_id]


def test_a_deleted_run_hides_its_undecided_candidates_until_it_is_restored(bench) -> None:
    run_id = bench.detect(20, 40)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20): "keep"})
    with bench.database.write() as session:
        deleted = delete_run(session, run_id, bench.now, grace=GRACE)
    assert deleted.restorable_until == bench.now + GRACE
    assert bench.by_height(image) == {20: "keep"}
    assert bench.by_height(bench.images[1]) == {}
    with bench.database.read() as session:
        row = session.get_one(Image, image)
        dataset = session.get_one(Dataset, bench.dataset_id)
        assert (row.current_run_image_id, row.n_candidates, row.n_keep, row.revision) == (None, 1, 1, 2)
        assert list_runs(session, dataset, bench.now, grace=GRACE) == []
        [hidden] = list_runs(session, dataset, bench.now, grace=GRACE, deleted=True)
    assert (hidden.id, hidden.restorable_until) == (run_id, bench.now + GRACE)
    with pytest.raises(NotFound, match="is deleted"), bench.database.write() as session:
        delete_run(session, run_id, bench.now, grace=GRACE)

    with bench.database.write() as session:
        restore_run(session, run_id, bench.now)
    assert bench.by_height(image) == {20: "keep", 40: "undecided"}
    with bench.database.read() as session:
        row = session.get_one(Image, image)
        work = session.get_one(RunImage, row.current_run_image_id)
    assert (work.run_id, row.n_candidates, row.revision) == (run_id, 2, 3)
    with pytest.raises(Conflict, match="isn't deleted"), bench.database.write() as session:
        restore_run(session, run_id, bench.now)


def test_a_run_that_is_deleted_at_work_is_cancelled_first(bench) -> None:
    run_id = bench.start()
    [claim] = bench.claim(1)
    with bench.database.write() as session:
        delete_run(session, run_id, bench.now, grace=GRACE)
    assert not bench.store(claim, Segments.empty())
    summary = bench.summary(run_id)
    assert (summary.status, summary.counts.cancelled) == ("cancelled", 2)


def test_a_restored_run_does_not_displace_a_later_one(bench) -> None:
    first = bench.detect(20)
    with bench.database.write() as session:
        delete_run(session, first, bench.now, grace=GRACE)
    second = bench.detect(21, 60)
    with bench.database.write() as session:
        restore_run(session, first, bench.now)
    image = bench.images[0]
    assert bench.by_height(image) == {21: "undecided", 60: "undecided"}
    with bench.database.read() as session:
        current = session.get_one(Image, image).current_run_image_id
        assert session.get_one(RunImage, current).run_id == second


def test_lost_work_goes_back_until_its_attempts_are_used_up(small_bench) -> None:
    bench = small_bench
    run_id = bench.start([bench.images[0]])
    for attempt in (1, 2):
        assert [claim.attempts for claim in bench.claim()] == [attempt]
        with bench.database.write() as session:
            assert release_lost(session, 3) == 1
        assert states(bench, run_id) == [("queued", attempt)]
    bench.claim()
    with bench.database.write() as session:
        assert release_lost(session, 3) == 1
    with bench.database.read() as session:
        [row] = run_images(session, run_id).items
    assert (row.status, row.attempts) == ("failed", 3)
    assert row.error is not None
    assert row.error["code"] == "worker-died"


def test_only_silent_work_is_taken_back_from_a_living_dispatcher(small_bench) -> None:
    bench = small_bench
    bench.start()
    bench.claim()
    with bench.database.write() as session:
        assert release_lost(session, 3, silent_since=bench.now) == 0
        assert release_lost(session, 3, silent_since=bench.now + timedelta(seconds=1)) == 2


def test_work_put_back_is_not_charged(small_bench) -> None:
    bench = small_bench
    run_id = bench.start([bench.images[0]])
    [claim] = bench.claim()
    with bench.database.write() as session:
        put_back(session, [claim])
    assert states(bench, run_id) == [("queued", 0)]
    assert not bench.store(claim, Segments.empty())


def test_a_charged_attempt_makes_earlier_results_void(bench) -> None:
    bench.start([bench.images[0]])
    [claim] = bench.claim()
    with bench.database.write() as session:
        again = charge_attempt(session, claim, bench.now)
    assert again is not None
    assert again.attempts == 2
    assert not bench.store(claim, Segments.empty())
    assert bench.store(again, Segments.empty())
    with bench.database.write() as session:
        assert charge_attempt(session, again, bench.now) is None


def test_a_deleted_dataset_is_not_worked_on(bench) -> None:
    bench.start()
    with bench.database.write() as session:
        session.get_one(Dataset, bench.dataset_id).deleted_at = bench.now
    assert bench.claim() == []
    with bench.database.read() as session:
        assert not has_queued_images(session)
        with pytest.raises(NotFound):
            run_summary(session, 1, bench.now, grace=GRACE)


def test_time_left_follows_the_pace_of_finished_images(small_bench) -> None:
    bench = small_bench
    run_id = bench.start(camera="per-image")
    first, _ = bench.claim()
    assert bench.summary(run_id, timedelta(seconds=5)).seconds_left is None
    with bench.database.write() as session:
        fail_image(session, first, REASON, bench.now + timedelta(seconds=10))
    assert bench.summary(run_id, timedelta(seconds=10)).seconds_left == 10.0
    assert bench.summary(run_id, timedelta(seconds=14)).seconds_left == 6.0
    assert bench.summary(run_id, timedelta(seconds=99)).seconds_left == 0.0


def test_images_of_a_run_come_in_pages_by_name(bench) -> None:
    run_id = bench.start()
    with bench.database.read() as session:
        first = run_images(session, run_id, limit=1)
        second = run_images(session, run_id, limit=1, cursor=first.next_cursor)
        with pytest.raises(InvalidInput):
            run_images(session, run_id, cursor="nonsense")
    assert [row.image.name for page in (first, second) for row in page.items] == ["frame-0", "frame-1"]
    assert (first.total, second.next_cursor) == (2, None)


def test_a_run_whose_images_are_gone_ends(bench) -> None:
    run_id = bench.start([bench.images[0]])
    with bench.database.write() as session:
        session.delete(session.get_one(Image, bench.images[0]))
    with bench.database.write() as session:
        assert finish_settled_runs(session, bench.now) == [run_id]


def test_changes_are_summed_over_images(bench) -> None:
    bench.detect(20, 40)
    for image in bench.images:
        bench.decide(image, {bench.at(image, 20): "keep", bench.at(image, 40): "keep"})
    summary = bench.summary(bench.detect(20))
    assert np.array_equal(
        [summary.candidates, summary.changes.carried, summary.changes.kept_unmatched, summary.changes.retired],
        [2, 2, 2, 2],
    )
