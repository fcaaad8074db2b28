"""Calibrations by real dispatchers and workers: watched, called off, killed and taken up again."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest
from sqlalchemy import select

from app.calibration.lens import CameraLens
from app.db.models import Calibration, Camera, Event, Image
from app.errors import Cancelled, Unavailable
from app.formats.labelled import LabelledSegments
from app.formats.reference_camera import ReferenceCamera
from app.jobs.calibration_answers import difference_task
from app.jobs.calibration_desk import CalibrationDesk
from app.jobs.executor import make_executor
from app.jobs.notes import TaskNotes, watch_through
from app.jobs.work import Tasks
from app.services.calibration_lines import lines_of
from app.services.calibrations import cancel_calibration, get_calibration, start_calibration
from app.services.labels import ImageLabels, import_labels
from app.vision.segments import Segments

HERE = Path(__file__).parent
PROJECT = HERE.parents[1]
Eventually = Callable[[Callable[[], Any], str], Any]


def tasks(name: str) -> Tasks:
    return Tasks(calibrate=getattr(importlib.import_module("gated_calibrations"), name))


def label(yard: Any, *names: str) -> None:
    """Add images with kept lines: straight ones, all over the image."""
    yard.add(*names)
    with yard.database.write() as session:
        for number, image in enumerate(session.scalars(select(Image).order_by(Image.id)).all()):
            random = np.random.default_rng(number)
            ends = [random.uniform((2, 2), (157, 117), (2, 2)) for _ in range(12)]
            points = [np.linspace(end[0], end[1], 30) + random.normal(0, 0.05, (30, 2)) for end in ends]
            labelled = LabelledSegments(Segments.from_list([each.astype(np.float32) for each in points]))
            import_labels(session, image, ImageLabels(labelled), yard.now(), newly_added=True)


def start(yard: Any) -> int:
    with yard.database.write() as session:
        camera = session.scalars(select(Camera)).one()
        return start_calibration(session, camera, "labels", "brown", yard.now()).id


def row_of(yard: Any, calibration: int) -> Calibration:
    with yard.database.read() as session:
        return get_calibration(session, calibration, whole=True)


def is_over(yard: Any, calibration: int) -> bool:
    return row_of(yard, calibration).status not in ("queued", "running")


def notes_left(yard: Any) -> list[str]:
    folder = yard.settings.data_dir / "notes"
    return [path.name for path in folder.iterdir()] if folder.exists() else []


def test_progress_reaches_the_row_and_calling_it_off_the_worker(small_yard, eventually: Eventually) -> None:
    yard = small_yard
    label(yard, "a")
    calibration = start(yard)
    dispatcher = yard.dispatcher(tasks("gated_calibrate"))
    dispatcher.start()
    try:
        expected = {"stage": "waiting at the gate", "done": 1, "total": 3}
        eventually(lambda: row_of(yard, calibration).progress == expected, "the progress is in the row")
        with yard.database.write() as session:
            cancel_calibration(session, calibration, yard.now())
        dispatcher.wake()
        eventually(lambda: not notes_left(yard), "the worker stopped and its notes are gone")
        yard.open_gate()
        second = start(yard)
        dispatcher.wake()
        eventually(lambda: is_over(yard, second), "the worker is free for another one")
    finally:
        dispatcher.stop()
    row = row_of(yard, calibration)
    assert (row.status, row.result, row.progress) == ("cancelled", None, None)
    assert row_of(yard, second).error is None


def test_one_that_kills_its_worker_fails_alone(small_yard) -> None:
    yard = small_yard
    label(yard, "a")
    calibration = start(yard)
    yard.dispatcher(tasks("deadly_calibrate"), max_attempts=2).run_until_idle()
    row = row_of(yard, calibration)
    assert (row.status, row.attempts) == ("failed", 2)
    assert row.error is not None
    assert row.error["code"] == "worker-died"


def test_a_killed_server_finishes_it_once_after_its_restart(small_yard, eventually: Eventually) -> None:
    yard, database_url = small_yard, str(small_yard.database.engine.url)
    label(yard, "a", "b")
    calibration = start(yard)
    server = run_server(yard, database_url)
    try:
        worker = eventually(lambda: yard.begun().get("calibration"), "it is being worked on")
    finally:
        server.kill()
        server.wait()
    row = row_of(yard, calibration)
    assert (row.status, row.attempts, row.result) == ("running", 1, None)
    eventually(lambda: not psutil.pid_exists(worker), "the worker ends with its server")
    yard.open_gate()
    server = run_server(yard, database_url)
    try:
        eventually(lambda: is_over(yard, calibration), "it is finished")
    finally:
        server.terminate()
        assert server.wait(60) == 0
    row = row_of(yard, calibration)
    assert (row.status, row.attempts, row.error) == ("done", 2, None)
    assert notes_left(yard) == []
    assert row.result is not None
    assert row.result["counts"]["images"] == row.n_images == 2
    lines = lines_of(row)
    assert set(lines.image_id.tolist()) == set(row.parameters["images"])
    assert len(set(lines.segment_id.tolist())) == len(lines) == row.result["counts"]["used"]
    with yard.database.read() as session:
        assert len(session.scalars(select(Event).where(Event.kind == "camera.calibrated")).all()) == 1
        assert len(session.scalars(select(Calibration.id)).all()) == 1


def run_server(yard: Any, address: str) -> subprocess.Popen[bytes]:
    environment = {**os.environ, "PYTHONPATH": f"{PROJECT}{os.pathsep}{HERE}"}
    command = [sys.executable, str(HERE / "calibrating_process.py"), address, str(yard.settings.data_dir)]
    return subprocess.Popen(command, env=environment)


def test_notes_are_paced_and_tell_to_stop(tmp_path: Path) -> None:
    notes = TaskNotes(tmp_path / "folder" / "task-1")
    notes.prepare()
    assert notes.progress() is None
    times = iter([0.0, 0.1, 0.15, 1.0, 1.0])
    watch = watch_through(notes, clock=lambda: next(times), pause=0.2)
    watch("ladder", 1, 9)
    watch("ladder", 2, 9)  # too soon after the one before
    assert notes.progress() == {"stage": "ladder", "done": 1, "total": 9}
    notes.call_off()
    with pytest.raises(Cancelled):
        watch("focal length", 0, 1)
    notes.prepare()
    assert not notes.is_called_off()


@pytest.mark.parametrize("more", [(), (0.0,), (0.0, 0.0, 0.0, 0.0), (0.0,) * 10])
def test_a_reference_may_have_any_of_opencv_s_numbers_of_coefficients(more: tuple[float, ...]) -> None:
    lens = CameraLens("opencv", 320, 240, (-0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    matrix = ((lens.scale, 0.0, 159.5), (0.0, lens.scale, 119.5), (0.0, 0.0, 1.0))
    reference = ReferenceCamera(320, 240, matrix, (-0.02, 0.0, 0.0, 0.0, *more))
    assert difference_task(lens.as_dict(), reference)["maximum"] < 1e-4
    other = replace(reference, distortion=(-0.05, 0.0, 0.0, 0.0, *more))
    assert difference_task(lens.as_dict(), other)["rms"] > 0.3


def test_the_desk_remembers_answers_and_says_when_its_worker_died(tmp_path: Path) -> None:
    made: list[int] = []

    def counting(workers: int) -> Any:
        made.append(workers)
        return make_executor(workers)

    desk = CalibrationDesk(executors=counting)
    try:
        assert desk.answer("a", "camera", abs, lambda: (-3,)) == 3
        assert desk.answer("a", "camera", abs, lambda: (-4,)) == 3, "the same key is the same answer"
        with pytest.raises(Unavailable, match="was killed"):
            desk.answer("b", "camera", os._exit, lambda: (1,))
        assert desk.answer("b", "camera", abs, lambda: (-5,)) == 5
        assert len(made) == 2
    finally:
        desk.stop()
