"""Nobody's verdict is overruled by one who didn't know it."""

from __future__ import annotations

import pytest
from sqlalchemy import func, select

from app.db.models import Decision, Segment
from app.services.labelling import segments_of_image
from app.services.stale_verdicts import StaleVerdict


def last(office) -> int:
    with office.database.read() as session:
        return segments_of_image(session, office.first).last_decision_id


def test_a_verdict_given_without_knowing_anothers_is_refused_with_both(office) -> None:
    one, two, three, _ = office.segments[office.first]
    seen = last(office)
    office.decide(office.first, {one: "reject", two: "keep"}, "Jon", minutes=1)
    mine = [office.wish(three), office.wish(one, "keep"), office.wish(two, "keep")]
    with pytest.raises(StaleVerdict) as caught:
        office.decide(office.first, mine, "Mara", seen=seen, minutes=2)
    assert (caught.value.code, caught.value.status) == ("stale-verdict", 409)
    theirs = {"verdict": "reject", "person": "Jon", "created_at": "2025-06-01T12:01:00Z", "decision_id": seen + 1}
    assert caught.value.details["conflicts"] == [
        {"client_id": mine[1].client_id, "segment_id": one, "yours": "keep", "theirs": theirs}
    ]
    with office.database.read() as session:
        assert session.scalar(select(func.count()).select_from(Decision)) == 2


def test_whoever_has_seen_the_other_verdict_may_overrule_it(small_office) -> None:
    office = small_office
    one = office.segments[office.first][0]
    office.decide(office.first, {one: "reject"}, "Jon")
    stored = office.decide(office.first, {one: "keep"}, "Mara", seen=last(office))
    assert (stored.verdicts.keep, stored.others) == (1, ())
    assert stored.last_decision_id == last(office)


def test_the_answer_tells_what_others_decided_meanwhile(office) -> None:
    one, two, three, _ = office.segments[office.first]
    seen = last(office)
    office.decide(office.first, {one: "reject", two: "keep"}, "Jon")
    office.decide(office.first, {one: "keep"}, "Jon")
    stored = office.decide(office.first, {three: "keep"}, "Mara", seen=seen)
    assert [(other.segment_id, other.verdict, other.person) for other in stored.others] == [
        (two, "keep", "Jon"),
        (one, "keep", "Jon"),
    ]
    assert stored.last_decision_id == last(office) > max(other.decision_id for other in stored.others)


def test_ones_own_decisions_from_another_page_are_never_stale(small_office) -> None:
    one = small_office.segments[small_office.first][0]
    small_office.decide(small_office.first, {one: "reject"}, "Mara")
    assert small_office.decide(small_office.first, {one: "keep"}, "Mara", seen=0).stored == 1


def test_a_repeated_request_is_no_conflict(small_office) -> None:
    office = small_office
    one = office.segments[office.first][0]
    mine = [office.wish(one, "keep")]
    office.decide(office.first, mine, "Mara", seen=0)
    office.decide(office.first, {one: "reject"}, "Jon")
    stored = office.decide(office.first, mine, "Mara", seen=0)
    assert (stored.stored, stored.repeated) == (0, 1)


def test_without_telling_what_was_seen_the_last_one_counts(small_office) -> None:
    one = small_office.segments[small_office.first][0]
    small_office.decide(small_office.first, {one: "reject"}, "Jon")
    assert small_office.decide(small_office.first, {one: "keep"}, "Mara").verdicts.keep == 1


def test_a_verdict_for_a_replaced_candidate_is_held_against_its_successors(small_office) -> None:
    office = small_office
    one, two, *_ = office.segments[office.first]
    with office.database.write() as session:
        old = session.get_one(Segment, one)
        old.retired_at, old.replaced_by_id = office.now, two
    office.decide(office.first, {two: "reject"}, "Jon")
    with pytest.raises(StaleVerdict) as caught:
        office.decide(office.first, {one: "keep"}, "Mara", seen=0)
    assert caught.value.details["conflicts"][0]["segment_id"] == one
