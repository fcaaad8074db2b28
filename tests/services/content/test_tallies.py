"""What triggers count is what counting finds, whatever happens to images, reviews and runs."""

from __future__ import annotations

from collections import Counter
from datetime import timedelta

import pytest
from sqlalchemy import func, select

from app.db.models import Dataset, Image, ImageTally, Review, Run, RunImage, RunTally
from app.services import assigning, images, reviews, runs
from app.services.purging import purge
from app.services.run_queue import claim_images, fail_image
from app.services.tallies import IMAGES, LOOSE, RUNS, image_count, merge_tallies, owners_to_merge

GRACE = timedelta(days=7)
DIMENSIONS = ("dataset_id", "camera_id", "source", "sequence", "assignee", "review_status", "prelabel", "deleted")
CHANGES = ("candidates", "carried", "kept_unmatched", "already_there", "retired", "discarded", "reopened")


def require_exact(place) -> None:
    """Compare the tallies with images and work counted one by one, and the copies with what they are copied from."""
    with place.database.read() as session:
        counted: Counter[tuple] = Counter()
        for image, review in session.execute(select(Image, Review).join(Review, Review.image_id == Image.id)):
            newest = session.scalars(
                select(RunImage.status)
                .join(Run, Run.id == RunImage.run_id)
                .where(RunImage.image_id == image.id, Run.deleted_at.is_(None), RunImage.status != "cancelled")
                .order_by(RunImage.id.desc())
            ).first()
            assert (image.review_status, image.prelabel) == (review.status, newest or "none"), image.name
            place_of = (image.dataset_id, image.camera_id, image.source, image.sequence, image.assignee)
            key = (*place_of, review.status, newest or "none", image.deleted_at is not None)
            counted[*key, "images"] += 1
            counted[*key, "prelabelled"] += image.current_run_image_id is not None or image.n_candidates > 0
            counted[*key, "labelled"] += image.n_keep > 0
            for name in ("candidates", "keep", "reject", "ambiguous"):
                counted[*key, name] += getattr(image, f"n_{name}")
        assert tallied(session, ImageTally, DIMENSIONS) == +counted
        work: Counter[tuple] = Counter()
        for row in session.scalars(select(RunImage)):
            work[row.run_id, row.status, "images"] += 1
            for name in CHANGES:
                work[row.run_id, row.status, name] += int((row.changes or {}).get(name, 0)) * (row.status == "done")
        assert tallied(session, RunTally, ("run_id", "status")) == +work


def tallied(session, model, keys) -> Counter[tuple]:
    sums = [column.name for column in model.__table__.columns if column.name not in {"id", "merged", *keys}]
    columns = [getattr(model, name) for name in keys]
    rows = session.execute(select(*columns, *(func.sum(getattr(model, name)) for name in sums)).group_by(*columns))
    found: Counter[tuple] = Counter()
    for row in rows:
        for name, value in zip(sums, row[len(keys) :], strict=True):
            assert value >= 0
            found[*row[: len(keys)], name] = int(value)
    return +found


@pytest.fixture
def street(place):
    """Eight images of two folders, two of them labelled."""
    slug = place.dataset()
    ids = place.images(slug, *(f"{folder}/{number}" for folder in "ab" for number in range(4)))
    place.label(ids[0], ["keep", "reject", "undecided"])
    place.label(ids[1], ["ambiguous"])
    return slug, ids


def test_tallies_follow_images_and_reviews(place, street) -> None:
    slug, ids = street
    require_exact(place)
    with place.database.write() as session:
        dataset = place.find(session, slug)
        assigning.assign(session, dataset, ["Ada", "Bo"], "shares", None, place.now)
        reviews.set_review(session, ids[2], "discarded", now=place.now)
    require_exact(place)
    with place.database.write() as session:
        dataset = place.find(session, slug)
        images.delete_images(session, dataset, ids[:3], place.now, grace=GRACE)
    require_exact(place)
    with place.database.write() as session:
        images.restore_images(session, place.find(session, slug), ids[:1], place.now)
    require_exact(place)
    assert purge(place.database, place.blobs, place.now + 2 * GRACE, grace=GRACE).images == 2
    require_exact(place)
    with place.database.read() as session:
        assert image_count(session, ImageTally.deleted.is_(False)) == 6


def test_tallies_follow_runs(place, street) -> None:
    slug, ids = street
    place.run(ids[:3], candidates=4)
    require_exact(place)
    with place.database.write() as session:
        run_id = runs.start_run(session, place.find(session, slug), {}, ids[:5], place.now).id
    require_exact(place)
    with place.database.write() as session:
        claims = claim_images(session, 2, place.now)
        fail_image(session, claims[0], {"code": "invalid-image", "message": "broken"}, place.now)
        done = session.get_one(RunImage, claims[1].run_image_id)
        done.status, done.changes = "done", {"candidates": 3, "carried": 2, "reopened": True}
    require_exact(place)
    with place.database.write() as session:
        runs.cancel_run(session, run_id, place.now)
    require_exact(place)
    with place.database.write() as session:
        runs.retry_run(session, run_id, place.now)
        runs.delete_run(session, run_id, place.now, grace=GRACE)
    require_exact(place)
    with place.database.write() as session:
        runs.restore_run(session, run_id, place.now)
    require_exact(place)
    with place.database.write() as session:
        runs.delete_run(session, run_id, place.now, grace=GRACE)
    purge(place.database, place.blobs, place.now + 2 * GRACE, grace=GRACE)
    require_exact(place)


def test_a_purged_dataset_leaves_nothing(place, street) -> None:
    slug, ids = street
    place.run(ids)
    with place.database.write() as session:
        place.find(session, slug).deleted_at = place.now
    purge(place.database, place.blobs, place.now + 2 * GRACE, grace=GRACE)
    with place.database.write() as session:
        assert session.scalars(select(Dataset.id)).all() == []
        for tallied_, owner in ((IMAGES, 1), (RUNS, 1)):
            merge_tallies(session, tallied_, owner)
        assert session.scalars(select(ImageTally.id)).all() == session.scalars(select(RunTally.id)).all() == []


def test_merging_changes_no_sum(place, street) -> None:
    slug, ids = street
    with place.database.read() as session:
        dataset_id = place.find(session, slug).id
        assert owners_to_merge(session, IMAGES) == []
    for number in range(LOOSE // 2):
        with place.database.write() as session:
            session.get_one(Image, ids[0]).sequence = f"drive {number % 3}"
    require_exact(place)
    with place.database.write() as session:
        assert owners_to_merge(session, IMAGES) == [dataset_id]
        merge_tallies(session, IMAGES, dataset_id)
    require_exact(place)
    with place.database.read() as session:
        assert owners_to_merge(session, IMAGES) == []
        rows = session.scalars(select(ImageTally).where(ImageTally.dataset_id == dataset_id)).all()
        assert len(rows) < len(ids)
        assert all(row.merged for row in rows)


def test_merging_neither_waits_for_changes_nor_loses_them(place, street) -> None:
    if place.database.is_sqlite:
        pytest.skip("SQLite has one writer")
    slug, ids = street
    with place.database.read() as session:
        dataset_id = place.find(session, slug).id
    with place.database.write() as changing:
        changing.get_one(Image, ids[0]).sequence = "drive"
        changing.flush()
        with place.database.write() as merging:  # the change isn't stored yet
            merge_tallies(merging, IMAGES, dataset_id)
    require_exact(place)
