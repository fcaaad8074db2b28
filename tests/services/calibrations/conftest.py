"""A camera with bent lines in its images, and ways to decide on them and to calibrate."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any
from uuid import uuid4

import numpy as np
import pytest

from app.calibration.calibrate import CalibrationImage, calibrate
from app.calibration.lens import CameraLens
from app.calibration.line_table import CalibrationLines, packed_lines
from app.calibration.work_order import CalibrationFound
from app.db.models import Blob, Calibration, Camera, Dataset, Decision, Image, Review, Segment, SegmentState
from app.db.session import Database
from app.services.calibration_queue import CalibrationClaim, claim_calibration, store_calibration
from app.services.calibrations import start_calibration
from app.services.candidates import refresh_counts
from app.vision.segments import Segments

SIZE = (320, 240)
LENS = CameraLens("brown", *SIZE, (0.15, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


def bent_lines(seed: int, count: int) -> list[np.ndarray]:
    """Straight lines as the lens shows them, float32 ``(40, 2)`` px each."""
    random = np.random.default_rng(seed)
    lines: list[np.ndarray] = []
    while len(lines) < count:
        ends = random.uniform((0, 0), SIZE, (2, 2))
        if np.hypot(*(ends[0] - ends[1])) < 80:
            continue
        corrected = LENS.undistort(ends)
        points = LENS.distort(np.linspace(corrected[0], corrected[1], 40))
        lines.append((points + random.normal(0, 0.05, points.shape)).astype(np.float32))
    return lines


@pytest.fixture(scope="session")
def result() -> dict[str, Any]:
    """What a calibration from two images gives."""
    images = [CalibrationImage(f"a/{seed}", Segments.from_list(bent_lines(seed, 12))) for seed in (0, 1)]
    return calibrate(images, SIZE, family="brown").as_dict()


@dataclass
class Bench:
    """A dataset `bench` with one camera.

    Attributes:
        result: Of some calibration, to be stored.
    """

    database: Database
    now: datetime
    result: dict[str, Any]
    camera_id: int = 0

    def image(self, name: str, verdicts: Sequence[str], **fields: Any) -> int:
        """Add an image with as many candidates, each decided on as it says; ``undecided`` ones aren't."""
        with self.database.write() as session:
            camera = session.get_one(Camera, self.camera_id)
            sha256 = hashlib.sha256(name.encode()).hexdigest()
            session.add(Blob(sha256=sha256, size=1, media_type="image/png", created_at=self.now))
            session.flush()
            image = Image(
                dataset_id=camera.dataset_id,
                name=name,
                file_name=f"{name}.png",
                sha256=sha256,
                width=SIZE[0],
                height=SIZE[1],
                bits=8,
                camera=camera,
                created_at=self.now,
                review=Review(status="open", updated_at=self.now),
            )
            session.add(image)
            session.flush()
            for ordinal, points in enumerate(bent_lines(image.id, len(verdicts))):
                low, high = points.min(0), points.max(0)
                session.add(
                    Segment(
                        image_id=image.id,
                        ordinal=ordinal,
                        n_points=len(points),
                        points=points.astype("<f4").tobytes(),
                        x0=float(low[0]),
                        y0=float(low[1]),
                        x1=float(high[0]),
                        y1=float(high[1]),
                        length=float(np.hypot(*(points[-1] - points[0]))),
                        origin="pipeline",
                        **fields,
                    )
                )
            session.flush()
            refresh_counts(session, [image.id])
            image_id = image.id
        segments = self.segments(image_id)
        for segment, verdict in zip(segments, verdicts, strict=True):
            if verdict != "undecided":
                self.decide(segment, verdict)
        return image_id

    def segments(self, image_id: int) -> list[int]:
        with self.database.read() as session:
            return [row.id for row in session.query(Segment).filter_by(image_id=image_id).order_by(Segment.ordinal)]

    def decide(self, segment_id: int, verdict: str) -> None:
        with self.database.write() as session:
            segment = session.get_one(Segment, segment_id)
            state = session.get(SegmentState, segment_id)
            decision = Decision(
                image_id=segment.image_id,
                segment_id=segment_id,
                verdict=verdict,
                previous=state.verdict if state else "undecided",
                kind="judge",
                client_id=str(uuid4()),
                group_id=str(uuid4()),
                created_at=self.now,
            )
            session.add(decision)
            session.flush()
            if state is None:
                session.add(SegmentState(segment_id=segment_id, verdict=verdict, decision_id=decision.id))
            else:
                state.verdict, state.decision_id = verdict, decision.id
            refresh_counts(session, [segment.image_id])

    def start(self, source: str = "labels", family: str | None = None) -> int:
        with self.database.write() as session:
            camera = session.get_one(Camera, self.camera_id)
            return start_calibration(session, camera, source, family, self.now, person="ada").id

    def claim(self) -> CalibrationClaim:
        with self.database.write() as session:
            claim = claim_calibration(session, self.now)
        assert claim is not None
        return claim

    def found(self, image_ids: Sequence[int], **advice: Any) -> CalibrationFound:
        """What a worker might have made of these images: the first line of each is off by as many px as its place."""
        segments = [(image_id, segment) for image_id in image_ids for segment in self.segments(image_id)]
        count = len(segments)
        lines = CalibrationLines(
            np.array([image_id for image_id, _ in segments], np.int64),
            np.array([segment for _, segment in segments], np.int64),
            np.arange(count, dtype=np.float32),
            np.arange(count, dtype=np.float32) + 1,
            np.arange(count, 0, -1, dtype=np.float32),
            np.ones(count, np.float32),
        )
        with self.database.read() as session:
            newest = session.query(Decision).order_by(Decision.id.desc()).first()
        parameters = {
            "images": list(image_ids),
            "segments": count,
            "newest_decision": newest.id if newest else 0,
        }
        entries = [{**self.result["images"][0], "name": f"then {image_id}"} for image_id in image_ids]
        result = {**self.result, "images": entries}
        return CalibrationFound(parameters, result, packed_lines(lines), {"cells": [], "images": [], **advice})

    def calibrated(self, image_ids: Sequence[int], **advice: Any) -> int:
        """Start and finish a calibration."""
        calibration_id = self.start()
        with self.database.write() as session:
            claim = claim_calibration(session, self.now)
            assert claim is not None
            assert store_calibration(session, claim, self.found(image_ids, **advice), self.now)
        return calibration_id

    def row(self, calibration_id: int) -> Calibration:
        with self.database.read() as session:
            return session.get_one(Calibration, calibration_id)


def make_bench(database: Database, now: datetime, result: dict[str, Any]) -> Bench:
    bench = Bench(database, now, result)
    with database.write() as session:
        dataset = Dataset(slug="bench", name="Bench", created_at=now)
        session.add(dataset)
        session.flush()
        camera = Camera(dataset_id=dataset.id, name="front", width=SIZE[0], height=SIZE[1], created_at=now)
        session.add(camera)
        session.flush()
        bench.camera_id = camera.id
    return bench


@pytest.fixture
def bench(database: Database, now: datetime, result: dict[str, Any]) -> Bench:
    """On SQLite, then on PostgreSQL."""
    return make_bench(database, now, result)


@pytest.fixture
def small_bench(sqlite_database: Database, now: datetime, result: dict[str, Any]) -> Bench:
    """On SQLite alone."""
    return make_bench(sqlite_database, now, result)
