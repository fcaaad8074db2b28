"""Kappa of two people's verdicts, their differences, and what a third look decides."""

from __future__ import annotations

from datetime import timedelta
from typing import Any
from uuid import uuid4

import pytest
from sqlalchemy import func, select

from app.db.models import Adjudication, Decision, Event
from app.errors import Conflict, InvalidInput, NotFound
from app.review.agreement import cohen_kappa
from app.services.adjudicating import adjudicate, take_back
from app.services.agreements import Agreement, agreement_of
from app.services.differences import Difference, list_differences
from app.services.labelling import segments_of_image
from app.services.second_reviews import own_second_review, set_second_review
from app.services.second_verdicts import decide_second


def agreement(office) -> Agreement:
    with office.database.read() as session:
        return agreement_of(session, office.dataset(session))


def differences(office, **fields: Any) -> tuple[Difference, ...]:
    with office.database.read() as session:
        return list_differences(session, office.dataset(session), **fields).items


def decided(office, image_id: int) -> list[str]:
    with office.database.read() as session:
        return [segment.verdict for segment in segments_of_image(session, image_id).segments]


def rule(office, number: int, segment_id: int, verdict: str, client_id: str | None = None) -> Difference:
    with office.database.write() as session:
        return adjudicate(session, number, segment_id, verdict, client_id or str(uuid4()), "Ann", office.now)


def test_kappa_over_all_and_in_parts(office) -> None:
    first, second, third = office.images
    office.finish(first, "kkrr", "Mara")
    office.finish(second, "krrr", "Jon")
    office.finish(third, "kkkk", "Mara")
    office.second(first, "krrr", "Jon")
    office.second(second, "krru", "Mara")
    office.second(third, "rrrr", "Jon", done=False)
    found = agreement(office)
    assert (found.reviews, found.differences, found.adjudicated) == (2, 1, 0)
    assert found.overall == cohen_kappa([[2, 1, 0], [0, 4, 0], [0, 0, 0]])
    assert [(each.image_id, each.second_person, each.kappa.count) for each in found.images] == [
        (first, "Jon", 4),
        (second, "Mara", 3),
    ]
    assert [(each.first, each.second, each.kappa.count) for each in found.pairs] == [
        ("Jon", "Mara", 3),
        ("Mara", "Jon", 4),
    ]
    assert [(each.person, each.kappa) for each in found.people] == [("Jon", found.overall), ("Mara", found.overall)]
    assert [(each.low, each.kappa.count) for each in found.lengths] == [(0, 2), (50, 2), (100, 2), (200, 1), (400, 0)]


def test_what_was_changed_after_the_second_review_began_does_not_agree_afterwards(small_office) -> None:
    office = small_office
    office.finish(office.first, "kkrr")
    office.second(office.first, "krrr")
    office.decide(office.first, {office.segments[office.first][1]: "reject"}, "Mara")
    assert agreement(office).differences == 1


def test_nothing_was_judged_twice(small_office) -> None:
    found = agreement(small_office)
    assert (found.reviews, found.overall.value, found.overall.count, found.images) == (0, None, 0, ())


def test_differences_page_by_page(office) -> None:
    first, second, _ = office.images
    for image_id in (first, second):
        office.finish(image_id, "kkrr")
        office.second(image_id, "rkka")
    with office.database.read() as session:
        dataset = office.dataset(session)
        page = list_differences(session, dataset, limit=4)
        rest = list_differences(session, dataset, limit=4, cursor=page.next_cursor)
    items = [*page.items, *rest.items]
    assert (page.total, rest.next_cursor) == (6, None)
    places = [(each.image_id, office.segments[each.image_id].index(each.segment_id)) for each in items]
    assert places == [(first, 0), (first, 2), (first, 3), (second, 0), (second, 2), (second, 3)]
    assert (items[0].first.verdict, items[0].first.person) == ("keep", "Mara")
    assert (items[0].second.verdict, items[0].second.person) == ("reject", "Jon")
    assert (items[0].length, items[0].box[1], items[0].adjudicated) == (30.0, 10.0, None)


def test_an_adjudication_is_a_normal_decision_that_can_be_taken_back(office) -> None:
    office.finish(office.first, "kkrr")
    number = office.second(office.first, "krrr")
    segment = office.segments[office.first][1]
    client_id = str(uuid4())
    rule(office, number, segment, "reject", client_id)
    ruled = rule(office, number, segment, "reject", client_id)
    assert ruled.adjudicated is not None
    assert (ruled.adjudicated.verdict, ruled.adjudicated.person) == ("reject", "Ann")
    assert (ruled.first.verdict, ruled.second.verdict) == ("keep", "reject")
    assert decided(office, office.first) == ["keep", "reject", "reject", "reject"]
    assert (differences(office, adjudicated=False), len(differences(office, adjudicated=True))) == ((), 1)
    assert agreement(office).adjudicated == 1
    with office.database.write() as session:
        row = session.scalars(select(Decision).where(Decision.client_id == client_id)).one()
        assert (row.person, row.kind, row.previous) == ("Ann", "judge", "keep")
        assert take_back(session, number, segment, "Ann", office.now).adjudicated is None
    assert decided(office, office.first) == ["keep", "keep", "reject", "reject"]
    with office.database.write() as session, pytest.raises(NotFound):
        take_back(session, number, segment, "Ann", office.now)
    with office.database.read() as session:
        kinds = session.scalars(select(Event.kind).where(Event.kind.startswith("segment.")).order_by(Event.id)).all()
    assert kinds == ["segment.adjudicated", "segment.adjudication-undone"]


def test_a_late_repetition_of_what_was_taken_back_brings_nothing_back(small_office) -> None:
    office = small_office
    office.finish(office.first, "kkrr")
    number = office.second(office.first, "krrr")
    segment, client_id = office.segments[office.first][1], str(uuid4())
    rule(office, number, segment, "reject", client_id)
    with office.database.write() as session:
        take_back(session, number, segment, "Ann", office.now)
    assert rule(office, number, segment, "reject", client_id).adjudicated is None
    assert decided(office, office.first)[1] == "keep"


def test_a_later_verdict_outlives_the_adjudication(small_office) -> None:
    office = small_office
    office.finish(office.first, "kkrr")
    number = office.second(office.first, "krrr")
    segment = office.segments[office.first][1]
    rule(office, number, segment, "reject")
    office.decide(office.first, {segment: "ambiguous"}, "Mara")
    with office.database.write() as session:
        take_back(session, number, segment, "Ann", office.now)
    assert decided(office, office.first)[1] == "ambiguous"


def test_the_second_ruling_replaces_the_first(small_office) -> None:
    office = small_office
    office.finish(office.first, "kkrr")
    number = office.second(office.first, "krrr")
    for verdict in ("reject", "ambiguous"):
        rule(office, number, office.segments[office.first][1], verdict)
    with office.database.read() as session:
        rows = session.scalars(select(Adjudication)).all()
        assert session.scalar(select(func.count()).select_from(Adjudication)) == 1
    assert (rows[0].first, rows[0].second, rows[0].verdict) == ("keep", "reject", "ambiguous")
    with office.database.write() as session:
        take_back(session, number, office.segments[office.first][1], "Ann", office.now)
    assert decided(office, office.first)[1] == "keep"


def test_what_the_second_person_changes_after_seeing_the_differences_is_not_independent(office) -> None:
    office.finish(office.first, "kkrr")
    number = office.second(office.first, "krrr")
    before = agreement(office)
    changed = [office.wish(office.segments[office.first][1], "keep")]
    with office.database.write() as session:
        later = office.now + timedelta(minutes=5)
        set_second_review(session, number, "open", "Jon", later)
        review, _ = own_second_review(session, number, "Jon", lock=True)
        decide_second(session, review, changed, "Jon", later)
    assert agreement(office).overall.count == 0
    with office.database.write() as session:
        set_second_review(session, number, "done", "Jon", later)
    assert agreement(office) == before
    assert [each.second.verdict for each in differences(office)] == ["reject"]


def test_a_reason_comes_back_with_the_rejection(small_office) -> None:
    office = small_office
    segment = office.segments[office.first][1]
    office.finish(office.first, "kkrr")
    office.decide(office.first, {segment: "reject"}, "Mara", reason="car")
    number = office.second(office.first, "kkrr")
    rule(office, number, segment, "keep")
    with office.database.write() as session:
        take_back(session, number, segment, "Ann", office.now)
    with office.database.read() as session:
        entry = segments_of_image(session, office.first).segments[1]
    assert (entry.verdict, entry.reason) == ("reject", "car")


def test_there_is_nothing_to_rule_where_both_agree(small_office) -> None:
    office = small_office
    office.finish(office.first, "kkrr")
    number = office.second(office.first, "krrr")
    with pytest.raises(Conflict, match="nothing to decide"):
        rule(office, number, office.segments[office.first][0], "keep")
    with pytest.raises(InvalidInput, match="decides nothing"):
        rule(office, number, office.segments[office.first][1], "undecided")
    with pytest.raises(NotFound):
        rule(office, 999, office.segments[office.first][1], "keep")
