"""Changes of a run's work beside a result that is being stored: images are held before the work on them, by everybody.

Otherwise PostgreSQL finds two who wait for each other, and ends one of them.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from sqlalchemy import select, text
from sqlalchemy.orm import Session

from app.db.models import Image, RunImage
from app.services.detections import FoundCandidates, store_detection
from app.services.run_queue import Claim, fail_image, put_back, release_lost
from app.services.runs import cancel_run
from app.vision.segments import Segments

WAITING = "SELECT count(*) FROM pg_stat_activity WHERE wait_event_type = 'Lock' AND datname = current_database()"
PATIENCE = 30.0  # s
ERROR = {"code": "invalid-image", "message": "broken"}


@pytest.fixture
def claims(bench) -> list[Claim]:
    """Two images of a run, in workers' hands."""
    if bench.database.is_sqlite:
        pytest.skip("SQLite has one writer")
    bench.start(camera="per-image")
    return bench.claim()


def test_a_run_is_cancelled(bench, claims) -> None:
    run_id = run_of(bench, claims[0])
    assert is_stored_beside(bench, claims[0], lambda session: cancel_run(session, run_id, bench.now))
    assert states(bench) == [("done", "done"), ("cancelled", "none")]


def test_lost_work_is_queued_again(bench, claims) -> None:
    assert is_stored_beside(bench, claims[0], lambda session: release_lost(session, max_attempts=3))
    assert states(bench) == [("done", "done"), ("queued", "queued")]


def test_work_is_put_back(bench, claims) -> None:
    assert is_stored_beside(bench, claims[0], lambda session: put_back(session, claims))
    assert states(bench) == [("done", "done"), ("queued", "queued")]


def test_an_image_fails(bench, claims) -> None:
    assert is_stored_beside(bench, claims[0], lambda session: fail_image(session, claims[0], ERROR, bench.now))
    assert states(bench) == [("done", "done"), ("running", "running")]


def is_stored_beside(bench, claim: Claim, change: Callable[[Session], Any]) -> bool:
    """Make a change while a result is stored whose image is held already, and tell whether the result was."""
    row = np.stack([np.arange(10.0, 130.0), np.full(120, 20.0)], axis=1).astype(np.float32)
    found = FoundCandidates(Segments.from_list([row]), None, 12.0)

    def make() -> None:
        with bench.database.write() as session:
            change(session)

    with ThreadPoolExecutor(1) as pool:
        with bench.database.write() as storing:
            storing.get_one(Image, claim.image_id, with_for_update=True)
            changed = pool.submit(make)
            wait_until_it_waits(bench, changed)
            is_stored = store_detection(storing, claim, found, bench.now)
        changed.result()
    return is_stored


def wait_until_it_waits(bench, changed: Future[None]) -> None:
    deadline = time.monotonic() + PATIENCE
    with bench.database.engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        while not connection.scalar(text(WAITING)):
            assert time.monotonic() < deadline
            assert not changed.done(), changed.exception()
            time.sleep(0.01)


def run_of(bench, claim: Claim) -> int:
    with bench.database.read() as session:
        return session.get_one(RunImage, claim.run_image_id).run_id


def states(bench) -> list[tuple[str, str]]:
    """Return the state of each image's work, and the copy of it in the image's row."""
    with bench.database.read() as session:
        query = select(RunImage.status, Image.prelabel).join(Image, Image.id == RunImage.image_id)
        return [(status, copy) for status, copy in session.execute(query.order_by(RunImage.id))]
