from __future__ import annotations

from datetime import timedelta

import pytest

from app.db.models import Blob, Camera, Dataset, Image
from app.errors import Conflict, InvalidImage, InvalidInput, NotFound, TooLarge
from app.services.cameras import list_cameras
from app.services.datasets import delete_dataset
from app.services.image_adding import add_image, receive_image
from app.services.image_changes import ImageChanges, rename_image, update_images
from app.services.image_details import image_detail, neighbours
from app.services.image_summaries import image_summary
from app.services.images import dataset_of, delete_images, get_image, images_of, restore_images

GRACE = timedelta(days=7)


def named(session, slug: str) -> Dataset:
    return session.query(Dataset).filter_by(slug=slug).one()


def test_receive_checks_by_header_and_stores(sqlite_place, png) -> None:
    blobs = sqlite_place.blobs
    received = receive_image(blobs, "KITTI\\000000.png", png(1, 70, 50), max_pixels=10_000)
    assert (received.file_name, received.name) == ("KITTI/000000.png", "KITTI/000000")
    assert (received.header.width, received.header.height, received.header.bits) == (70, 50, 8)
    assert blobs.read(received.sha256) == png(1, 70, 50)


def test_receive_refuses_without_storing(sqlite_place, png) -> None:
    blobs = sqlite_place.blobs
    with pytest.raises(TooLarge) as too_large:
        receive_image(blobs, "a.png", png(1, 70, 50), max_pixels=3_499)
    assert too_large.value.where == "a.png"
    with pytest.raises(InvalidImage):
        receive_image(blobs, "a.png", b"no image", max_pixels=10_000)
    for path in ("../a.png", "/a.png", "a//b.png", "", "x" * 501 + ".png"):
        with pytest.raises(InvalidInput):
            receive_image(blobs, path, png(1), max_pixels=10_000)
    assert not list(blobs.root.glob("??/??/*"))


def test_add_stores_what_is_known(place) -> None:
    slug = place.dataset()
    image_id = place.image(slug, "downtown/000007", size=(80, 60))
    with place.database.read() as session:
        summary = image_summary(session, get_image(session, image_id))
    assert (summary.name, summary.file_name) == ("downtown/000007", "downtown/000007.png")
    assert (summary.width, summary.height, summary.bits) == (80, 60, 8)
    assert (summary.camera.name, summary.source, summary.sequence) == ("downtown 80x60", "downtown", None)
    assert (summary.status, summary.prelabel, summary.error, summary.candidates) == ("open", "none", None, 0)


def test_one_folder_and_size_is_one_camera(place) -> None:
    slug = place.dataset()
    place.images(slug, "a/1", "a/2", "b/1", "top")
    place.image(slug, "a/3", size=(30, 30))
    place.image(slug, "a/4", camera="left", source="KITTI", sequence="00")
    with place.database.read() as session:
        cameras = {camera.name: camera.images for camera in list_cameras(session, named(session, slug))}
        stated = session.query(Image).filter_by(name="a/4").one()
    assert cameras == {"a 64x48": 2, "b 64x48": 1, "64x48": 1, "a 30x30": 1, "left": 1}
    assert (stated.source, stated.sequence) == ("KITTI", "00")


def test_a_camera_of_another_size_is_refused(place) -> None:
    slug = place.dataset()
    place.image(slug, "a", camera="left")
    with pytest.raises(InvalidInput, match="camera left takes images of 64 x 48 px, not 30 x 30"):
        place.image(slug, "b", camera="left", size=(30, 30))
    with place.database.read() as session:
        assert session.query(Image).count() == 1


def test_same_content_is_the_image_that_is_there(place) -> None:
    slug = place.dataset()
    first = place.image(slug, "a", seed=5)
    assert place.image(slug, "other/name", seed=5) == first
    with place.database.read() as session:
        assert session.query(Image).count() == session.query(Blob).count() == 1


def test_same_content_in_two_datasets_is_one_blob(place) -> None:
    first, second = (place.image(place.dataset(name), "a", seed=5) for name in ("One", "Two"))
    assert first != second
    with place.database.read() as session:
        assert (session.query(Image).count(), session.query(Blob).count()) == (2, 1)


def test_two_images_of_one_name_are_a_conflict_naming_both(place, png) -> None:
    slug = place.dataset()
    place.image(slug, "KITTI/0")
    received = receive_image(place.blobs, "KITTI/0.jpg", png(99), max_pixels=10_000)
    with (
        pytest.raises(Conflict, match=r"KITTI/0.png, which is here already, and KITTI/0.jpg"),
        place.database.write() as session,
    ):
        add_image(session, place.blobs, named(session, slug), received, place.now)


def test_delete_and_restore(place) -> None:
    slug = place.dataset()
    first, second, third = place.images(slug, "a", "b", "c")
    with place.database.write() as session:
        deleted = delete_images(session, named(session, slug), [first, second, second], place.now, grace=GRACE)
    assert (deleted.deleted, deleted.restorable_until) == (2, place.now + GRACE)
    with place.database.read() as session:
        with pytest.raises(NotFound, match="the image a is deleted"):
            get_image(session, first)
        assert [image.id for image in images_of(session, named(session, slug), [third])] == [third]
    with place.database.write() as session:
        image = get_image(session, first, deleted=True)
        assert restore_images(session, dataset_of(session, image), [first, second], place.now) == 2
        assert get_image(session, first).deleted_at is None


def test_delete_of_foreign_images_deletes_none(place) -> None:
    slug, other = place.dataset("One"), place.dataset("Two")
    [mine], [foreign] = place.images(slug, "a"), place.images(other, "b")
    with pytest.raises(NotFound) as error, place.database.write() as session:
        delete_images(session, named(session, slug), [mine, foreign, 999], place.now, grace=GRACE)
    assert error.value.details == {"missing": [foreign, 999]}
    with place.database.read() as session:
        assert get_image(session, mine)


@pytest.mark.parametrize("again", [{"name": "a", "seed": 2}, {"name": "z", "seed": 1}])
def test_restore_is_a_conflict_when_name_or_content_was_taken(place, again) -> None:
    slug = place.dataset()
    first = place.image(slug, "a", seed=1)
    with place.database.write() as session:
        delete_images(session, named(session, slug), [first], place.now, grace=GRACE)
    second = place.image(slug, **again)
    assert second != first
    with pytest.raises(Conflict) as error, place.database.write() as session:
        restore_images(session, named(session, slug), [first], place.now)
    assert error.value.details == {"images": ["a"]}


def test_restore_of_two_that_had_one_name(place) -> None:
    slug = place.dataset()
    ids = []
    for seed in (1, 2):
        ids.append(place.image(slug, "a", seed=seed))
        with place.database.write() as session:
            delete_images(session, named(session, slug), ids[-1:], place.now, grace=GRACE)
    with pytest.raises(Conflict), place.database.write() as session:
        restore_images(session, named(session, slug), ids, place.now)


def test_images_of_a_deleted_dataset_are_hidden(place) -> None:
    slug = place.dataset()
    image_id = place.image(slug, "a")
    with place.database.write() as session:
        delete_dataset(session, slug, place.now, grace=GRACE)
    with place.database.read() as session, pytest.raises(NotFound):
        get_image(session, image_id)


def test_update_many(place) -> None:
    slug = place.dataset()
    first, second, third = place.images(slug, "a/1", "a/2", "b/1")
    changes = ImageChanges(camera="front", source=None, sequence=" drive 1 ")
    with place.database.write() as session:
        assert update_images(session, named(session, slug), [first, second], changes, place.now) == 2
    with place.database.read() as session:
        rows = [(image.camera.name, image.source, image.sequence) for image in images_by_name(session)]
    assert rows == [("front", None, "drive 1"), ("front", None, "drive 1"), ("b 64x48", "b", None)]
    with place.database.write() as session:
        assert update_images(session, named(session, slug), [third], ImageChanges(sequence="2"), place.now) == 1
        assert update_images(session, named(session, slug), [third], ImageChanges(), place.now) == 0
    with place.database.read() as session:
        last = images_by_name(session)[-1]
        assert (last.camera.name, last.source, last.sequence) == ("b 64x48", "b", "2")


def images_by_name(session) -> list[Image]:
    return session.query(Image).order_by(Image.name).all()


def test_update_to_a_camera_of_another_size_names_the_images(place) -> None:
    slug = place.dataset()
    small = place.image(slug, "small", size=(30, 30))
    large = place.images(slug, "large/1", "large/2")
    place.image(slug, "third", camera="front")
    for ids, camera in (([small], "front"), ([small, *large], "new")):
        with pytest.raises(InvalidInput) as error, place.database.write() as session:
            update_images(session, named(session, slug), ids, ImageChanges(camera=camera), place.now)
        assert error.value.details == {"images": ["small"]}
    with place.database.read() as session:
        assert session.query(Camera).filter_by(name="new").count() == 0


def test_rename(place) -> None:
    slug = place.dataset()
    first, second = place.images(slug, "a.b/1.0", "b")
    with place.database.write() as session:
        image = rename_image(session, get_image(session, first), "c/2.5", place.now)
        assert (image.name, image.file_name) == ("c/2.5", "c/2.5.png")
    with (
        pytest.raises(Conflict, match=r"c/2.5.png, which is here already, and c/2.5.png"),
        place.database.write() as session,
    ):
        rename_image(session, get_image(session, second), "c/2.5", place.now)
    for name in ("../x", "", "a/", "x" * 500):
        with pytest.raises(InvalidInput), place.database.write() as session:
            rename_image(session, get_image(session, first), name, place.now)


def test_neighbours_by_name(place) -> None:
    slug = place.dataset()
    ten, two, upper, one = place.images(slug, "i10", "i2", "I3", "i1")  # by code point: I3, i1, i10, i2
    deleted = place.image(slug, "i0")
    place.label(ten, ["keep"])
    with place.database.write() as session:
        delete_images(session, named(session, slug), [deleted], place.now, grace=GRACE)
    with place.database.read() as session:
        beside = [neighbours(session, get_image(session, image_id), place.now) for image_id in (upper, one, ten, two)]
    assert [(place.previous_id, place.next_id) for place in beside] == [
        (None, one),
        (upper, ten),
        (one, two),
        (ten, None),
    ]
    assert [place.next_open_id for place in beside] == [one, two, two, upper]
    assert [(place.position, place.total) for place in beside] == [(1, 4), (2, 4), (3, 4), (4, 4)]


def test_next_open_is_never_the_image_itself(place) -> None:
    slug = place.dataset()
    first, second = place.images(slug, "a", "b")
    place.label(second, ["keep"])
    with place.database.read() as session:
        assert neighbours(session, get_image(session, first), place.now).next_open_id is None
        assert neighbours(session, get_image(session, second), place.now).next_open_id == first


def test_detail(place) -> None:
    slug = place.dataset()
    first, second = place.images(slug, "a", "b")
    run = place.run([first, second], candidates=2)
    with place.database.read() as session:
        place.estimate(run, get_image(session, first).camera_id, -0.25)
    with place.database.read() as session:
        detail = image_detail(session, get_image(session, first), place.now)
    assert (detail.dataset.slug, detail.name, detail.next_id, detail.position, detail.total) == (
        slug,
        "a",
        second,
        1,
        2,
    )
    assert (detail.camera_estimate, detail.candidates, detail.prelabel) == ({"k": [-0.25]}, 2, "done")
    assert detail.run is not None
    assert (detail.run.id, detail.changes) == (run, None)
