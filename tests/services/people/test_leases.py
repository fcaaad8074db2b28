"""One person holds an image; the others see who, wait for the lease to end, or take it over."""

from __future__ import annotations

from datetime import timedelta

import pytest
from sqlalchemy import select

from app.db.models import Event, Image, Lease
from app.errors import NotFound
from app.services.image_details import neighbours
from app.services.images import get_image
from app.services.leases import LASTS, LeaseState, release_lease, renew_lease

MARA, JON, OTHER_TAB = "mara-page", "jon-page", "mara-other-page"


def renew(office, client: str, person: str, seconds: float = 0, **fields) -> LeaseState:
    with office.database.write() as session:
        return renew_lease(session, office.first, client, person, office.now + timedelta(seconds=seconds), **fields)


def holder(office, client: str, person: str, seconds: float = 0, **fields) -> str | None:
    """Who holds the image once this page has said that it is there."""
    found = renew(office, client, person, seconds, **fields).holder
    return None if found is None else found.person


def test_the_first_one_holds_and_the_second_sees_who_it_is(office) -> None:
    mine = renew(office, MARA, "Mara")
    assert mine.holder is not None
    assert (mine.holder.person, mine.holder.mine, mine.expires_at) == ("Mara", True, office.now + LASTS)
    theirs = renew(office, JON, "Jon", 5)
    assert theirs.holder is not None
    assert (theirs.holder.person, theirs.holder.mine, theirs.holder.since) == ("Mara", False, office.now)
    assert [(present.person, present.mine) for present in theirs.present] == [("Mara", False), ("Jon", True)]


def test_a_lease_ends_by_itself_and_whoever_is_there_holds_next(small_office) -> None:
    office = small_office
    renew(office, MARA, "Mara")
    renew(office, JON, "Jon", 50)
    assert holder(office, JON, "Jon", 59.9) == "Mara"
    later = renew(office, JON, "Jon", 60)
    assert [(present.person, present.mine) for present in later.present] == [("Jon", True)]
    assert later.holder == later.present[0]


def test_a_lease_that_is_renewed_goes_on(small_office) -> None:
    for seconds in (0, 20, 40, 60, 80):
        renew(small_office, MARA, "Mara", seconds)
    assert holder(small_office, JON, "Jon", 100) == "Mara"


def test_a_lease_of_a_clock_that_was_put_back_is_over(small_office) -> None:
    office = small_office
    assert holder(office, MARA, "Mara", 86_400) == "Mara"  # then her browser crashes, and the clock is put right
    assert holder(office, JON, "Jon") == "Jon"


def test_taking_over_is_told_in_the_audit_once(office) -> None:
    renew(office, MARA, "Mara")
    for seconds in (10, 20):
        assert holder(office, JON, "Jon", seconds, take_over=True) == "Jon"
    assert holder(office, MARA, "Mara", 30) == "Jon"
    with office.database.read() as session:
        events = session.scalars(select(Event).where(Event.kind == "image.taken-over")).all()
    assert [(event.person, event.details["from"]) for event in events] == [("Jon", "Mara")]


def test_pages_of_one_person_are_one_holder(small_office) -> None:
    renew(small_office, MARA, "Mara")
    second = renew(small_office, OTHER_TAB, "Mara", 5)
    assert second.holder == second.present[0]
    assert [present.mine for present in second.present] == [True]


def test_who_leaves_makes_room_at_once(small_office) -> None:
    office = small_office
    renew(office, MARA, "Mara")
    with office.database.write() as session:
        release_lease(session, office.first, MARA, "Jon")  # not Jon's page
        assert session.scalar(select(Lease.person)) == "Mara"
        release_lease(session, office.first, MARA, "Mara")
        release_lease(session, office.first, MARA, "Mara")
    assert holder(office, JON, "Jon", 1) == "Jon"


def test_another_name_on_the_same_page_gives_the_image_up(small_office) -> None:
    renew(small_office, MARA, "Mara")
    renew(small_office, JON, "Jon")
    assert holder(small_office, MARA, "Lee", 1) == "Lee"


def test_there_is_no_lease_of_a_deleted_image(small_office) -> None:
    with small_office.database.write() as session:
        session.get_one(Image, small_office.first).deleted_at = small_office.now
    with pytest.raises(NotFound):
        renew(small_office, MARA, "Mara")


def test_the_next_open_image_is_nobody_elses(office) -> None:
    first, second, third = office.images

    def next_of(person: str | None, seconds: float = 0) -> int | None:
        with office.database.read() as session:
            now = office.now + timedelta(seconds=seconds)
            return neighbours(session, get_image(session, third), now, person=person).next_open_id

    renew(office, MARA, "Mara")
    assert (next_of("Mara"), next_of("Jon"), next_of(None)) == (first, second, first)
    assert next_of("Jon", 60) == first
    with office.database.write() as session:
        session.get_one(Image, second).assignee = "Mara"
    assert (next_of("Mara"), next_of("Jon")) == (first, None)
