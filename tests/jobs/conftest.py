"""A yard to run real dispatchers in: small drawn images, a database, blobs, and gates that hold tasks up."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from sqlalchemy import select

from app.db.models import Blob, Camera, Dataset, Image, Review, Run, RunImage, Segment
from app.db.session import Database
from app.jobs.dispatcher import Dispatcher
from app.jobs.work import Tasks
from app.services.run_progress import RunSummary, run_summary
from app.services.runs import start_run
from app.settings import Settings
from app.storage import LocalBlobs

WIDTH, HEIGHT = 160, 120
DEADLINE = 90.0  # s


def drawn_image(seed: int) -> bytes:
    """A small grey PNG with a few long edges and a little noise."""
    random = np.random.default_rng(seed)
    pixels = np.full((HEIGHT, WIDTH), 60, np.uint8)
    for height in (25, 55, 85):
        shift = int(random.integers(-5, 6))
        corners = np.array([[8, height], [150, height + shift], [150, height + shift + 14], [8, height + 14]], np.int32)
        cv2.fillPoly(pixels, [corners], 190)
    noise = random.normal(0, 2, pixels.shape)
    done, encoded = cv2.imencode(".png", np.clip(pixels + noise, 0, 255).astype(np.uint8))
    assert done
    return encoded.tobytes()


def utc_now() -> datetime:
    return datetime.now(UTC)


@dataclass(frozen=True)
class Row:
    """The work on one image as the database has it."""

    id: int
    image_id: int
    name: str
    status: str
    attempts: int
    error: dict[str, Any] | None
    segments: tuple[int, ...] = field(default=())


@dataclass(frozen=True)
class Yard:
    """Where dispatchers work."""

    database: Database
    blobs: LocalBlobs
    settings: Settings
    gate: Path
    dataset_id: int

    def add(self, *names: str, content: bytes | None = None) -> None:
        now = utc_now()
        with self.database.write() as session:
            camera = session.scalars(select(Camera)).one()
            for name in names:
                data = content or drawn_image(sum(name.encode()))
                sha256 = self.blobs.put(data)
                session.add(Blob(sha256=sha256, size=len(data), media_type="image/png", created_at=now))
                session.flush()
                session.add(
                    Image(
                        dataset_id=self.dataset_id,
                        name=name,
                        file_name=f"{name}.png",
                        sha256=sha256,
                        width=WIDTH,
                        height=HEIGHT,
                        bits=8,
                        camera=camera,
                        created_at=now,
                        review=Review(status="open", updated_at=now),
                    )
                )

    def mend(self, name: str) -> None:
        """Put a good image in the place of a broken one."""
        data = drawn_image(1)
        sha256 = self.blobs.put(data)
        with self.database.write() as session:
            session.add(Blob(sha256=sha256, size=len(data), media_type="image/png", created_at=utc_now()))
            session.flush()
            session.scalars(select(Image).where(Image.name == name)).one().sha256 = sha256

    def now(self) -> datetime:
        return utc_now()

    def start(self, **parameters: Any) -> int:
        with self.database.write() as session:
            dataset = session.get_one(Dataset, self.dataset_id)
            return start_run(session, dataset, {"min_length": 40, **parameters}, None, utc_now()).id

    def dispatcher(self, tasks: Tasks | None = None, **options: Any) -> Dispatcher:
        database = options.pop("database", self.database)
        settings = self.settings.model_copy(update={"max_attempts": options.pop("max_attempts", 3)})
        return Dispatcher(database, self.blobs, settings, utc_now, tasks=tasks, **options)

    def rows(self, run_id: int) -> dict[str, Row]:
        """The run's work by image name, with the ids of the segments that it stored."""
        with self.database.read() as session:
            found: dict[str, Row] = {}
            query = select(RunImage, Image.name).join(Image, Image.id == RunImage.image_id)
            for work, name in session.execute(query.where(RunImage.run_id == run_id).order_by(RunImage.id)):
                ids = session.scalars(
                    select(Segment.id).where(Segment.run_image_id == work.id).order_by(Segment.id)
                ).all()
                found[name] = Row(work.id, work.image_id, name, work.status, work.attempts, work.error, tuple(ids))
            return found

    def summary(self, run_id: int) -> RunSummary:
        with self.database.read() as session:
            return run_summary(session, run_id, utc_now(), grace=timedelta(days=7))

    def finished(self, run_id: int) -> bool:
        with self.database.read() as session:
            return session.scalar(select(Run.status).where(Run.id == run_id)) not in ("queued", "running")

    def done(self, run_id: int) -> int:
        """How many images are done."""
        with self.database.read() as session:
            return len(
                session.scalars(select(RunImage.id).where(RunImage.run_id == run_id, RunImage.status == "done")).all()
            )

    def begun(self) -> dict[str, int]:
        """Process ids of the tasks that wait at the gate, by image name."""
        found = {}
        for path in self.gate.glob("*.pid"):
            text = path.read_text()
            if text:
                found[path.stem] = int(text)
        return found

    def open_gate(self, name: str | None = None) -> None:
        """Let the image of that name go on, or all."""
        (self.gate / ("open" if name is None else f"{name}.open")).touch()


def make_yard(database: Database, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Yard:
    gate = folder / "gate"
    gate.mkdir()
    monkeypatch.setenv("TEST_GATE", str(gate))  # workers inherit it
    monkeypatch.syspath_prepend(str(Path(__file__).parent))  # workers find the tasks of this folder by name
    now = utc_now()
    with database.write() as session:
        dataset = Dataset(slug="yard", name="Yard", created_at=now)
        session.add(dataset)
        session.flush()
        session.add(Camera(dataset_id=dataset.id, name="front", width=WIDTH, height=HEIGHT, created_at=now))
        dataset_id = dataset.id
    settings = Settings(data_dir=folder, workers=2, heartbeat_seconds=0.5, stale_seconds=60, max_attempts=3)
    return Yard(database, LocalBlobs(folder / "blobs"), settings, gate, dataset_id)


@pytest.fixture
def eventually() -> Callable[[Callable[[], Any], str], Any]:
    """Waits until a condition holds, up to a deadline, and returns its value."""

    def wait(condition: Callable[[], Any], what: str) -> Any:
        deadline = time.monotonic() + DEADLINE
        while not (value := condition()):
            assert time.monotonic() < deadline, f"never happened: {what}"
            time.sleep(0.1)
        return value

    return wait


@pytest.fixture
def yard(database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Yard:
    """On SQLite, then on PostgreSQL."""
    return make_yard(database, tmp_path, monkeypatch)


@pytest.fixture
def small_yard(sqlite_database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Yard:
    """On SQLite alone."""
    return make_yard(sqlite_database, tmp_path, monkeypatch)
