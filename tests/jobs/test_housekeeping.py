"""What was deleted goes for good by itself, once its time is over."""

from __future__ import annotations

import time
from datetime import datetime, timedelta
from pathlib import Path

from sqlalchemy import func, select

from app.db.models import Dataset
from app.db.session import Database
from app.jobs.housekeeping import Housekeeper
from app.services.datasets import create_dataset, delete_dataset
from app.storage import LocalBlobs

GRACE = timedelta(days=7)


def count_datasets(database: Database) -> int:
    with database.read() as session:
        return session.scalar(select(func.count(Dataset.id))) or 0


def test_the_grace_period_is_kept_and_then_over(sqlite_database: Database, tmp_path: Path, now: datetime) -> None:
    with sqlite_database.write() as session:
        for name, age in (("old", 8), ("recent", 6)):
            dataset = create_dataset(session, name, now - timedelta(days=10))
            delete_dataset(session, dataset.slug, now - timedelta(days=age), grace=GRACE)
    keeper = Housekeeper(sqlite_database, LocalBlobs(tmp_path / "blobs"), grace=GRACE, clock=lambda: now)
    keeper.start()
    deadline = time.monotonic() + 20
    while count_datasets(sqlite_database) > 1 and time.monotonic() < deadline:
        time.sleep(0.01)
    keeper.stop()
    assert count_datasets(sqlite_database) == 1


def test_it_can_be_stopped_before_it_began(sqlite_database: Database, tmp_path: Path, now: datetime) -> None:
    keeper = Housekeeper(sqlite_database, LocalBlobs(tmp_path / "blobs"), grace=GRACE, clock=lambda: now)
    keeper.stop()
    assert count_datasets(sqlite_database) == 0
