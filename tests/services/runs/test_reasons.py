"""Why a candidate was rejected: stored with its decision, shown with the candidate, carried to a new run's."""

from __future__ import annotations

from uuid import uuid4

import pytest

from app.errors import Conflict, InvalidInput
from app.services.deciding import decide
from app.services.decision_batch import Wish
from app.services.labelling import history
from app.verdicts import REASONS


def wish(segment_id: int, verdict: str = "reject", **fields) -> Wish:
    return Wish(str(uuid4()), fields.pop("group_id", str(uuid4())), segment_id, verdict, **fields)


def reasons(bench, image: int) -> dict[float, str | None]:
    return {entry.box[1]: entry.reason for entry in bench.segments(image)}


def test_a_reason_stands_until_the_next_decision(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    first, second = (entry.id for entry in bench.segments(image))
    bench.decide(image, {first: "reject"}, reason="car")
    bench.decide(image, {second: "reject"})
    assert reasons(bench, image) == {20.0: "car", 40.0: None}
    bench.decide(image, {first: "reject"}, reason="shadow")
    assert reasons(bench, image)[20.0] == "shadow"
    bench.decide(image, {first: "keep"})
    assert reasons(bench, image)[20.0] is None
    with bench.database.read() as session:
        assert [row.reason for row in history(session, image)] == ["car", None, "shadow", None]


def test_undo_and_redo_say_which_reason_stands(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    rejected = wish(segment, reason="curved")
    taken_back = wish(segment, "undecided", kind="undo", target_group_id=rejected.group_id)
    again = wish(segment, kind="redo", target_group_id=rejected.group_id, reason="curved")
    for sent, expected in ((rejected, "curved"), (taken_back, None), (again, "curved")):
        with bench.database.write() as session:
            decide(session, image, [sent], "owner", bench.now)
        assert reasons(bench, image)[20.0] == expected


@pytest.mark.parametrize("reason", REASONS)
def test_only_a_rejection_has_a_reason(small_bench, reason) -> None:
    bench = small_bench
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    with pytest.raises(InvalidInput) as caught, bench.database.write() as session:
        decide(session, image, [wish(segment, "keep", reason=reason)], "owner", bench.now)
    assert caught.value.where == "decisions[0].reason"


def test_an_unknown_reason_is_refused(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    with pytest.raises(InvalidInput, match="'rain' can't be the reason"), bench.database.write() as session:
        decide(session, image, [wish(segment, reason="rain")], "owner", bench.now)


@pytest.mark.parametrize("field", [{"reason": "car"}, {"suggestion": 0.25}])
def test_another_reason_under_a_known_client_id_is_a_conflict(small_bench, field) -> None:
    bench = small_bench
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    sent = wish(segment)
    with bench.database.write() as session:
        decide(session, image, [sent], "owner", bench.now)
    other = Wish(sent.client_id, sent.group_id, segment, "reject", **field)
    with pytest.raises(Conflict), bench.database.write() as session:
        decide(session, image, [other], "owner", bench.now)


def test_a_new_run_carries_reasons(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    bench.decide(image, {bench.at(image, 20.0): "reject"}, reason="lane_marking")
    bench.detect(20, 40)
    assert reasons(bench, image) == {20.0: "lane_marking", 40.0: None}


def test_a_late_reason_goes_over_to_the_successor(small_bench) -> None:
    bench = small_bench
    bench.detect(20, 40)
    image = bench.images[0]
    replaced = bench.at(image, 20.0)
    bench.detect(20, 40)
    bench.decide(image, {replaced: "reject"}, reason="shadow")
    assert reasons(bench, image) == {20.0: "shadow", 40.0: None}


@pytest.mark.parametrize("kind", ["accept", "take_over"])
def test_what_was_accepted_is_told_from_what_was_judged(bench, kind) -> None:
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    bench.decide(image, {segment: "keep"}, kind=kind, suggestion=0.75)
    with bench.database.read() as session:
        (row,) = history(session, image)
    assert (row.kind, row.verdict, row.suggestion) == (kind, "keep", 0.75)
    assert bench.by_height(image) == {20.0: "keep"}


@pytest.mark.parametrize("kind", ["accept", "take_over"])
def test_only_a_replay_names_another_group(small_bench, kind) -> None:
    bench = small_bench
    bench.detect(20)
    image, segment = bench.images[0], bench.segments(bench.images[0])[0].id
    with pytest.raises(InvalidInput, match="undo and redo"), bench.database.write() as session:
        decide(session, image, [wish(segment, kind=kind, target_group_id=str(uuid4()))], "owner", bench.now)
