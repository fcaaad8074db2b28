"""What admins see of the server, and whether it says that it can work."""

from __future__ import annotations

import shutil
import threading
from collections.abc import Iterator
from dataclasses import replace
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import text

from app.api.readiness import Readiness
from app.db.models import Blob, Calibration, Camera, Dataset, Image, Run, RunImage
from app.db.session import Database
from app.errors import Unavailable
from app.services.failures import latest_failures
from app.services.queue_status import queue_standings
from app.storage import LocalBlobs
from tests.api.hosting.conftest import server_of, token_for
from tests.event_loop import run


def test_an_admin_sees_how_the_server_is_and_nobody_else_does(hosted: TestClient) -> None:
    assert hosted.get("/api/status").status_code == 401
    assert hosted.get("/api/status", headers=token_for(hosted, "mo", "maintainer")).status_code == 403
    status = hosted.get("/api/status", headers=token_for(hosted, "ada", "admin")).json()
    assert status["hosted"]
    assert [kind["kind"] for kind in status["queue"]] == ["images", "submissions", "calibrations", "webhooks"]
    assert status["crew"]["kind"] == "pool"
    assert status["dispatcher"]["here"]
    assert status["database"]["kind"] == "SQLite"
    assert status["database"]["bytes"] > 100_000
    assert {disk["name"]: disk["free"] > 0 for disk in status["disks"]} == {"data": True, "blobs": True}
    assert status["failures"] == []
    assert status["started_at"] <= status["now"]


def test_health_asks_nobody_and_readiness_everybody(hosted: TestClient, tmp_path: Path) -> None:
    assert hosted.get("/api/health").json()["status"] == "ok"
    assert hosted.get("/api/ready").status_code == 200
    server = server_of(hosted)
    gone = LocalBlobs(tmp_path / "blobs")
    shutil.rmtree(gone.root)
    (tmp_path / "blobs").write_text("no folder")
    hosted.app.state.server = replace(server, readiness=Readiness(server.database, gone))  # type: ignore[attr-defined]
    try:
        answer = hosted.get("/api/ready")
        assert answer.status_code == 503
        assert answer.headers["content-type"] == "application/problem+json"
        assert hosted.get("/api/health").status_code == 200
    finally:
        hosted.app.state.server = server  # type: ignore[attr-defined]


def test_health_asks_the_database_nothing(hosted: TestClient) -> None:
    server = server_of(hosted)
    hosted.app.state.server = replace(server, database=None, blobs=None)  # type: ignore[attr-defined]
    try:
        assert hosted.get("/api/health").status_code == 200
    finally:
        hosted.app.state.server = server  # type: ignore[attr-defined]


def test_tables_of_another_version_are_not_worked_with(database: Database, tmp_path: Path) -> None:
    blobs = LocalBlobs(tmp_path)
    run(Readiness(database, blobs).require())
    with database.write() as session:
        session.execute(text("UPDATE alembic_version SET version_num = '0001'"))
    try:
        with pytest.raises(Unavailable, match="another form"):
            run(Readiness(database, blobs).require())
    finally:
        back = {"head": Readiness(database, blobs).expected}
        with database.write() as session:
            session.execute(text("UPDATE alembic_version SET version_num = :head"), back)


class SlowBlobs(LocalBlobs):
    """A store that doesn't answer before it is told to."""

    def __init__(self, root: Path) -> None:
        super().__init__(root)
        self.asked = 0
        self.go_on = threading.Event()

    def check(self) -> None:
        self.asked += 1
        self.go_on.wait(30)


@pytest.fixture
def slow(tmp_path: Path) -> Iterator[SlowBlobs]:
    blobs = SlowBlobs(tmp_path)
    yield blobs
    blobs.go_on.set()


def test_a_store_that_hangs_is_not_waited_for(sqlite_database: Database, slow: SlowBlobs) -> None:
    readiness = Readiness(sqlite_database, slow, seconds=0.2)
    with pytest.raises(Unavailable, match="the blob store didn't answer"):
        run(readiness.require())


def test_whoever_asks_without_pause_asks_them_no_oftener(sqlite_database: Database, slow: SlowBlobs) -> None:
    slow.go_on.set()
    seconds = [0.0]
    readiness = Readiness(sqlite_database, slow, clock=lambda: seconds[0])

    async def ask() -> None:
        await readiness.require()
        await readiness.require()
        seconds[0] = 1.5
        await readiness.require()

    run(ask())
    assert slow.asked == 2


def add_work(database: Database, now: datetime) -> dict[str, int]:
    """Add a run of four images, one of each state, and calibrations that wait and that failed."""
    with database.write() as session:
        dataset = Dataset(name="Street", slug="street", created_at=now)
        session.add(dataset)
        session.flush()
        cameras = [Camera(dataset_id=dataset.id, name=name, width=10, height=10, created_at=now) for name in "ab"]
        session.add_all(cameras)
        run = Run(
            dataset_id=dataset.id,
            parameters={},
            code_version="1",
            status="running",
            created_at=now - timedelta(hours=2),
            started_at=now - timedelta(hours=1),
        )
        session.add(run)
        session.flush()
        for number, state in enumerate(("queued", "running", "failed", "done")):
            sha256 = f"{number:064x}"
            session.add(Blob(sha256=sha256, size=1, media_type="image/png", created_at=now))
            session.flush()
            image = Image(
                dataset_id=dataset.id,
                camera_id=cameras[0].id,
                name=f"{state}.png",
                file_name=f"{state}.png",
                sha256=sha256,
                width=10,
                height=10,
                bits=8,
                created_at=now,
            )
            session.add(image)
            session.flush()
            work = RunImage(run_id=run.id, image_id=image.id, status=state)
            if state == "failed":
                work.heartbeat_at, work.error = now - timedelta(minutes=3), {"code": "c", "message": "m"}
            session.add(work)
        for camera, state in zip(cameras, ("queued", "failed"), strict=True):
            session.add(
                Calibration(
                    camera_id=camera.id,
                    source="labels",
                    status=state,
                    parameters={},
                    code_version="1",
                    created_at=now - timedelta(minutes=5),
                    finished_at=now - timedelta(days=2) if state == "failed" else None,
                    error={"code": "c", "message": "too few lines"} if state == "failed" else None,
                )
            )
        return {"run": run.id, "camera": cameras[1].id}


def test_the_queue_is_told_by_the_rows(database: Database, now: datetime) -> None:
    ids = add_work(database, now)
    with database.read() as session:
        failures = latest_failures(session)
        images, submissions, calibrations, webhooks = queue_standings(session, failures, now)
    assert (images.waiting, images.running, images.failed, images.oldest_wait) == (1, 1, 1, 7200.0)
    assert (calibrations.waiting, calibrations.running, calibrations.oldest_wait) == (1, 0, 300.0)
    assert calibrations.failed == 0  # that was the day before yesterday
    assert (submissions.waiting, submissions.oldest_wait, webhooks.waiting) == (0, None, 0)
    first, second = failures
    assert (first.kind, first.what, first.page) == ("images", "failed.png", f"/runs/{ids['run']}")
    assert first.at == now - timedelta(minutes=3)
    assert (second.kind, second.page) == ("calibrations", f"/cameras/{ids['camera']}")
    assert second.error["message"] == "too few lines"
