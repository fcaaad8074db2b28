from __future__ import annotations

import os
from datetime import datetime, timedelta

import pytest

from app.db.models import Base, Blob, Dataset, Decision, Image, Run, Segment, SegmentState
from app.errors import Unavailable
from app.services.candidates import refresh_counts
from app.services.datasets import delete_dataset, restore_dataset
from app.services.image_adding import add_image, receive_image
from app.services.images import delete_images
from app.services.purging import Purged, purge

GRACE = timedelta(days=7)


def stored(place) -> set[str]:
    return {path.name for path in place.blobs.root.glob("??/??/*")}


def purge_after(place, later: timedelta) -> Purged:
    return purge(place.database, place.blobs, place.now + later, grace=GRACE)


def counts(place, *tables) -> list[int]:
    with place.database.read() as session:
        return [session.query(table).count() for table in tables]


def set_time_of_files(place, when: datetime) -> None:
    for path in place.blobs.root.glob("??/??/*"):
        os.utime(path, (when.timestamp(), when.timestamp()))


def test_nothing_to_purge(place) -> None:
    place.label(place.image(place.dataset(), "a"), ["keep"])
    assert purge_after(place, timedelta(days=999)) == Purged(0, 0, 0, 0)
    assert counts(place, Image, Segment, Blob) == [1, 1, 1]


def test_images_go_after_the_grace_period_with_all_that_is_theirs(place) -> None:
    slug = place.dataset()
    first, second = place.images(slug, "a", "b")
    place.label(first, ["keep", "reject"])
    place.run([first, second], candidates=2)
    with place.database.write() as session:
        delete_images(session, place.find(session, slug), [first], place.now, grace=GRACE)
        kept = session.get_one(Image, second).sha256
    assert purge_after(place, GRACE - timedelta(seconds=1)) == Purged(0, 0, 0, 0)
    assert purge_after(place, GRACE) == Purged(0, 1, 0, 1)
    assert stored(place) == {kept}
    assert counts(place, Image, Blob, Segment, SegmentState, Decision) == [1, 1, 2, 0, 0]


def test_a_blob_that_another_image_names_stays(place) -> None:
    first, second = place.dataset("One"), place.dataset("Two")
    place.image(first, "a", seed=1)
    place.image(second, "b", seed=1)
    with place.database.write() as session:
        delete_dataset(session, first, place.now, grace=GRACE)
    assert purge_after(place, GRACE) == Purged(1, 1, 0, 0)
    assert len(stored(place)) == 1


def test_a_dataset_goes_with_everything_but_its_audit(place) -> None:
    slug = place.dataset()
    ids = place.images(slug, *(f"{number:02}" for number in range(5)))
    place.label(ids[0], ["keep"])
    place.run(ids, candidates=1)
    with place.database.write() as session:
        delete_dataset(session, slug, place.now, grace=GRACE)
    assert purge_after(place, GRACE) == Purged(1, 5, 0, 5)
    left = {table.name: count for table, count in rows(place).items() if count}
    assert left == {"events": 2, "installations": 1}
    assert stored(place) == set()


def rows(place) -> dict:
    with place.database.read() as session:
        return {table: session.query(table).count() for table in Base.metadata.sorted_tables}


def test_what_was_restored_stays(place) -> None:
    slug = place.dataset()
    place.image(slug, "a")
    with place.database.write() as session:
        delete_dataset(session, slug, place.now, grace=GRACE)
        restore_dataset(session, slug, place.now)
    assert purge_after(place, GRACE * 2) == Purged(0, 0, 0, 0)
    assert counts(place, Dataset, Image) == [1, 1]


def test_a_run_goes_and_no_decision_with_it(place) -> None:
    image_id = place.image(place.dataset(), "a")
    run_id = place.run([image_id], candidates=3)
    with place.database.write() as session:
        kept, undone, _never = session.query(Segment).order_by(Segment.ordinal)
        for number, (segment, verdict) in enumerate(((kept, "keep"), (undone, "undecided"))):
            decision = Decision(
                image_id=image_id,
                segment_id=segment.id,
                verdict=verdict,
                previous="keep",
                kind="judge",
                client_id=str(number),
                group_id="g",
                created_at=place.now,
            )
            session.add(decision)
            session.flush()
            session.add(SegmentState(segment_id=segment.id, verdict=verdict, decision_id=decision.id))
        session.get_one(Run, run_id).deleted_at = place.now
        refresh_counts(session, [image_id])
        kept_id, undone_id = kept.id, undone.id
    assert purge_after(place, GRACE) == Purged(0, 0, 1, 0)
    with place.database.read() as session:
        assert session.query(Run).count() == 0
        left = {row.id: (row.retired_at is None, row.run_image_id) for row in session.query(Segment)}
        assert left == {kept_id: (True, None), undone_id: (False, None)}
        assert session.query(Decision).count() == 2
        image = session.get_one(Image, image_id)
        assert (image.n_candidates, image.n_keep, image.current_run_image_id) == (1, 1, None)


def test_files_without_a_row_go_unless_they_are_young(place, png) -> None:
    place.image(place.dataset(), "a")
    [named] = stored(place)
    orphan = place.blobs.put(b"nobody names this")
    set_time_of_files(place, place.now)
    assert purge_after(place, timedelta(minutes=59)).blobs == 0
    assert stored(place) == {named, orphan}
    assert purge_after(place, timedelta(minutes=61)).blobs == 1
    assert stored(place) == {named}


def test_an_image_whose_file_was_purged_before_its_row_came_is_refused(place, png) -> None:
    slug = place.dataset()
    received = receive_image(place.blobs, "a.png", png(1), max_pixels=10_000)
    set_time_of_files(place, place.now)
    purge_after(place, timedelta(hours=2))
    with pytest.raises(Unavailable, match="purged"), place.database.write() as session:
        add_image(session, place.blobs, place.find(session, slug), received, place.now)
    assert counts(place, Image, Blob) == [0, 0]
