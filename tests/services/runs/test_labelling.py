"""Candidates as the label page reads them, and decisions that arrive exactly once."""

from __future__ import annotations

import struct
from uuid import uuid4

import numpy as np
import pytest
from sqlalchemy import func, select

from app.db.models import Decision, Image, Review, Segment, SegmentState
from app.errors import Conflict, InvalidInput, NotFound, TooLarge
from app.services.deciding import decide
from app.services.decision_batch import MOST_DECISIONS, Wish
from app.services.labelling import history, points_of_image, segments_of_image


def wish(segment_id: int, verdict: str = "keep", **fields) -> Wish:
    return Wish(str(uuid4()), fields.pop("group_id", str(uuid4())), segment_id, verdict, **fields)


def test_segments_tell_all_but_points(bench) -> None:
    bench.detect(20, 40)
    with bench.database.read() as session:
        image = segments_of_image(session, bench.images[0])
    assert (image.revision, image.width, image.height) == (1, 200, 160)
    first, second = image.segments
    assert (first.ordinal, first.n_points, first.length, first.box) == (0, 121, 120.0, (10.0, 20.0, 130.0, 20.0))
    assert first.score == pytest.approx(0.2)
    assert (first.verdict, first.origin, first.straightness, first.straight) == ("undecided", "pipeline", None, True)
    assert second.box[1] == 40.0


def test_what_fails_straightness_is_marked(small_bench) -> None:
    bench = small_bench
    bench.detect(20, 40, 60)
    with bench.database.write() as session:
        for segment, value in zip(
            session.scalars(select(Segment).order_by(Segment.id).limit(3)), (0.49, 0.5, 0.9), strict=True
        ):
            segment.straightness = value
    assert [entry.straight for entry in bench.segments(bench.images[0])] == [False, True, True]


def test_points_are_those_of_the_segments_in_their_order(bench) -> None:
    bench.detect(20, 40, 60)
    with bench.database.read() as session:
        entries = segments_of_image(session, bench.images[1]).segments
        content = points_of_image(session, bench.images[1])
    magic, revision, count, total = struct.unpack_from("<4sIII", content)
    assert (magic, revision, count, total) == (b"CLP1", 1, 3, 363)
    ids = np.frombuffer(content, "<u4", count, 16)
    offsets = np.frombuffer(content, "<u4", count + 1, 16 + 4 * count)
    points = np.frombuffer(content, "<f4", 2 * total, 16 + 4 * (2 * count + 1)).reshape(-1, 2)
    assert len(content) == 16 + 4 * (2 * count + 1) + 8 * total
    assert ids.tolist() == [entry.id for entry in entries]
    assert np.diff(offsets).tolist() == [entry.n_points for entry in entries]
    for entry, start in zip(entries, offsets[:-1], strict=True):
        assert points[start].tolist() == [10.0, entry.box[1]]


def test_an_image_without_segments_has_an_empty_answer(small_bench) -> None:
    bench = small_bench
    with bench.database.read() as session:
        content = points_of_image(session, bench.images[0])
    assert content == struct.pack("<4sIIII", b"CLP1", 0, 0, 0, 0)


@pytest.mark.parametrize("read", [segments_of_image, points_of_image, history])
def test_a_deleted_image_has_no_segments_to_read(small_bench, read) -> None:
    bench = small_bench
    with bench.database.write() as session:
        session.get_one(Image, bench.images[0]).deleted_at = bench.now
    with bench.database.read() as session, pytest.raises(NotFound):
        read(session, bench.images[0])


def test_decisions_change_verdicts_and_stay_as_history(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    first, second = (entry.id for entry in bench.segments(image))
    stored = bench.decide(image, {first: "keep", second: "reject"}, elapsed_ms=640)
    assert (stored.stored, stored.repeated, stored.status) == (2, 0, "open")
    assert (stored.verdicts.keep, stored.verdicts.reject, stored.verdicts.undecided) == (1, 1, 0)
    again = bench.decide(image, {first: "ambiguous"})
    assert (again.verdicts.keep, again.verdicts.ambiguous) == (0, 1)
    with bench.database.read() as session:
        rows = history(session, image)
        row = session.get_one(Image, image)
    assert [(row.segment_id, row.previous, row.verdict, row.elapsed_ms, row.person) for row in rows] == [
        (first, "undecided", "keep", 640, "owner"),
        (second, "undecided", "reject", 640, "owner"),
        (first, "keep", "ambiguous", None, "owner"),
    ]
    assert (row.n_candidates, row.n_keep, row.n_reject, row.n_ambiguous, row.revision) == (2, 0, 1, 1, 1)


def test_one_request_may_decide_twice_on_a_segment(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    with bench.database.write() as session:
        decide(session, image, [wish(segment, "keep"), wish(segment, "reject")], None, bench.now)
    with bench.database.read() as session:
        assert [(row.previous, row.verdict) for row in history(session, image)] == [
            ("undecided", "keep"),
            ("keep", "reject"),
        ]
    assert bench.by_height(image) == {20.0: "reject"}


def test_a_decision_sent_again_changes_nothing(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    first, second = (entry.id for entry in bench.segments(image))
    sent = [wish(first), wish(second)]
    for expected in ((2, 0), (0, 2)):
        with bench.database.write() as session:
            stored = decide(session, image, sent, "owner", bench.now)
        assert (stored.stored, stored.repeated) == expected
    with bench.database.write() as session:
        stored = decide(session, image, [*sent, wish(first, "reject"), sent[0]], "owner", bench.now)
    assert (stored.stored, stored.repeated) == (1, 3)
    with bench.database.read() as session:
        assert session.scalar(select(func.count()).select_from(Decision)) == 3
    assert bench.by_height(image) == {20.0: "reject", 40.0: "keep"}


@pytest.mark.parametrize("field", [{"verdict": "reject"}, {"segment_id": None}, {"group_id": str(uuid4())}])
def test_a_client_id_with_other_content_is_a_conflict(small_bench, field) -> None:
    bench = small_bench
    bench.detect(20, 40)
    image = bench.images[0]
    first, second = (entry.id for entry in bench.segments(image))
    sent = wish(first)
    fields = {"segment_id": first, "verdict": "keep", "group_id": sent.group_id, **field}
    fields["segment_id"] = fields["segment_id"] or second
    other = Wish(client_id=sent.client_id, **fields)
    with bench.database.write() as session:
        decide(session, image, [sent], "owner", bench.now)
    with pytest.raises(Conflict) as caught, bench.database.write() as session:
        decide(session, image, [wish(second), other], "owner", bench.now)
    assert caught.value.where == "decisions[1].client_id"
    assert bench.by_height(image) == {20.0: "keep", 40.0: "undecided"}


def test_a_segment_of_another_image_stops_all(bench) -> None:
    bench.detect(20)
    here, there = (bench.segments(image)[0].id for image in bench.images)
    with pytest.raises(InvalidInput, match=f"segment {there}"), bench.database.write() as session:
        decide(session, bench.images[0], [wish(here), wish(there)], "owner", bench.now)
    assert bench.by_height(bench.images[0]) == {20.0: "undecided"}


@pytest.mark.parametrize(
    ("fields", "where"),
    [
        ({"verdict": "maybe"}, "verdict"),
        ({"kind": "carry"}, "kind"),
        ({"kind": "undo"}, "target_group_id"),
        ({"target_group_id": str(uuid4())}, "target_group_id"),
        ({"kind": "undo", "target_group_id": str(uuid4())}, "target_group_id"),
        ({"group_id": "mine"}, "group_id"),
    ],
)
def test_decisions_that_cannot_be_are_refused(small_bench, fields, where) -> None:
    bench = small_bench
    bench.detect(20)
    segment = bench.segments(bench.images[0])[0].id
    with pytest.raises(InvalidInput) as caught, bench.database.write() as session:
        decide(session, bench.images[0], [wish(segment, **fields)], "owner", bench.now)
    assert where in str(caught.value.where)


def test_the_number_of_decisions_is_bounded(small_bench) -> None:
    bench = small_bench
    with pytest.raises(InvalidInput), bench.database.write() as session:
        decide(session, bench.images[0], [], "owner", bench.now)
    many = [wish(1)] * (MOST_DECISIONS + 1)
    with pytest.raises(TooLarge), bench.database.write() as session:
        decide(session, bench.images[0], many, "owner", bench.now)


def test_undo_and_redo_name_the_group_they_are_about(bench) -> None:
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    judged = wish(segment, "keep")
    undone = wish(segment, "undecided", kind="undo", target_group_id=judged.group_id)
    redone = wish(segment, "keep", kind="redo", target_group_id=judged.group_id)
    for sent in ([judged, undone], [redone]):
        with bench.database.write() as session:
            decide(session, image, sent, "owner", bench.now)
    with bench.database.read() as session:
        rows = history(session, image)
    assert [(row.kind, row.target_group_id == judged.group_id) for row in rows] == [
        ("judge", False),
        ("undo", True),
        ("redo", True),
    ]
    assert bench.by_height(image) == {20.0: "keep"}


def test_a_verdict_taken_back_opens_a_done_image(bench) -> None:
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    bench.decide(image, {segment: "keep"})
    with bench.database.write() as session:
        session.get_one(Review, image).status = "done"
    assert bench.decide(image, {segment: "reject"}).status == "done"
    assert bench.decide(image, {segment: "undecided"}).status == "open"


def test_the_state_names_its_decision(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    bench.decide(image, {segment: "keep"})
    bench.decide(image, {segment: "reject"})
    with bench.database.read() as session:
        state = session.get_one(SegmentState, segment)
        assert session.get_one(Decision, state.decision_id).verdict == state.verdict == "reject"


def test_two_thousand_candidates_are_rejected_with_one_request(bench) -> None:
    bench.detect(*np.linspace(0, 150, 2000).tolist())
    image = bench.images[0]
    ids = [entry.id for entry in bench.segments(image)]
    assert len(ids) == 2000
    stored = bench.decide(image, dict.fromkeys(ids, "reject"))
    assert (stored.stored, stored.verdicts.reject, stored.verdicts.undecided) == (2000, 2000, 0)
