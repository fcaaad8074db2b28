"""A dispatcher of this process over the workers of a cluster that die, hang, grow, or run another version."""

from __future__ import annotations

import importlib
import os
import signal
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psutil
import pytest

from app.errors import Cancelled, ClearLinesError
from app.jobs.cluster.admission import BUSY
from app.jobs.cluster.crew import ClusterCrew
from app.jobs.crew_choice import crew_of
from app.jobs.dispatcher import Dispatcher
from app.jobs.executor import make_executor
from app.jobs.losses import WorkerDied, WorkerLeft
from app.jobs.work import Tasks
from app.settings import Settings

Eventually = Callable[[Callable[[], Any], str], Any]


@pytest.fixture
def address(cluster: Any) -> str:
    return f"tcp://127.0.0.1:{cluster.ports['scheduler']}"


@contextmanager
def crew_at(address: str, eventually: Eventually, *, workers: int = 2, **options: Any) -> Iterator[ClusterCrew]:
    """A crew whose workers have joined."""
    crew = ClusterCrew(address, **{"megabytes": None, "task_seconds": 60.0, **options}, pause=0.2)
    crew.start(lambda: None)
    try:
        eventually(lambda: crew.size >= workers, f"{workers} workers have joined")
        yield crew
    finally:
        crew.stop()


def test_workers_need_no_settings_and_no_database(cluster: Any, address: str, eventually: Eventually) -> None:
    with crew_at(address, eventually) as crew:
        assert crew.submit(divmod, 17, 5).result(60) == (3, 2)
    for name in cluster.named("worker"):
        for process in cluster.part(name).children():
            assert not [key for key in process.environ() if key.startswith("CLEARLINES_")]
            maps = Path(f"/proc/{process.pid}/maps").read_text()
            assert "_psycopg" not in maps
            assert "_sqlite3" not in maps


def test_what_fails_and_what_dies_is_told_apart(address: str, eventually: Eventually) -> None:
    with crew_at(address, eventually) as crew:
        fine = [crew.submit(divmod, 17, 5) for _ in range(5)]
        dying = crew.submit(os._exit, 1)
        assert [each.result(60) for each in fine] == [(3, 2)] * 5
        assert type(dying.exception(60)) is WorkerDied
        with pytest.raises(ZeroDivisionError):
            crew.submit(divmod, 1, 0).result(60)
        eventually(lambda: crew.size == 2, "the nanny has started another worker")


def test_a_worker_that_holds_too_much_is_replaced_after_its_task(address: str, eventually: Eventually) -> None:
    with crew_at(address, eventually, megabytes=1) as crew:
        process_id = crew.submit(os.getpid).result(60)
        eventually(lambda: not psutil.pid_exists(process_id), "the worker has ended")
    with crew_at(address, eventually) as crew:  # the bound was that server's
        process_id = crew.submit(os.getpid).result(60)
        assert psutil.pid_exists(process_id)


def test_only_the_image_that_kills_its_worker_is_charged(small_yard: Any, address: str) -> None:
    small_yard.add("a", "deadly", "x", "y")
    run_id = small_yard.start()
    tasks = Tasks(detect=importlib.import_module("gated_tasks").deadly_detect)
    settings = small_yard.settings.model_copy(update={"cluster": address, "max_attempts": 2})
    Dispatcher(small_yard.database, small_yard.blobs, settings, small_yard.now, tasks=tasks).run_until_idle()
    rows = small_yard.rows(run_id)
    deadly = rows.pop("deadly")
    assert (deadly.status, deadly.attempts, deadly.segments) == ("failed", 2, ())
    assert deadly.error["code"] == "worker-died"
    assert {(row.status, row.attempts) for row in rows.values()} == {("done", 1)}


def test_an_image_that_hangs_is_given_up_alone(small_yard: Any, address: str, caplog: pytest.LogCaptureFixture) -> None:
    small_yard.add("held-a", "x", "y")
    run_id = small_yard.start()
    tasks = Tasks(detect=importlib.import_module("gated_tasks").gated_detect)
    settings = small_yard.settings.model_copy(update={"cluster": address, "max_attempts": 1, "task_seconds": 3.0})
    Dispatcher(small_yard.database, small_yard.blobs, settings, small_yard.now, tasks=tasks).run_until_idle()
    assert "it hung, and is restarted" in caplog.text
    rows = small_yard.rows(run_id)
    held = rows.pop("held-a")
    assert (held.status, held.attempts) == ("failed", 1)
    assert held.error["code"] == "worker-hung"
    assert "longer than 3 s" in held.error["message"]
    assert {(row.status, row.attempts) for row in rows.values()} == {("done", 1)}


def test_progress_comes_and_calling_off_goes_over_the_cluster(address: str, eventually: Eventually, gate: Path) -> None:
    with crew_at(address, eventually) as crew:
        notes = crew.notes.of("calibration-1-1")
        notes.prepare()
        task = importlib.import_module("gated_calibrations").gated_calibrate
        future = crew.submit(task, notes=notes.for_worker())
        told = eventually(notes.progress, "progress is told")
        assert told == {"stage": "waiting at the gate", "done": 1, "total": 3}
        notes.call_off()
        assert isinstance(future.exception(60), Cancelled)
        notes.discard()
        assert notes.progress() is None


def test_a_worker_of_another_version_is_refused(cluster: Any, address: str, eventually: Eventually) -> None:
    with crew_at(address, eventually) as crew:

        def refused() -> list[Any]:
            return [each for each in crew.status().workers if "0.0.1" in (each.reason or "")]

        (status,) = eventually(refused, "it is refused")
        assert not status.accepted
        assert status.reason.startswith("it runs clearlines 0.0.1")
        (process,) = cluster.part("old").children()
        assert process.pid not in {crew.submit(os.getpid).result(60) for _ in range(8)}
        assert crew.size == 2


def test_workers_that_are_busy_for_another_server_are_left_alone_until_they_are_free(
    address: str, eventually: Eventually, gate: Path
) -> None:
    task = importlib.import_module("gated_calibrations").gated_calibrate
    with crew_at(address, eventually) as first, crew_at(address, eventually, begin_seconds=0.3) as second:
        notes = first.notes.of("calibration-1-1")
        notes.prepare()
        held = first.submit(task, notes=notes.for_worker())
        eventually(held.running, "one worker is busy")
        mine = [second.submit(divmod, 17, 5) for _ in range(2)]
        left = [future.exception(60) for future in mine]
        assert [type(error) for error in left if error is not None] == [WorkerLeft]
        eventually(lambda: second.size == 1, "one of two is busy")
        assert BUSY in [worker.reason for worker in second.status().workers]
        assert [second.submit(divmod, 17, 5).result(60) for _ in range(3)] == [(3, 2)] * 3
        notes.call_off()
        assert isinstance(held.exception(60), Cancelled)
        eventually(lambda: second.size == 2, "the other one is free")


def test_without_a_scheduler_work_comes_back_and_the_status_tells(eventually: Eventually) -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        nobody = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
        crew = ClusterCrew(nobody, megabytes=None, task_seconds=60.0, pause=0.1)
        crew.start(lambda: None)
        try:
            assert isinstance(crew.submit(divmod, 17, 5).exception(60), WorkerLeft)
            eventually(lambda: "out of reach" in (crew.status().problem or ""), "the status tells")
            assert (crew.reachable, crew.size) == (False, 0)
        finally:
            crew.stop()


def test_settings_choose_the_crew(tmp_path: Path) -> None:
    assert crew_of(Settings(data_dir=tmp_path, workers=3), make_executor).status().kind == "pool"
    status = crew_of(Settings(data_dir=tmp_path, cluster="tcp://127.0.0.1:1"), make_executor).status()
    assert (status.kind, status.address, status.reachable) == ("cluster", "tcp://127.0.0.1:1", False)
    with pytest.raises(ClearLinesError, match="no address"):
        crew_of(Settings(data_dir=tmp_path, cluster="nowhere"), make_executor)


def test_a_worker_that_is_told_to_stop_costs_its_work_nothing(
    cluster: Any, address: str, eventually: Eventually
) -> None:
    """The last one: it leaves one worker."""
    with crew_at(address, eventually) as crew:
        process_id = crew.submit(os.getpid).result(60)
        processes = {name: cluster.part(name).children() for name in cluster.named("worker")}
        stopped = next(name for name, found in processes.items() if process_id in {each.pid for each in found})
        # the worker that waits longest is next: the other one, then this one
        held = [crew.submit(time.sleep, 60) for _ in range(2)]
        eventually(lambda: all(future.running() for future in held), "both are busy")
        cluster.part(stopped).tell(signal.SIGTERM)
        eventually(lambda: any(future.done() for future in held), "its work is given back at once")
        assert [type(future.exception()) for future in held if future.done()] == [WorkerLeft]
        eventually(lambda: crew.size == 1, "it isn't given any more")
