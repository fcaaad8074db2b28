from __future__ import annotations

from datetime import timedelta

import pytest

from app.db.models import Image, Run
from app.errors import Conflict, InvalidInput, NotFound
from app.services.camera_references import set_reference
from app.services.cameras import camera_entry, get_camera, list_cameras, rename_camera
from app.services.datasets import delete_dataset
from app.services.events import list_events
from app.services.images import delete_images

K = [[50, 0, 32], [0, 51, 24], [0, 0, 1]]


@pytest.fixture
def street(place):
    slug = place.dataset()
    ids = [place.image(slug, name, camera=name[0]) for name in ("b1", "a1", "a2")]
    with place.database.read() as session:
        return slug, ids, [session.get_one(Image, image_id).camera_id for image_id in ids]


def test_list(place, street) -> None:
    slug, _, (second, first, _) = street
    with place.database.read() as session:
        entries = list_cameras(session, place.find(session, slug))
    assert [(entry.id, entry.name, entry.width, entry.height, entry.images) for entry in entries] == [
        (first, "a", 64, 48, 2),
        (second, "b", 64, 48, 1),
    ]
    assert [(entry.reference, entry.estimate) for entry in entries] == [(None, None)] * 2


def test_the_newest_run_that_is_not_deleted_says_the_estimate(place, street) -> None:
    slug, ids, (second, first, _) = street
    runs = [place.run(ids) for _ in range(3)]
    for number, run in enumerate(runs):
        place.estimate(run, first, float(number))
    place.estimate(runs[0], second, 9.0)
    with place.database.write() as session:
        session.get_one(Run, runs[2]).deleted_at = place.now
    with place.database.read() as session:
        entries = list_cameras(session, place.find(session, slug))
    assert [entry.estimate for entry in entries] == [{"k": [1.0]}, {"k": [9.0]}]


def test_cameras_without_images_are_listed_with_a_reference_only(place, street) -> None:
    slug, ids, (second, _, _) = street
    with place.database.write() as session:
        delete_images(session, place.find(session, slug), ids[:1], place.now, grace=timedelta(1))
    with place.database.write() as session:
        assert [entry.name for entry in list_cameras(session, place.find(session, slug))] == ["a"]
        set_reference(session, get_camera(session, second), {"K": K, "D": [0, 0, 0, 0]}, place.now)
        assert [(entry.name, entry.images) for entry in list_cameras(session, place.find(session, slug))] == [
            ("a", 2),
            ("b", 0),
        ]


def test_rename(place, street) -> None:
    slug, _, (second, first, _) = street
    with place.database.write() as session:
        rename_camera(session, get_camera(session, first), " front left ", place.now, person="owner")
    with pytest.raises(Conflict, match="another camera"), place.database.write() as session:
        rename_camera(session, get_camera(session, second), "front left", place.now)
    for name in ("", "x" * 301, "a\nb"):
        with pytest.raises(InvalidInput), place.database.write() as session:
            rename_camera(session, get_camera(session, second), name, place.now)
    with place.database.read() as session:
        assert camera_entry(session, get_camera(session, first)).name == "front left"
        newest = list_events(session, place.find(session, slug), limit=1)
    assert newest.items[0].details == {"from": "a", "to": "front left"}
    assert newest.total == 2


def test_set_and_clear_a_reference(place, street) -> None:
    _, _, (_, first, _) = street
    with place.database.write() as session:
        set_reference(session, get_camera(session, first), {"K": K, "D": [-0.2, 0.1, 0, 0, 0.01]}, place.now)
    with place.database.read() as session:
        assert get_camera(session, first).reference == {"K": K, "D": [-0.2, 0.1, 0, 0, 0.01]}
    with place.database.write() as session:
        set_reference(session, get_camera(session, first), None, place.now)
    with place.database.read() as session:
        assert get_camera(session, first).reference is None


@pytest.mark.parametrize(
    "reference",
    [
        {},
        {"K": K},
        {"D": [0, 0, 0, 0]},
        {"K": K, "D": [0, 0, 0]},
        {"K": K, "D": [0, 0, 0, float("nan")]},
        {"K": K, "D": [0, 0, 0, "0"]},
        {"K": K[:2], "D": [0, 0, 0, 0]},
        {"K": [[0, 0, 32], *K[1:]], "D": [0, 0, 0, 0]},
        {"K": K, "D": [0, 0, 0, 0], "width": 640},
        {"K": K, "D": object()},
    ],
)
def test_references_that_are_none(sqlite_place, reference) -> None:
    place = sqlite_place
    image_id = place.image(place.dataset(), "a")
    with pytest.raises(InvalidInput), place.database.write() as session:
        set_reference(session, get_camera(session, session.get_one(Image, image_id).camera_id), reference, place.now)


def test_cameras_of_deleted_datasets_are_hidden(place, street) -> None:
    slug, _, (_, first, _) = street
    with place.database.write() as session:
        delete_dataset(session, slug, place.now, grace=timedelta(1))
    with place.database.read() as session:
        for camera_id in (first, 999):
            with pytest.raises(NotFound):
                get_camera(session, camera_id)
