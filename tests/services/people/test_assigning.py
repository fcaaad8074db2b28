"""Images become people's tasks, in shares that keep a drive together."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import select

from app.db.models import Event, Image
from app.errors import InvalidInput, NotFound
from app.services.assigning import Task, assign, equal_shares
from app.services.people import people_of
from app.services.work_logs import WorkLogs

tasks = st.lists(st.sampled_from([None, "a", "b", "c", "d"]), max_size=40).map(
    lambda drives: [Task(number, f"frame-{number:02d}", drive) for number, drive in enumerate(drives)]
)


def test_a_drive_stays_with_one_person_and_loose_images_fill_up() -> None:
    given = [Task(n, f"{n:02d}", "long" if n < 5 else "short" if n < 8 else None) for n in range(12)]
    shares = equal_shares(given, ["Mara", "Jon"])
    assert {name: [task.image_id for task in share] for name, share in shares.items()} == {
        "Mara": [0, 1, 2, 3, 4, 8],
        "Jon": [5, 6, 7, 9, 10, 11],
    }


@given(tasks, st.integers(1, 5), st.randoms(use_true_random=False))
def test_shares_are_whole_and_as_even_as_drives_allow(given_tasks, people, random) -> None:
    names = [f"person {number}" for number in range(people)]
    shares = equal_shares(given_tasks, names)
    shuffled = random.sample(given_tasks, len(given_tasks))
    assert equal_shares(shuffled, names) == shares
    given_out = [task for share in shares.values() for task in share]
    assert sorted(task.image_id for task in given_out) == [task.image_id for task in given_tasks]
    holders = {}
    for name, share in shares.items():
        for task in share:
            if task.sequence is not None:
                assert holders.setdefault(task.sequence, name) == name
    largest = max((sum(task.sequence == drive for task in given_tasks) for drive in "abcd"), default=0)
    sizes = [len(share) for share in shares.values()]
    assert max(sizes) - min(sizes) <= max(1, largest)


def test_assigned_images_are_told_with_what_is_done_of_them(office) -> None:
    with office.database.write() as session:
        shares = assign(session, office.dataset(session), ["Mara", "Jon"], "shares", None, office.now, person="Lee")
    assert [(share.person, share.images) for share in shares] == [("Mara", 2), ("Jon", 1)]
    office.finish(office.first, "krrr", person="Lee")
    with office.database.write() as session:
        decided = WorkLogs(office.database).of(office.dataset_id, office.now).decisions_by_person()
        found = people_of(session, office.dataset(session), decided)
        events = session.scalars(select(Event).where(Event.kind == "images.assigned").order_by(Event.id)).all()
    assert [(one.person, one.assigned, one.done, one.decisions) for one in found] == [
        ("Jon", 1, 0, 0),
        ("Lee", 0, 0, 4),
        ("Mara", 2, 1, 0),
    ]
    assert [(event.person, event.details["people"]) for event in events] == [("Lee", {"Mara": 2, "Jon": 1})]


def test_shares_leave_alone_what_is_somebodys_or_done(office) -> None:
    first, second, third = office.images
    office.finish(first, "rrrr")
    with office.database.write() as session:
        dataset = office.dataset(session)
        assert assign(session, dataset, ["Jon"], "to", [second], office.now)[0].images == 1
        assert assign(session, dataset, ["Mara"], "shares", None, office.now)[0].images == 1
        rows = dict(session.execute(select(Image.id, Image.assignee)).all())
    assert rows == {first: None, second: "Jon", third: "Mara"}


def test_nobody_takes_images_back(small_office) -> None:
    with small_office.database.write() as session:
        dataset = small_office.dataset(session)
        assign(session, dataset, ["Jon"], "to", list(small_office.images), small_office.now)
        assert assign(session, dataset, [], "to", [small_office.first], small_office.now) == []
        rows = session.scalars(select(Image.assignee).order_by(Image.id)).all()
    assert rows == [None, "Jon", "Jon"]


@pytest.mark.parametrize(
    ("people", "mode", "error"),
    [
        ([], "shares", InvalidInput),
        (["Mara", "Jon"], "to", InvalidInput),
        (["Mara", " Mara "], "shares", InvalidInput),
        (["Ma\x07ra"], "to", InvalidInput),
        (["x" * 81], "to", InvalidInput),
    ],
)
def test_people_that_cannot_be_are_refused(small_office, people, mode, error) -> None:
    with small_office.database.write() as session, pytest.raises(error):
        assign(session, small_office.dataset(session), people, mode, None, small_office.now)


def test_images_of_another_dataset_are_refused(small_office) -> None:
    with small_office.database.write() as session, pytest.raises(NotFound):
        assign(session, small_office.dataset(session), ["Mara"], "to", [999], small_office.now)
