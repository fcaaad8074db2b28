"""Calibrations as rows: one at a time, claimed, stored once, lost and taken up, cancelled, deleted, purged."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest
from sqlalchemy import select

from app.db.models import Calibration, Camera, Event
from app.errors import Conflict, InvalidInput, NotFound
from app.services.calibration_queue import (
    beat_calibration,
    charge_calibration,
    claim_calibration,
    fail_calibration,
    holds,
    put_calibration_back,
    release_lost_calibrations,
    store_calibration,
)
from app.services.calibrations import (
    cancel_calibration,
    delete_calibration,
    finished_calibration,
    get_calibration,
    restore_calibration,
)
from app.services.camera_details import camera_detail
from app.services.datasets import delete_dataset, get_dataset
from app.services.images import delete_images
from app.services.purging import purge
from app.storage import LocalBlobs

GRACE = timedelta(days=7)


def test_one_of_a_camera_at_a_time(bench) -> None:
    bench.image("a", ["keep"] * 4)
    first = bench.start()
    with pytest.raises(Conflict) as error:
        bench.start()
    assert error.value.details == {"calibration": first}
    with bench.database.write() as session:
        cancel_calibration(session, first, bench.now, person="ada")
    assert bench.start() != first
    assert bench.row(first).status == "cancelled"


@pytest.mark.parametrize(
    ("source", "family", "error"),
    [("labels", None, Conflict), ("guesses", None, InvalidInput), ("candidates", "fisheye", InvalidInput)],
)
def test_what_can_t_be_calibrated(small_bench, source: str, family: str | None, error: type[Exception]) -> None:
    small_bench.image("a", ["keep", "keep", "reject", "undecided"])
    with pytest.raises(error):
        small_bench.start(source, family)
    assert small_bench.start("candidates")


def test_a_result_is_stored_once_and_only_for_its_attempt(bench) -> None:
    image = bench.image("a", ["keep"] * 3)
    calibration = bench.start()
    claim = bench.claim()
    found = bench.found([image])
    with bench.database.write() as session:
        assert claim_calibration(session, bench.now) is None
        assert not store_calibration(session, replace(claim, attempts=2), found, bench.now)
        assert store_calibration(session, claim, found, bench.now)
        assert not store_calibration(session, claim, found, bench.now)
        assert not fail_calibration(session, claim, {"message": "late"}, bench.now)
    row = bench.row(calibration)
    assert (row.status, row.attempts, row.error, row.progress) == ("done", 1, None, None)
    assert (row.n_images, row.n_segments) == (1, 3)
    assert row.summary is not None
    assert row.summary["pred"] == bench.result["uncertainty"]["pred"]
    with bench.database.read() as session:
        kinds = session.scalars(select(Event.kind).order_by(Event.id)).all()
        assert kinds.count("camera.calibrated") == 1
        assert finished_calibration(session, calibration).result == {**found.result}


def test_progress_is_told_while_it_runs(small_bench) -> None:
    small_bench.image("a", ["keep"] * 3)
    calibration = small_bench.start()
    claim = small_bench.claim()
    progress = {"stage": "ladder", "done": 1, "total": 3}
    with small_bench.database.write() as session:
        beat_calibration(session, claim, progress, small_bench.now)
        beat_calibration(session, claim, None, small_bench.now + timedelta(seconds=5))
        beat_calibration(session, replace(claim, attempts=7), {"stage": "other"}, small_bench.now)
    row = small_bench.row(calibration)
    assert (row.progress, row.heartbeat_at) == (progress, small_bench.now + timedelta(seconds=5))


def test_lost_work_is_taken_up_until_it_was_tried_too_often(bench) -> None:
    bench.image("a", ["keep"] * 3)
    calibration = bench.start()
    bench.claim()
    with bench.database.write() as session:
        early = bench.now - timedelta(seconds=1)
        assert release_lost_calibrations(session, 2, bench.now, silent_since=early) == 0
        assert release_lost_calibrations(session, 2, bench.now) == 1
    assert bench.row(calibration).status == "queued"
    assert bench.claim().attempts == 2
    with bench.database.write() as session:
        release_lost_calibrations(session, 2, bench.now)
    row = bench.row(calibration)
    assert row.status == "failed"
    assert row.error is not None
    assert row.error["code"] == "worker-died"


def test_what_was_put_back_isn_t_charged_and_what_killed_its_worker_is(small_bench) -> None:
    small_bench.image("a", ["keep"] * 3)
    calibration = small_bench.start()
    claim = small_bench.claim()
    with small_bench.database.write() as session:
        put_calibration_back(session, claim)
        assert not holds(session, claim)
    assert small_bench.row(calibration).attempts == 0
    claim = small_bench.claim()
    with small_bench.database.write() as session:
        again = charge_calibration(session, claim, small_bench.now)
        assert again is not None
        assert again.attempts == 2
        assert charge_calibration(session, claim, small_bench.now) is None


def test_a_cancelled_one_takes_no_result(small_bench) -> None:
    image = small_bench.image("a", ["keep"] * 3)
    calibration = small_bench.start()
    claim = small_bench.claim()
    with small_bench.database.write() as session:
        cancel_calibration(session, calibration, small_bench.now)
        assert not store_calibration(session, claim, small_bench.found([image]), small_bench.now)
        with pytest.raises(Conflict, match="over already"):
            cancel_calibration(session, calibration, small_bench.now)
    with small_bench.database.read() as session, pytest.raises(Conflict, match="has no result"):
        finished_calibration(session, calibration)


def test_delete_restore_and_purge(bench, tmp_path: Path) -> None:
    image = bench.image("a", ["keep"] * 3)
    old, new = bench.calibrated([image]), bench.calibrated([image])

    def latest() -> int | None:
        with bench.database.read() as session:
            return camera_detail(session, session.get_one(Camera, bench.camera_id), grace=GRACE).latest_calibration_id

    assert latest() == new
    with bench.database.write() as session:
        delete_calibration(session, new, bench.now, grace=GRACE)
        with pytest.raises(NotFound, match="is deleted"):
            get_calibration(session, new)
    assert latest() == old
    with bench.database.write() as session:
        restore_calibration(session, new, bench.now)
        with pytest.raises(Conflict):
            restore_calibration(session, new, bench.now)
    assert latest() == new
    with bench.database.write() as session:
        delete_calibration(session, new, bench.now, grace=GRACE)
    blobs = LocalBlobs(tmp_path / "blobs")
    assert purge(bench.database, blobs, bench.now, grace=GRACE).calibrations == 0
    assert purge(bench.database, blobs, bench.now + GRACE, grace=GRACE).calibrations == 1
    with bench.database.write() as session, pytest.raises(NotFound, match="no calibration"):
        restore_calibration(session, new, bench.now)


def test_a_camera_s_last_image_may_go(bench, tmp_path: Path) -> None:
    image = bench.image("a", ["keep"] * 3)
    bench.calibrated([image])
    with bench.database.write() as session:
        dataset = get_dataset(session, "bench")
        delete_images(session, dataset, [image], bench.now, grace=GRACE)
    blobs = LocalBlobs(tmp_path / "blobs")
    purge(bench.database, blobs, bench.now + 2 * GRACE, grace=GRACE)
    with bench.database.read() as session:
        detail = camera_detail(session, session.get_one(Camera, bench.camera_id), grace=GRACE)
    assert (detail.images, detail.kept_lines, detail.decisions_since) == (0, 0, 0)
    assert detail.latest_calibration is not None
    with bench.database.write() as session:
        delete_dataset(session, "bench", bench.now, grace=GRACE)
    purge(bench.database, blobs, bench.now + 2 * GRACE, grace=GRACE)
    with bench.database.read() as session:
        assert session.scalars(select(Calibration.id)).all() == []
