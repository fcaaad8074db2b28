from __future__ import annotations

from datetime import timedelta

import pytest

from app.errors import Conflict, InvalidInput, NotFound
from app.services.dataset_overviews import dataset_overview, list_datasets
from app.services.datasets import create_dataset, delete_dataset, get_dataset, rename_dataset, restore_dataset
from app.services.events import list_events
from app.services.slugs import slug_of

GRACE = timedelta(days=7)


@pytest.mark.parametrize(
    ("name", "slug"),
    [
        ("KITTI", "kitti"),
        ("  Vienna, downtown (spring) ", "vienna-downtown-spring"),
        ("Übungsstraße Łódź", "ubungsstrasse-lodz"),
        ("東京", "dataset"),
        ("!!!", "dataset"),
        ("x" * 200, "x" * 80),
        ("ﬁve №5", "five-no5"),
    ],
)
def test_slug_of(name: str, slug: str) -> None:
    assert slug_of(name) == slug


def test_create_gives_slug_and_event(place) -> None:
    with place.database.write() as session:
        dataset = create_dataset(session, "  Vienna\n downtown ", place.now, person="owner")
        assert (dataset.slug, dataset.name, dataset.created_at) == ("vienna-downtown", "Vienna downtown", place.now)
    with place.database.read() as session:
        [event] = list_events(session, get_dataset(session, "vienna-downtown")).items
    assert (event.kind, event.person, event.created_at) == ("dataset.created", "owner", place.now)


def test_taken_slug_gets_a_number_and_taken_name_is_a_conflict(place) -> None:
    slugs = [place.dataset(name) for name in ("A b", "a-b", "A, B", "東京", "北京")]
    assert slugs == ["a-b", "a-b-2", "a-b-3", "dataset", "dataset-2"]
    with pytest.raises(Conflict, match="A b exists already"):
        place.dataset("A  b")


@pytest.mark.parametrize("name", ["", "   ", "x" * 201, "a\x00b"])
def test_names_that_can_not_be(place, name: str) -> None:
    with pytest.raises(InvalidInput):
        place.dataset(name)


def test_rename_keeps_the_slug(place) -> None:
    place.dataset("One")
    place.dataset("Two")
    with place.database.write() as session:
        assert rename_dataset(session, "one", "Drei", place.now).name == "Drei"
    with pytest.raises(Conflict), place.database.write() as session:
        rename_dataset(session, "one", "Two", place.now)
    with place.database.read() as session:
        assert get_dataset(session, "one").name == "Drei"
        with pytest.raises(NotFound, match="no dataset drei"):
            get_dataset(session, "drei")


def test_delete_hides_and_restore_brings_back(place) -> None:
    place.dataset("One")
    with place.database.write() as session:
        deleted = delete_dataset(session, "one", place.now, grace=GRACE)
    assert (deleted.deleted, deleted.restorable_until) == (1, place.now + GRACE)
    with place.database.read() as session:
        assert list_datasets(session, grace=GRACE) == []
        [entry] = list_datasets(session, grace=GRACE, deleted=True)
        with pytest.raises(NotFound, match="is deleted"):
            get_dataset(session, "one")
    assert (entry.slug, entry.restorable_until) == ("one", place.now + GRACE)
    with place.database.write() as session:
        restore_dataset(session, "one", place.now)
    with place.database.read() as session:
        assert dataset_overview(session, "one", grace=GRACE).deleted_at is None


def test_restore_is_a_conflict_when_the_name_was_taken(place) -> None:
    place.dataset("One")
    with place.database.write() as session:
        delete_dataset(session, "one", place.now, grace=GRACE)
    assert place.dataset("One") == "one"  # the new one has the good slug, the deleted one gives it up
    with pytest.raises(Conflict, match="exists already"), place.database.write() as session:
        restore_dataset(session, "one-2", place.now)
    with pytest.raises(Conflict, match="isn't deleted"), place.database.write() as session:
        restore_dataset(session, "one", place.now)
    with place.database.write() as session:
        rename_dataset(session, "one", "Another", place.now)
        restore_dataset(session, "one-2", place.now)
    with place.database.read() as session:
        assert {entry.slug: entry.name for entry in list_datasets(session, grace=GRACE)} == {
            "one": "Another",
            "one-2": "One",
        }


def test_restore_what_never_was(place) -> None:
    with pytest.raises(NotFound), place.database.write() as session:
        restore_dataset(session, "nothing", place.now)


def test_overview_counts(place) -> None:
    place.dataset("Empty")
    slug = place.dataset("Street")
    first, second, third, *_ = ids = place.images(slug, "b/2", "b/1", "a/9", "c/1", "c/2", "c/3")
    place.label(first, ["keep", "reject", "keep", "ambiguous"])
    place.label(second, ["keep", "undecided"])
    run = place.run([second, third], candidates=3)
    with place.database.read() as session:
        empty, street = sorted(list_datasets(session, grace=GRACE), key=lambda entry: entry.name)
        assert dataset_overview(session, slug, grace=GRACE) == street
    assert (empty.images, empty.candidates, empty.cover, empty.latest_run) == (0, 0, (), None)
    assert (street.images, street.prelabelled, street.candidates) == (6, 3, 12)
    assert vars(street.reviewed) == {"open": 5, "done": 1, "discarded": 0}
    assert vars(street.verdicts) == {"keep": 3, "reject": 1, "ambiguous": 1, "undecided": 7}
    assert street.cover == (ids[2], ids[1], ids[0], ids[3])  # by name
    assert street.latest_run is not None
    assert (street.latest_run.id, street.latest_run.status, street.latest_run.total) == (run, "done", 2)
    assert street.latest_run.counts.done == 2


def test_list_needs_a_fixed_number_of_queries(place, count_queries) -> None:
    place.image(place.dataset("One"), "a")
    with place.database.read() as session, count_queries(place.database) as few:
        list_datasets(session, grace=GRACE)
    for number in range(12):
        slug = place.dataset(f"More {number}")
        place.run(place.images(slug, f"{number}/a", f"{number}/b"), candidates=1)
    with place.database.read() as session, count_queries(place.database) as many:
        assert len(list_datasets(session, grace=GRACE)) == 13
    assert len(few) <= len(many) <= 6
