"""When an image may be called done."""

from __future__ import annotations

import pytest
from sqlalchemy import select

from app.db.models import Event, Review
from app.errors import Conflict, InvalidInput, NotFound, UndecidedLeft
from app.services.reviews import set_review


def review(bench, status: str, **fields) -> Review:
    with bench.database.write() as session:
        return set_review(session, bench.images[0], status, now=bench.now, person="owner", **fields)


def test_done_waits_for_every_verdict(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20): "keep"})
    with pytest.raises(UndecidedLeft) as caught:
        review(bench, "done")
    assert (caught.value.code, caught.value.status, caught.value.details) == ("undecided-left", 409, {"undecided": 1})
    bench.decide(image, {bench.at(image, 40): "reject"})
    assert review(bench, "done").status == "done"


def test_done_with_undecided_candidates_when_told_so(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    assert review(bench, "done", allow_undecided=True).status == "done"


def test_an_image_nobody_looked_at_is_not_done(bench) -> None:
    with pytest.raises(Conflict, match="never pre-labelled") as caught:
        review(bench, "done")
    assert caught.value.code == "conflict"
    assert review(bench, "done", allow_undecided=True).status == "done"


def test_an_image_without_candidates_is_done_once_pre_labelled(bench) -> None:
    bench.detect()
    assert review(bench, "done").status == "done"


def test_discarded_keeps_its_reason_until_it_is_opened(small_bench) -> None:
    bench = small_bench
    stored = review(bench, "discarded", reason="  blurred ")
    assert (stored.status, stored.reason, stored.person, stored.updated_at) == (
        "discarded",
        "blurred",
        "owner",
        bench.now,
    )
    assert review(bench, "open").reason is None


def test_each_change_is_in_the_audit_once(bench) -> None:
    for status in ("discarded", "discarded", "open"):
        review(bench, status)
    with bench.database.read() as session:
        events = session.scalars(select(Event).where(Event.kind == "image.reviewed").order_by(Event.id)).all()
    assert [(event.details["from"], event.details["to"]) for event in events] == [
        ("open", "discarded"),
        ("discarded", "open"),
    ]


def test_what_cannot_be_is_refused(small_bench) -> None:
    bench = small_bench
    with pytest.raises(InvalidInput, match="no review status"):
        review(bench, "finished")
    with pytest.raises(InvalidInput, match="too long"):
        review(bench, "discarded", reason="x" * 2001)
    with bench.database.write() as session, pytest.raises(NotFound):
        set_review(session, 999, "open", now=bench.now)
