"""A second person reviews a share of the images and is told nothing of the first review."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

import pytest
from sqlalchemy import select

from app.api.schemas.second_reviews import SecondReviewsAnswer, SecondSegmentsAnswer
from app.db.models import Decision, Segment, SegmentState
from app.errors import Conflict, Forbidden, InvalidInput, NotFound, UndecidedLeft
from app.services.dataset_rules import Rules, change_rules
from app.services.second_reviews import (
    NotBlind,
    SecondReviews,
    SecondReviewTaken,
    own_second_review,
    second_reviews_of,
    set_second_review,
    start_second_review,
)
from app.services.second_verdicts import decide_second, second_history, second_segments


def set_share(office, share: float) -> None:
    with office.database.write() as session:
        change_rules(session, "street", office.now, rules=Rules(second_share=share))


def listed(office, person: str) -> SecondReviews:
    with office.database.read() as session:
        return second_reviews_of(session, office.dataset(session), person)


def begin(office, image_id: int, person: str) -> int:
    with office.database.write() as session:
        return start_second_review(session, image_id, person, office.now).id


def decide(office, number: int, wishes: list[Any], person: str = "Jon") -> Any:
    with office.database.write() as session:
        review, _ = own_second_review(session, number, person, lock=True)
        return decide_second(session, review, wishes, person, office.now)


def verdicts(office, number: int, person: str = "Jon") -> list[str]:
    with office.database.read() as session:
        review, _ = own_second_review(session, number, person)
        return [segment.verdict for segment in second_segments(session, review).segments]


@pytest.mark.parametrize(("share", "due"), [(0.0, 0), (0.01, 1), (0.3, 1), (0.4, 2), (0.7, 3), (1.0, 3)])
def test_which_images_are_due_follows_from_their_content(small_office, share, due) -> None:
    office = small_office
    for image_id in office.images:
        office.finish(image_id, "krrr")
    set_share(office, share)
    found = listed(office, "Jon")
    assert [image.image_id for image in found.due] == list(office.images[:due])
    assert (found.due_total, found.share) == (due, share)


def test_due_are_only_images_that_somebody_else_has_done(office) -> None:
    set_share(office, 1.0)
    first, second, _ = office.images
    office.finish(first, "krrr", "Mara")
    office.decide(second, {office.segments[second][0]: "keep"}, "Jon")
    assert [image.image_id for image in listed(office, "Jon").due] == [first]
    assert listed(office, "Mara").due == ()
    begin(office, first, "Jon")
    again = listed(office, "Jon")
    assert again.due == ()
    assert [(entry.image_id, entry.mine, entry.status) for entry in again.reviews] == [(first, True, "open")]
    assert not listed(office, "Mara").reviews[0].mine


def test_who_had_a_part_in_the_first_review_cannot_do_the_second(small_office) -> None:
    office = small_office
    office.decide(office.first, {office.segments[office.first][0]: "keep"}, "Lee")
    office.finish(office.first, "krrr", "Mara")
    for person in ("Lee", "Mara"):
        with pytest.raises(NotBlind) as caught:
            begin(office, office.first, person)
        assert caught.value.code == "not-blind"
    assert begin(office, office.first, "Jon") == begin(office, office.first, "Jon")
    with pytest.raises(SecondReviewTaken) as taken:
        begin(office, office.first, "Ann")
    assert taken.value.code == "second-review-taken"


def test_there_is_no_second_review_before_the_first_is_done(small_office) -> None:
    with pytest.raises(Conflict, match="isn't done"):
        begin(small_office, small_office.first, "Jon")


def test_nothing_of_the_first_review_is_in_any_answer(small_office) -> None:
    office = small_office
    set_share(office, 1.0)
    office.finish(office.first, "karr", "Mara")
    with office.database.write() as session:
        drawn = session.get_one(Segment, office.segments[office.first][0])
        drawn.origin = "manual"
    number = begin(office, office.first, "Jon")
    with office.database.read() as session:
        review, _ = own_second_review(session, number, "Jon")
        segments = SecondSegmentsAnswer.model_validate(second_segments(session, review)).model_dump(mode="json")
        due = SecondReviewsAnswer.model_validate(second_reviews_of(session, office.dataset(session), "Jon"))
    assert [segment["id"] for segment in segments["segments"]] == office.segments[office.first][1:]  # nothing drawn
    assert [segment["verdict"] for segment in segments["segments"]] == ["undecided"] * 3
    told = json.dumps([segments, due.model_dump(mode="json")])
    assert [word for word in ("keep", "reject", "ambiguous", "manual", "Mara", "reason") if word in told] == []


def test_its_decisions_follow_the_rules_of_the_first(office) -> None:
    office.finish(office.first, "krrr")
    number = begin(office, office.first, "Jon")
    one, two, *_ = office.segments[office.first]
    judged = [office.wish(one, "reject"), office.wish(two, "keep", elapsed_ms=300)]
    stored = decide(office, number, judged)
    assert (stored.stored, stored.verdicts.keep, stored.verdicts.undecided, stored.status) == (2, 1, 2, "open")
    assert decide(office, number, judged).repeated == 2
    undone = office.wish(two, "undecided", kind="undo", target_group_id=judged[1].group_id)
    decide(office, number, [undone])
    assert verdicts(office, number) == ["reject", "undecided", "undecided", "undecided"]
    with office.database.read() as session:
        review, _ = own_second_review(session, number, "Jon")
        rows = second_history(session, review)
        assert [(row.previous, row.verdict, row.kind) for row in rows] == [
            ("undecided", "reject", "judge"),
            ("undecided", "keep", "judge"),
            ("keep", "undecided", "undo"),
        ]
        first = session.scalars(select(SegmentState.verdict).order_by(SegmentState.segment_id)).all()
        assert (first, session.scalar(select(Decision.id).where(Decision.person == "Jon"))) == (
            ["keep", "reject", "reject", "reject"],
            None,
        )


def test_decisions_that_cannot_be_are_refused(small_office) -> None:
    office = small_office
    office.finish(office.first, "krrr")
    number = begin(office, office.first, "Jon")
    one = office.segments[office.first][0]
    foreign = office.segments[office.images[1]][0]
    first_group = office.wish(one).group_id
    office.decide(office.first, [office.wish(one, "keep", group_id=first_group)])
    refused = [
        office.wish(foreign),
        office.wish(one, kind="accept"),
        office.wish(one, kind="undo", target_group_id=first_group),
    ]
    for given in refused:
        with pytest.raises(InvalidInput):
            decide(office, number, [given])
    with pytest.raises(Forbidden):
        decide(office, number, [office.wish(one)], "Mara")
    with pytest.raises(NotFound):
        decide(office, 999, [office.wish(one)])


def test_done_waits_for_every_verdict_and_ends_it(small_office) -> None:
    office = small_office
    office.finish(office.first, "krrr")
    number = office.second(office.first, "krr", done=False)

    def finish(status: str = "done", **fields: Any) -> str:
        with office.database.write() as session:
            return set_second_review(session, number, status, "Jon", office.now, **fields).status

    with pytest.raises(UndecidedLeft) as caught:
        finish()
    assert caught.value.details == {"undecided": 1}
    last = office.segments[office.first][3]
    decide(office, number, [office.wish(last, "reject")])
    assert finish() == "done"
    with pytest.raises(Conflict, match="is done"):
        decide(office, number, [office.wish(last, "keep")])
    assert finish("open") == "open"
    assert decide(office, number, [office.wish(last, "keep")]).verdicts.keep == 2


def test_rules_of_a_dataset(small_office) -> None:
    office = small_office
    with office.database.write() as session:
        changed = change_rules(session, "street", office.now, guidelines=" Keep poles. ", rules=Rules(0.1, True))
        assert (changed.guidelines, changed.rules) == ("Keep poles.", asdict(Rules(0.1, True)))
        with pytest.raises(InvalidInput):
            change_rules(session, "street", office.now, rules=Rules(1.5))
