"""What second reviewers kept, as a row of the board without a rank."""

from __future__ import annotations

from pathlib import Path

import pytest
from sqlalchemy import select

from app.db.models import Event, Method, Submission
from app.errors import Conflict
from app.formats.npz import read_npz_set
from app.services.ceilings import add_ceiling
from app.services.splits import SplitPlan, create_split
from app.storage import LocalBlobs


@pytest.fixture
def blobs(tmp_path: Path) -> LocalBlobs:
    return LocalBlobs(tmp_path / "blobs")


def freeze(office, blobs: LocalBlobs) -> None:
    with office.database.write() as session:
        create_split(session, blobs, "street", SplitPlan("Test"), office.now)


def test_the_ceiling_is_what_second_reviewers_kept(office, blobs) -> None:
    first, second, _ = office.images
    office.finish(first, "kkrr", "Mara")
    office.finish(second, "krrr", "Jon")
    office.second(first, "krka", "Jon")
    office.second(second, "rrrr", "Mara")
    freeze(office, blobs)
    numbers = [add_ceiling(office.database, blobs, "test", office.now, person="Ann") for _ in range(2)]
    assert numbers[0] == numbers[1]
    with office.database.read() as session:
        submission = session.scalars(select(Submission)).one()
        method = session.get_one(Method, submission.method_id)
        event = session.scalars(select(Event).where(Event.kind == "split.ceiling")).first()
    assert (method.kind, submission.status, submission.label, submission.person) == (
        "ceiling",
        "queued",
        "2 people",
        None,
    )
    assert event is not None
    assert event.person == "Ann"
    stored = read_npz_set(blobs.read(submission.segments_sha256))
    assert {name: [len(line) for line in each.segments] for name, each in stored.items()} == {
        "frame-0": [31, 151],
        "frame-1": [],
    }


def test_images_that_were_labelled_once_are_named(small_office, blobs) -> None:
    office = small_office
    first, second, _ = office.images
    for image_id in (first, second):
        office.finish(image_id, "krrr", "Mara")
    office.second(first, "krrr", "Jon")
    office.second(second, "krrr", "Jon", done=False)
    freeze(office, blobs)
    with pytest.raises(Conflict, match="frame-1") as caught:
        add_ceiling(office.database, blobs, "test", office.now)
    assert caught.value.details == {"images": ["frame-1"]}
