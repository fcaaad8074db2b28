"""Real processes, really killed: what is finished stays, what was running runs again, and nothing comes twice."""

from __future__ import annotations

import importlib
import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
from sqlalchemy import func, select

from app.db.locks import lock_for
from app.db.models import Image, RunImage, Segment
from app.jobs.work import Tasks

HERE = Path(__file__).parent
PROJECT = HERE.parents[1]


def tasks(name: str) -> Tasks:
    return Tasks(detect=getattr(importlib.import_module("gated_tasks"), name))


def is_alive(process_id: int) -> bool:
    try:
        return psutil.Process(process_id).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def assert_stored_once(yard, run_id: int) -> None:
    """Every image is done, and has the candidates that its one finished attempt found, numbered from 0."""
    rows = yard.rows(run_id)
    assert {row.status for row in rows.values()} == {"done"}
    with yard.database.read() as session:
        for row in rows.values():
            ordinals = session.scalars(
                select(Segment.ordinal).where(Segment.image_id == row.image_id).order_by(Segment.id)
            ).all()
            image = session.get_one(Image, row.image_id)
            assert ordinals == list(range(len(row.segments)))
            assert image.n_candidates == len(ordinals) > 0
            assert image.current_run_image_id == row.id
        assert session.scalar(select(func.count()).where(RunImage.run_id == run_id)) == len(rows)


def test_a_killed_worker_costs_no_image(small_yard, eventually) -> None:
    yard = small_yard
    yard.add("held-a", "held-b", "c", "d", "e", "f")
    run_id = yard.start()
    dispatcher = yard.dispatcher(tasks("gated_detect"))
    dispatcher.start()
    try:
        begun = eventually(lambda: len(yard.begun()) == 2 and yard.begun(), "two images are being worked on")
        os.kill(begun["held-a"], signal.SIGKILL)
        # a broken pool ends its other workers: before that the second image might be finished and the first one blamed
        eventually(lambda: not is_alive(begun["held-b"]), "the other worker ended too")
        yard.open_gate()
        eventually(lambda: yard.finished(run_id), "the run is finished")
    finally:
        dispatcher.stop()
    assert_stored_once(yard, run_id)
    assert yard.summary(run_id).status == "done"
    # nobody can tell which of them did it, so nobody is charged
    assert {row.attempts for row in yard.rows(run_id).values()} == {1}


def test_an_image_that_kills_its_worker_fails_alone(small_yard) -> None:
    yard = small_yard
    yard.add("a", "deadly", "x", "y")
    run_id = yard.start()
    yard.dispatcher(tasks("deadly_detect"), max_attempts=2).run_until_idle()
    rows = yard.rows(run_id)
    deadly = rows.pop("deadly")
    assert (deadly.status, deadly.attempts, deadly.segments) == ("failed", 2, ())
    assert deadly.error is not None
    assert deadly.error["code"] == "worker-died"
    assert "2 times" in deadly.error["message"]
    assert {(row.status, row.attempts) for row in rows.values()} == {("done", 1)}
    assert yard.summary(run_id).status == "done"


def run_server(yard, address: str) -> subprocess.Popen[bytes]:
    environment = {**os.environ, "PYTHONPATH": f"{PROJECT}{os.pathsep}{HERE}"}
    command = [sys.executable, str(HERE / "dispatcher_process.py"), address, str(yard.settings.data_dir)]
    return subprocess.Popen(command, env=environment)


def test_a_killed_server_goes_on_where_it_was(yard, database_url: str, eventually) -> None:
    yard.add("a", "b", "held-c", "held-d", "held-e")
    run_id = yard.start()
    server = run_server(yard, database_url)
    try:
        eventually(lambda: yard.done(run_id) == 2, "two images are finished")
        worker = eventually(lambda: yard.begun().get("held-c"), "another one is being worked on")
    finally:
        server.kill()
        server.wait()
    before = yard.rows(run_id)
    assert {name for name, row in before.items() if row.status == "done"} == {"a", "b"}
    assert before["held-c"].status == "running"
    eventually(lambda: not is_alive(worker), "the worker ends with its server")

    yard.open_gate()
    server = run_server(yard, database_url)
    try:
        eventually(lambda: yard.finished(run_id), "the run is finished")
    finally:
        server.send_signal(signal.SIGTERM)
        assert server.wait(60) == 0
    after = yard.rows(run_id)
    assert_stored_once(yard, run_id)
    for name in ("a", "b"):
        assert after[name] == before[name]
    assert {name: row.attempts for name, row in after.items()} == {
        name: 1 if before[name].status != "running" else 2 for name in after
    }
    assert [row.id for row in after.values()] == [row.id for row in before.values()]
    assert yard.summary(run_id).status == "done"


def test_a_stopped_dispatcher_puts_its_work_back_and_ends_its_workers(small_yard, eventually) -> None:
    yard = small_yard
    yard.add("held-a", "held-b", "held-c")
    run_id = yard.start()
    dispatcher = yard.dispatcher(tasks("gated_detect"))
    dispatcher.start()
    begun = eventually(lambda: len(yard.begun()) == 2 and yard.begun(), "two images are being worked on")
    dispatcher.stop()
    assert {(row.status, row.attempts) for row in yard.rows(run_id).values()} == {("queued", 0)}
    eventually(lambda: not any(is_alive(worker) for worker in begun.values()), "the workers have ended")
    free = lock_for(yard.database, "dispatcher")
    assert free.acquire()
    free.release()
