"""A dataset whose images were "detected" by hand: exact segments, no pipeline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any
from uuid import uuid4

import numpy as np
import pytest

from app.db.models import Blob, Camera, Dataset, Image, Review
from app.db.session import Database
from app.services.deciding import DecisionsStored, decide
from app.services.decision_batch import Wish
from app.services.detections import FoundCandidates, store_detection
from app.services.labelling import SegmentEntry, segments_of_image
from app.services.lens_estimates import finish_settled_runs
from app.services.run_progress import RunSummary, run_summary
from app.services.run_queue import Claim, claim_images
from app.services.runs import start_run
from app.vision.segments import Segments

GRACE = timedelta(days=7)


def horizontal_lines(*heights: float, length: float = 120.0, start: float = 10.0) -> Segments:
    """One straight segment of 1 px steps at each height."""
    x = np.arange(start, start + length + 1)
    polylines = [np.stack([x, np.full_like(x, height)], axis=1) for height in heights]
    return Segments.from_list(polylines, np.linspace(0.2, 0.9, len(heights)))


@dataclass(frozen=True)
class Bench:
    """A dataset with images, and shortcuts through what happens to it."""

    database: Database
    dataset_id: int
    images: tuple[int, ...]
    now: datetime

    def start(self, image_ids: Sequence[int] | None = None, **parameters: Any) -> int:
        with self.database.write() as session:
            dataset = session.get_one(Dataset, self.dataset_id)
            return start_run(session, dataset, parameters, image_ids, self.now).id

    def claim(self, limit: int = 100) -> list[Claim]:
        with self.database.write() as session:
            return claim_images(session, limit, self.now)

    def store_lines(self, claim: Claim, *heights: float) -> bool:
        return self.store(claim, horizontal_lines(*heights))

    def store(self, claim: Claim, segments: Segments) -> bool:
        found = FoundCandidates(segments, b"npz", 12.0)
        with self.database.write() as session:
            return store_detection(session, claim, found, self.now)

    def detect(self, *heights: float, **parameters: Any) -> int:
        """A whole run over all images, which finds lines at these heights in each."""
        run_id = self.start(**{"camera": "per-image", **parameters})
        for claim in self.claim():
            assert self.store_lines(claim, *heights)
        assert self.finish() == [run_id]
        return run_id

    def finish(self) -> list[int]:
        with self.database.write() as session:
            return finish_settled_runs(session, self.now)

    def decide(self, image_id: int, verdicts: dict[int, str], **fields: Any) -> DecisionsStored:
        group = str(uuid4())
        wishes = [Wish(str(uuid4()), group, segment, verdict, **fields) for segment, verdict in verdicts.items()]
        with self.database.write() as session:
            return decide(session, image_id, wishes, "owner", self.now)

    def segments(self, image_id: int) -> tuple[SegmentEntry, ...]:
        with self.database.read() as session:
            return segments_of_image(session, image_id).segments

    def by_height(self, image_id: int) -> dict[float, str]:
        """Current verdicts by the height of the line."""
        return {entry.box[1]: entry.verdict for entry in self.segments(image_id)}

    def at(self, image_id: int, height: float) -> int:
        """The id of the current segment at a height."""
        return next(entry.id for entry in self.segments(image_id) if entry.box[1] == height)

    def summary(self, run_id: int, later: timedelta = timedelta()) -> RunSummary:
        with self.database.read() as session:
            return run_summary(session, run_id, self.now + later, grace=GRACE)


@pytest.fixture
def bench(database: Database, now: datetime) -> Bench:
    """Two images of one camera, nothing done yet: on SQLite, then on PostgreSQL."""
    return make_bench(database, now)


@pytest.fixture
def small_bench(sqlite_database: Database, now: datetime) -> Bench:
    """The same on SQLite, for what doesn't depend on the kind of database."""
    return make_bench(sqlite_database, now)


def make_bench(database: Database, now: datetime) -> Bench:
    with database.write() as session:
        dataset = Dataset(slug="street", name="Street", created_at=now)
        session.add(dataset)
        session.flush()
        camera = Camera(dataset_id=dataset.id, name="front", width=200, height=160, created_at=now)
        images: list[Image] = []
        for number in range(2):
            sha256 = f"{number:064x}"
            session.add(Blob(sha256=sha256, size=1, media_type="image/png", created_at=now))
            session.flush()
            images.append(
                Image(
                    dataset_id=dataset.id,
                    name=f"frame-{number}",
                    file_name=f"frame-{number}.png",
                    sha256=sha256,
                    width=200,
                    height=160,
                    bits=8,
                    camera=camera,
                    created_at=now,
                    review=Review(status="open", updated_at=now),
                )
            )
        session.add_all(images)
        session.flush()
        return Bench(database, dataset.id, tuple(image.id for image in images), now)
