"""Workers of a pool that hang or grow: ended, replaced, and only the image that hangs is charged."""

from __future__ import annotations

import importlib
from typing import Any

import pytest

from app.jobs.calibration_tasks import LIMITS
from app.jobs.calibration_work import CalibrationWork
from app.jobs.dispatcher import Dispatcher
from app.jobs.executor import megabytes_of
from app.jobs.hanging import hung_worker_error, longest_seconds
from app.jobs.notes import NoteFolder
from app.jobs.stores import Stores
from app.jobs.work import DetectWork, Tasks
from app.services.calibration_queue import CalibrationClaim
from app.services.run_queue import Claim


def tasks(name: str) -> Tasks:
    return Tasks(detect=getattr(importlib.import_module("gated_tasks"), name))


def dispatcher(yard: Any, name: str, **changes: Any) -> Dispatcher:
    settings = yard.settings.model_copy(update=changes)
    return Dispatcher(yard.database, yard.blobs, settings, yard.now, tasks=tasks(name))


def test_an_image_that_hangs_is_given_up_alone(small_yard, eventually) -> None:
    yard = small_yard
    yard.add("held-a", "b", "c")
    run_id = yard.start()
    at_work = dispatcher(yard, "gated_detect", task_seconds=5.0, max_attempts=1)
    at_work.start()
    try:
        eventually(lambda: yard.finished(run_id), "the run is finished")
    finally:
        at_work.stop()
    rows = yard.rows(run_id)
    held = rows.pop("held-a")
    assert (held.status, held.attempts, held.segments) == ("failed", 1, ())
    assert held.error["code"] == "worker-hung"
    assert {(row.status, row.attempts) for row in rows.values()} == {("done", 1)}


@pytest.mark.skipif(megabytes_of(1) is None, reason="the system doesn't tell how much memory a process holds")
def test_workers_that_hold_too_much_are_replaced_and_no_image_is_charged(small_yard) -> None:
    yard = small_yard
    yard.add(*"abcd")
    run_id = yard.start()
    at_work = dispatcher(yard, "told_detect", worker_megabytes=256, workers=1)
    at_work.run_until_idle()
    assert {(row.status, row.attempts) for row in yard.rows(run_id).values()} == {("done", 1)}
    # each task leaves 300 MB behind, and two are in flight before the first is looked at
    assert len(set(yard.begun().values())) >= 2


def test_work_whose_task_bounds_itself_may_take_as_long(small_yard) -> None:
    stores = Stores(small_yard.database, small_yard.blobs, 10**7, NoteFolder(small_yard.settings.data_dir))
    detect = DetectWork(Claim(1, 1, 1, "a", "0" * 64, {}))
    calibrate = CalibrationWork(CalibrationClaim(1, 1, 1, "front", 100, 100, "labels", None))
    assert longest_seconds(detect, stores, 900.0) == 900.0
    assert longest_seconds(calibrate, stores, 900.0) == LIMITS.seconds + 2 * LIMITS.grace
    assert longest_seconds(calibrate, stores, 9000.0) == 9000.0
    assert hung_worker_error(2, 900.0)["message"] == "it took longer than 900 s, 2 times"
