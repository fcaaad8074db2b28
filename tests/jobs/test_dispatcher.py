"""The dispatcher's road with the real pipeline, in threads: nothing here is killed."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import timedelta
from typing import NoReturn

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import CameraEstimate, Image, Run, RunImage, Segment
from app.db.session import Database
from app.errors import InvalidInput, Unavailable
from app.jobs import dispatcher as dispatcher_module
from app.jobs.work import Tasks
from app.services.deciding import decide
from app.services.decision_batch import Wish
from app.services.labelling import segments_of_image
from app.services.lens_estimates import pending_judgements
from app.services.runs import cancel_run, delete_run, restore_run, retry_run

BROKEN = b"\x89PNG\r\n\x1a\n but no image"


def in_threads(workers: int) -> Executor:
    return ThreadPoolExecutor(workers)


def work_off(yard, tasks: Tasks | None = None, **options) -> None:
    yard.dispatcher(tasks, executors=in_threads, **options).run_until_idle()


def segments(yard, image_id: int):
    with yard.database.read() as session:
        return segments_of_image(session, image_id).segments


def test_a_run_is_worked_off_to_the_judged_candidate(yard) -> None:
    yard.add("a", "b", "c")
    run_id = yard.start()
    work_off(yard)
    summary = yard.summary(run_id)
    assert (summary.status, summary.counts.done, summary.total) == ("done", 3, 3)
    assert summary.finished_at is not None
    [camera] = summary.cameras
    assert (camera.name, camera.distortion["width"]) == ("front", 160)
    for row in yard.rows(run_id).values():
        entries = segments(yard, row.image_id)
        assert len(entries) == len(row.segments) >= 3
        assert all(entry.straightness is not None and entry.residual is not None for entry in entries)


def test_each_image_alone_has_its_own_lens(small_yard) -> None:
    yard = small_yard
    yard.add("a", "b")
    run_id = yard.start(camera="per-image")
    work_off(yard)
    assert yard.summary(run_id).cameras == ()
    with yard.database.read() as session:
        rows = session.scalars(select(RunImage)).all()
        assert all(row.distortion is not None and row.distortion["width"] == 160 for row in rows)
        assert all(value is not None for value in session.scalars(select(Segment.straightness)))


def test_one_broken_image_fails_alone_and_can_be_retried(yard) -> None:
    yard.add("a", "c")
    yard.add("b", content=BROKEN)
    run_id = yard.start()
    work_off(yard)
    rows = yard.rows(run_id)
    assert {name: (row.status, row.attempts) for name, row in rows.items()} == {
        "a": ("done", 1),
        "b": ("failed", 1),
        "c": ("done", 1),
    }
    assert rows["b"].error is not None
    assert rows["b"].error["code"] == "invalid-image"
    assert yard.summary(run_id).status == "done"

    yard.mend("b")
    with yard.database.write() as session:
        assert retry_run(session, run_id, yard.now()) == 1
    work_off(yard)
    after = yard.rows(run_id)
    assert after["b"].status == "done"
    assert len(after["b"].segments) >= 3
    assert (after["a"], after["c"]) == (rows["a"], rows["c"])
    with yard.database.read() as session:
        assert {row.camera_estimate_id for row in session.scalars(select(RunImage))} == {
            session.scalars(select(CameraEstimate.id)).one()
        }


def test_a_second_run_carries_verdicts(yard) -> None:
    yard.add("a")
    first = yard.start()
    work_off(yard)
    image = yard.rows(first)["a"].image_id
    entries = segments(yard, image)
    verdicts = {entry.id: verdict for entry, verdict in zip(entries, ("keep", "reject", "ambiguous"), strict=False)}
    with yard.database.write() as session:
        wishes = [
            Wish(f"00000000-0000-0000-0000-{key:012d}", f"00000000-0000-0000-0000-{0:012d}", key, verdict)
            for key, verdict in verdicts.items()
        ]
        decide(session, image, wishes, "owner", yard.now())
    second = yard.start(min_length=50)
    work_off(yard)
    changes = yard.summary(second).changes
    assert (changes.carried, changes.kept_unmatched, changes.retired) == (3, 0, len(entries))
    after = segments(yard, image)
    assert sorted(entry.verdict for entry in after if entry.verdict != "undecided") == ["ambiguous", "keep", "reject"]
    assert {entry.id for entry in after}.isdisjoint(verdicts)


def test_a_deleted_and_restored_run_has_its_candidates_back(small_yard) -> None:
    yard = small_yard
    yard.add("a")
    run_id = yard.start()
    work_off(yard)
    image = yard.rows(run_id)["a"].image_id
    before = segments(yard, image)
    with yard.database.write() as session:
        delete_run(session, run_id, yard.now(), grace=timedelta(days=7))
    assert segments(yard, image) == ()
    with yard.database.write() as session:
        restore_run(session, run_id, yard.now())
    assert segments(yard, image) == before


def test_a_cancelled_run_is_left_alone(small_yard) -> None:
    yard = small_yard
    yard.add("a", "b")
    run_id = yard.start()
    with yard.database.write() as session:
        cancel_run(session, run_id, yard.now())
    work_off(yard)
    assert {row.status for row in yard.rows(run_id).values()} == {"cancelled"}


def test_a_run_that_stopped_before_its_estimates_makes_them_at_the_next_start(small_yard) -> None:
    yard = small_yard
    yard.add("a", "b")
    run_id = yard.start()

    class ServerDied(BaseException):
        pass

    def die_when_detected() -> None:
        if yard.summary(run_id).counts.done == 2:
            raise ServerDied

    with pytest.raises(ServerDied):
        # the first turn with all images done hasn't begun to judge them
        yard.dispatcher(Tasks(estimate=never), executors=in_threads).run_until_idle(die_when_detected)
    rows = yard.rows(run_id)
    assert yard.summary(run_id).status == "running"
    work_off(yard)
    assert yard.summary(run_id).status == "done"
    assert yard.rows(run_id) == rows
    with yard.database.read() as session:
        assert all(value is not None for value in session.scalars(select(Segment.straightness)))


def never(*_args: object, **_options: object) -> NoReturn:
    raise InvalidInput("no lens today")


def test_an_estimate_that_fails_is_refused_with_the_reason(small_yard) -> None:
    yard = small_yard
    yard.add("a")
    run_id = yard.start()
    work_off(yard, Tasks(estimate=never))
    [camera] = yard.summary(run_id).cameras
    assert (camera.distortion["accepted"], camera.distortion["reasons"]) == (False, ["no lens today"])
    assert yard.summary(run_id).status == "done"


def test_candidates_that_cannot_be_judged_do_not_hold_the_run_up(small_yard) -> None:
    yard = small_yard
    yard.add("a")
    run_id = yard.start()
    work_off(yard, Tasks(judge=never))
    row = yard.rows(run_id)["a"]
    assert (row.status, yard.summary(run_id).status) == ("done", "done")
    assert row.error is not None
    assert row.error["message"] == "no lens today"


def test_bytes_that_are_gone_fail_one_image(small_yard) -> None:
    yard = small_yard
    yard.add("a", "b")
    with yard.database.read() as session:
        sha256 = session.scalars(select(Image.sha256).where(Image.name == "a")).one()
    yard.blobs.delete(sha256)
    run_id = yard.start()
    work_off(yard)
    assert {name: row.status for name, row in yard.rows(run_id).items()} == {"a": "failed", "b": "done"}


@dataclass(frozen=True)
class StumblingDatabase(Database):
    """Can't answer every third time that something is to be written, as a real one that restarts now and then."""

    calls: list[int] = field(default_factory=list)

    @contextmanager
    def write(self) -> Iterator[Session]:
        self.calls.append(1)
        if len(self.calls) % 3 == 0:
            raise Unavailable("the database can't answer")
        with super().write() as session:
            yield session


def test_a_database_that_stumbles_costs_time_only(small_yard, monkeypatch) -> None:
    yard = small_yard
    monkeypatch.setattr(dispatcher_module, "DATABASE_PAUSE", 0.01)
    yard.add("a", "b", "c", "d")
    run_id = yard.start()
    database = StumblingDatabase(yard.database.engine)
    work_off(yard, database=database)
    assert len(database.calls) > 6
    rows = yard.rows(run_id)
    assert {(row.status, row.attempts) for row in rows.values()} == {("done", 1)}
    assert all(len(segments(yard, row.image_id)) == len(row.segments) > 0 for row in rows.values())
    assert yard.summary(run_id).status == "done"


def test_work_in_the_background_begins_when_woken(small_yard, eventually) -> None:
    yard = small_yard
    dispatcher = yard.dispatcher(executors=in_threads)
    dispatcher.start()
    dispatcher.start()
    try:
        yard.add("a")
        run_id = yard.start()
        dispatcher.wake()
        eventually(lambda: yard.finished(run_id), "the run is finished")
    finally:
        dispatcher.stop()
        dispatcher.stop()
    assert yard.summary(run_id).status == "done"


def test_a_second_dispatcher_waits_for_the_first_one(small_yard, eventually) -> None:
    yard = small_yard
    first = yard.dispatcher(executors=in_threads)
    first.start()
    try:
        yard.add("a", "b")
        run_id = yard.start()
        first.wake()
        yard.dispatcher(Tasks(detect=never), executors=in_threads).run_until_idle()
        assert yard.summary(run_id).status == "done"
    finally:
        first.stop()


def test_progress_is_told(small_yard) -> None:
    yard = small_yard
    yard.add("a", "b")
    run_id = yard.start()
    seen: list[int] = []
    yard.dispatcher(executors=in_threads).run_until_idle(lambda: seen.append(yard.summary(run_id).counts.done))
    assert seen[0] == 0
    assert seen[-1] == 2
    assert seen == sorted(seen)


def test_nothing_to_do_is_done_at_once(small_yard) -> None:
    work_off(small_yard)
    with small_yard.database.read() as session:
        assert session.scalars(select(Run)).all() == []
        assert pending_judgements(session, 1) == []
