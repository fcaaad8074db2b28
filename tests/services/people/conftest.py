"""Images with candidates of exact lines, and people who decide on them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any
from uuid import uuid4

import numpy as np
import pytest
from sqlalchemy import select

from app.db.models import Blob, Camera, Dataset, Image, Review, Segment
from app.db.session import Database
from app.formats.labelled import LabelledSegments
from app.services.candidates import refresh_counts
from app.services.deciding import DecisionsStored, decide
from app.services.decision_batch import Wish
from app.services.labels import segment_rows
from app.services.reviews import set_review
from app.services.second_reviews import own_second_review, set_second_review, start_second_review
from app.services.second_verdicts import decide_second
from app.vision.segments import Segments

LENGTHS = (30, 80, 150, 300)


def lines(lengths: Sequence[float] = LENGTHS, *, height: float = 10.0) -> Segments:
    """Horizontal lines of these lengths, px, 20 px below one another."""
    polylines = []
    for row, length in enumerate(lengths):
        x = np.arange(5.0, 5.0 + length + 1)
        polylines.append(np.stack([x, np.full_like(x, height + 20 * row)], axis=1))
    return Segments.from_list(polylines, np.linspace(0.2, 0.8, len(lengths)))


@dataclass(frozen=True)
class Office:
    """A dataset, and short ways to what people do with it.

    Attributes:
        segments: Ids of candidates by image id.
    """

    database: Database
    dataset_id: int
    images: tuple[int, ...]
    now: datetime
    segments: dict[int, list[int]] = field(default_factory=dict)

    @property
    def first(self) -> int:
        return self.images[0]

    @staticmethod
    def wish(segment_id: int, verdict: str = "keep", **fields: Any) -> Wish:
        """A decision by itself."""
        return Wish(str(uuid4()), fields.pop("group_id", str(uuid4())), segment_id, verdict, **fields)

    def dataset(self, session: Any) -> Dataset:
        return session.get_one(Dataset, self.dataset_id)

    def decide(
        self,
        image_id: int,
        verdicts: Mapping[int, str] | Sequence[Wish],
        person: str = "Mara",
        *,
        seen: int | None = None,
        minutes: float = 0,
        **fields: Any,
    ) -> DecisionsStored:
        group = str(uuid4())
        given = (
            [self.wish(segment, verdict, group_id=group, **fields) for segment, verdict in verdicts.items()]
            if isinstance(verdicts, Mapping)
            else verdicts
        )
        with self.database.write() as session:
            return decide(session, image_id, given, person, self.now + timedelta(minutes=minutes), seen=seen)

    def finish(self, image_id: int, verdicts: str, person: str = "Mara") -> None:
        """Give the image's candidates verdicts by their first letters, and call it done."""
        self.decide(image_id, dict(zip(self.segments[image_id], map(spelled, verdicts), strict=True)), person)
        with self.database.write() as session:
            set_review(session, image_id, "done", now=self.now, person=person)

    def second(self, image_id: int, verdicts: str, person: str = "Jon", *, done: bool = True) -> int:
        """A whole second review."""
        with self.database.write() as session:
            number = start_second_review(session, image_id, person, self.now).id
            review, _ = own_second_review(session, number, person, lock=True)
            given = zip(self.segments[image_id], map(spelled, verdicts), strict=False)
            decide_second(session, review, [self.wish(*entry) for entry in given], person, self.now)
            if done:
                set_second_review(session, number, "done", person, self.now, allow_undecided=True)
        return number


def spelled(letter: str) -> str:
    return {"k": "keep", "r": "reject", "a": "ambiguous", "u": "undecided"}[letter]


@pytest.fixture
def office(database: Database, now: datetime) -> Office:
    """On SQLite, then on PostgreSQL."""
    return make_office(database, now)


@pytest.fixture
def small_office(sqlite_database: Database, now: datetime) -> Office:
    """On SQLite, for what doesn't depend on the kind of database."""
    return make_office(sqlite_database, now)


def make_office(database: Database, now: datetime) -> Office:
    """Three images of four candidates each; their hashes begin with 0, 5 and a."""
    with database.write() as session:
        dataset = Dataset(slug="street", name="Street", created_at=now)
        session.add(dataset)
        session.flush()
        camera = Camera(dataset_id=dataset.id, name="front", width=400, height=160, created_at=now)
        images: list[Image] = []
        for number, digit in enumerate("05a"):
            sha256 = digit * 64
            session.add(Blob(sha256=sha256, size=1, media_type="image/png", created_at=now))
            session.flush()
            image = Image(
                dataset_id=dataset.id,
                name=f"frame-{number}",
                file_name=f"frame-{number}.png",
                sha256=sha256,
                width=400,
                height=160,
                bits=8,
                camera=camera,
                created_at=now,
                review=Review(status="open", updated_at=now),
            )
            session.add(image)
            session.flush()
            rows = segment_rows(image.id, LabelledSegments(lines()))
            for row in rows:
                row.origin = "pipeline"
            session.add_all(rows)
            images.append(image)
        ids = [image.id for image in images]
        refresh_counts(session, ids)
        segments = {
            image_id: list(
                session.scalars(select(Segment.id).where(Segment.image_id == image_id).order_by(Segment.ordinal))
            )
            for image_id in ids
        }
        return Office(database, dataset.id, tuple(ids), now, segments)
