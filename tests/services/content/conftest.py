"""A place to work in: a database, a blob store, and short ways to fill them."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import cv2
import numpy as np
import pytest
from sqlalchemy.orm import Session

from app.db.models import CameraEstimate, Dataset, Image, Run, RunImage, Segment, SegmentState
from app.db.session import Database
from app.formats.labelled import LabelledSegments
from app.services.candidates import refresh_counts
from app.services.datasets import create_dataset
from app.services.image_adding import add_image, receive_image
from app.services.imports import Importer
from app.services.labels import ImageLabels, import_labels, segment_rows
from app.storage import LocalBlobs
from app.vision.segments import Segments


def make_png(seed: int, width: int = 64, height: int = 48) -> bytes:
    """Grey pixels that differ from one seed to the next."""
    pixels = np.full((height, width), 40, np.uint8)
    pixels.reshape(-1)[:4] = np.frombuffer(np.uint32(seed).tobytes(), np.uint8)
    return cv2.imencode(".png", pixels)[1].tobytes()


def make_segments(count: int) -> Segments:
    """Horizontal lines of 30 points, 10 px apart."""
    x = np.arange(30, dtype=np.float32)
    return Segments.from_list([np.stack([x, np.full(30, 10 * row)], axis=1) for row in range(count)])


@dataclass(frozen=True)
class Place:
    database: Database
    blobs: LocalBlobs
    now: datetime

    def dataset(self, name: str = "Street") -> str:
        with self.database.write() as session:
            return create_dataset(session, name, self.now).slug

    def find(self, session: Session, slug: str) -> Dataset:
        return session.query(Dataset).filter_by(slug=slug).one()

    def image(
        self, slug: str, name: str, *, size: tuple[int, int] = (64, 48), seed: int | None = None, **fields: str
    ) -> int:
        data = make_png(zlib.crc32(name.encode()) if seed is None else seed, *size)
        received = receive_image(self.blobs, f"{name}.png", data, max_pixels=10**6)
        with self.database.write() as session:
            dataset = self.find(session, slug)
            return add_image(session, self.blobs, dataset, received, self.now, **fields).image.id

    def images(self, slug: str, *names: str) -> list[int]:
        return [self.image(slug, name) for name in names]

    def label(self, image_id: int, verdicts: Sequence[str]) -> list[int]:
        """Import segments of these verdicts; an image without undecided ones is done then."""
        labelled = LabelledSegments(make_segments(len(verdicts)), verdicts=tuple(verdicts))
        with self.database.write() as session:
            image = session.get_one(Image, image_id)
            import_labels(session, image, ImageLabels(labelled), self.now, newly_added=True)
            return [row.id for row in session.query(Segment).filter_by(image_id=image_id).order_by(Segment.ordinal)]

    def run(self, image_ids: Sequence[int], *, status: str = "done", candidates: int = 0) -> int:
        """Store a run over the images as if it had found that many candidates in each."""
        with self.database.write() as session:
            first = session.get_one(Image, image_ids[0])
            run = Run(dataset_id=first.dataset_id, parameters={}, code_version="1", status=status, created_at=self.now)
            session.add(run)
            session.flush()
            for image_id in image_ids:
                work = RunImage(run_id=run.id, image_id=image_id, status=status, attempts=1)
                work.error = {"code": "invalid-image", "message": "broken"} if status == "failed" else None
                session.add(work)
                session.flush()
                rows = segment_rows(image_id, LabelledSegments(make_segments(candidates)))
                for row in rows:
                    row.origin, row.run_image_id = "pipeline", work.id
                session.add_all(rows)
                if status == "done":
                    session.get_one(Image, image_id).current_run_image_id = work.id
            refresh_counts(session, list(image_ids))
            return run.id

    def estimate(self, run_id: int, camera_id: int, k1: float) -> None:
        with self.database.write() as session:
            session.add(
                CameraEstimate(
                    run_id=run_id, camera_id=camera_id, distortion={"k": [k1]}, accepted=True, created_at=self.now
                )
            )

    def verdict_of(self, segment_id: int) -> str:
        with self.database.read() as session:
            state = session.get(SegmentState, segment_id)
            return state.verdict if state else "undecided"

    def importer(self, slug: str, **fields: object) -> Importer:
        with self.database.read() as session:
            dataset = self.find(session, slug)
        return Importer(self.database, self.blobs, dataset.id, self.now, **fields)  # type: ignore[arg-type]


@pytest.fixture
def png() -> Callable[..., bytes]:
    return make_png


@pytest.fixture
def segments() -> Callable[[int], Segments]:
    return make_segments


@pytest.fixture
def blobs(tmp_path: Path) -> LocalBlobs:
    return LocalBlobs(tmp_path / "blobs")


@pytest.fixture
def place(database: Database, blobs: LocalBlobs, now: datetime) -> Place:
    """A place on each kind of database."""
    return Place(database, blobs, now)


@pytest.fixture
def sqlite_place(sqlite_database: Database, blobs: LocalBlobs, now: datetime) -> Place:
    """A place on SQLite alone, for tests to which the kind of database doesn't matter."""
    return Place(sqlite_database, blobs, now)
