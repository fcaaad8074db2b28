"""Edits by hand: all or nothing, exactly once, undone and done again, and labels like any other to what comes later."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from threading import Barrier
from typing import Any
from uuid import uuid4

import numpy as np
import pytest
from sqlalchemy import func, select

from app.db.models import Decision, Edit, Image, Review
from app.errors import Conflict, InvalidInput, NotFound, TooLarge
from app.services.deciding import decide
from app.services.decision_batch import Wish
from app.services.edited_points import MOST_POINTS, edited_image, made_polylines
from app.services.edits import store_edit
from app.services.stale_edits import StaleEdit
from app.services.stale_verdicts import StaleVerdict
from app.services.stored_edits import EditGiven, StoredEdit, edits_of_image


def line(y: float, start: float = 10, stop: float = 130) -> np.ndarray:
    x = np.arange(start, stop + 1, dtype=np.float32)
    return np.stack([x, np.full_like(x, y)], axis=1)


def edit(
    bench: Any, kind: str, replaces: tuple[int, ...] = (), *adds: Any, client_id: str | None = None, image: int = 0
) -> StoredEdit:
    given = EditGiven(client_id or str(uuid4()), kind, replaces, adds)
    with bench.database.write() as session:
        return store_edit(session, bench.images[image], given, "owner", bench.now)


def replay(bench: Any, kind: str, stored: StoredEdit, verdict: str = "undecided", *, image: int = 0) -> None:
    bench.decide(bench.images[image], dict.fromkeys(stored.added, verdict), kind=kind, target_group_id=stored.client_id)


def test_a_traced_line_is_a_kept_segment_of_origin_manual(bench) -> None:
    bench.detect(20, 40)
    before = bench.segments(bench.images[0])
    stored = edit(bench, "trace", (), line(80))
    (drawn,) = [entry for entry in bench.segments(bench.images[0]) if entry not in before]
    assert (drawn.id, drawn.origin, drawn.verdict, drawn.score) == (stored.added[0], "manual", "keep", None)
    assert (drawn.n_points, drawn.length, drawn.box) == (121, 120.0, (10.0, 80.0, 130.0, 80.0))
    assert (stored.revision, stored.verdicts.keep, stored.verdicts.undecided) == (2, 1, 2)
    with bench.database.read() as session:
        decision = session.scalars(select(Decision)).one()
        assert (decision.group_id, decision.kind, decision.verdict) == (stored.client_id, "judge", "keep")
        assert stored.last_decision_id == decision.id
        (told,) = edits_of_image(session, bench.images[0])
        assert (told.kind, told.person, told.added, told.undone_at) == ("trace", "owner", list(stored.added), None)


@pytest.mark.parametrize(("verdict", "parts"), [("undecided", "undecided"), ("keep", "keep"), ("reject", "reject")])
def test_the_parts_of_a_cut_have_the_verdict_of_the_whole(bench, verdict, parts) -> None:
    bench.detect(20)
    image = bench.images[0]
    whole = bench.at(image, 20)
    bench.decide(image, {whole: verdict})
    edit(bench, "cut", (whole,), line(20, 10, 60), line(20, 61, 130))
    assert [entry.verdict for entry in bench.segments(image)] == [parts, parts]


@pytest.mark.parametrize(
    ("verdict", "becomes"), [("undecided", "keep"), ("reject", "keep"), ("ambiguous", "ambiguous")]
)
def test_what_a_hand_shapes_is_kept_unless_it_is_not_to_be_scored(small_bench, verdict, becomes) -> None:
    bench = small_bench
    bench.detect(20)
    image = bench.images[0]
    whole = bench.at(image, 20)
    bench.decide(image, {whole: verdict})
    edit(bench, "trim", (whole,), line(20, 10, 100))
    assert [entry.verdict for entry in bench.segments(image)] == [becomes]


def test_the_same_edit_again_changes_nothing_and_another_with_its_id_is_refused(bench) -> None:
    bench.detect(20)
    whole = bench.at(bench.images[0], 20)
    parts = line(20, 10, 60), line(20, 61, 130)
    first = edit(bench, "cut", (whole,), *parts, client_id=str(uuid4()))
    again = edit(bench, "cut", (whole,), *parts, client_id=first.client_id)
    assert again == first
    for other in (
        lambda: edit(bench, "cut", (whole,), *parts[::-1], client_id=first.client_id),
        lambda: edit(bench, "trace", (), line(90), client_id=first.client_id),
        lambda: edit(bench, "cut", (whole,), *parts, client_id=first.client_id, image=1),
    ):
        with pytest.raises(Conflict, match="client_id"):
            other()
    with bench.database.read() as session:
        assert session.scalar(select(func.count(Edit.id))) == 1


def test_undo_and_redo_change_what_is_current_with_the_decisions(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    before = bench.segments(image)
    stored = edit(bench, "join", (before[0].id, before[1].id), line(20))
    after = bench.segments(image)
    replay(bench, "undo", stored)
    assert bench.segments(image) == before
    replay(bench, "undo", stored)  # again, from another tab
    assert bench.segments(image) == before
    replay(bench, "redo", stored, "keep")
    assert bench.segments(image) == after
    with bench.database.read() as session:
        assert session.get_one(Image, image).revision == 4
        assert [row.kind for row in session.scalars(select(Decision).order_by(Decision.id))] == [
            "judge", "undo", "undo", "redo"
        ]  # fmt: skip


def test_a_sent_undo_that_is_sent_again_does_not_undo_what_was_redone(bench) -> None:
    stored = edit(bench, "trace", (), line(20))
    undo = Wish(str(uuid4()), str(uuid4()), stored.added[0], "undecided", "undo", stored.client_id)
    redo = Wish(str(uuid4()), str(uuid4()), stored.added[0], "keep", "redo", stored.client_id)
    for wishes in ([undo], [redo], [undo], [undo, redo]):
        with bench.database.write() as session:
            decide(session, bench.images[0], wishes, "owner", bench.now)
    assert [entry.verdict for entry in bench.segments(bench.images[0])] == ["keep"]


def test_a_segment_that_was_edited_elsewhere_is_not_edited_again(bench) -> None:
    bench.detect(20)
    image = bench.images[0]
    whole = bench.at(image, 20)
    first = edit(bench, "trim", (whole,), line(20, 10, 100))
    with pytest.raises(StaleEdit) as error:
        edit(bench, "trim", (whole,), line(20, 10, 90))
    details = error.value.as_dict()["details"]
    assert details["stale"] == [whole]
    assert details["current"][0]["replaced_by"] == list(first.added)
    second = edit(bench, "trim", first.added, line(20, 10, 50))
    with pytest.raises(StaleEdit):  # the other edit builds on it
        replay(bench, "undo", first)
    replay(bench, "undo", second)
    replay(bench, "undo", first)
    edit(bench, "cut", (whole,), line(20, 10, 60), line(20, 61, 130))
    with pytest.raises(StaleEdit):  # what it replaced was cut meanwhile
        replay(bench, "redo", first, "keep")
    assert len(bench.segments(image)) == 2


def test_a_late_verdict_does_not_bring_back_what_was_edited_away(bench) -> None:
    bench.detect(20)
    image = bench.images[0]
    whole = bench.at(image, 20)
    stored = edit(bench, "trim", (whole,), line(20, 10, 100))
    bench.decide(image, {whole: "keep"})
    assert [entry.id for entry in bench.segments(image)] == list(stored.added)
    replay(bench, "undo", stored)
    assert [(entry.id, entry.verdict) for entry in bench.segments(image)] == [(whole, "keep")]
    bench.decide(image, {stored.added[0]: "ambiguous"})
    assert [entry.id for entry in bench.segments(image)] == [whole]


def test_a_later_run_leaves_what_was_drawn_and_does_not_find_it_twice(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    cut = edit(bench, "trim", (bench.at(image, 40),), line(40, 10, 120))
    drawn = edit(bench, "trace", (), line(80))
    bench.detect(20, 40, 80)
    assert {(entry.box[1], entry.origin) for entry in bench.segments(image)} == {
        (20.0, "pipeline"),
        (40.0, "manual"),
        (80.0, "manual"),
    }
    replay(bench, "undo", drawn)
    replay(bench, "undo", cut)
    assert sorted(entry.box[1] for entry in bench.segments(image)) == [20.0, 40.0]


def test_a_later_run_does_not_propose_anew_what_was_shaped(bench) -> None:
    bench.detect(20)
    image = bench.images[0]
    first = edit(bench, "trim", (bench.at(image, 20),), line(20, 10, 60))
    second = edit(bench, "cut", first.added, line(20, 10, 30), line(20, 31, 60))
    bench.detect(20, 40)
    assert [(entry.box[1], entry.length, entry.origin) for entry in bench.segments(image)] == [
        (40, 120, "pipeline"),
        (20, 20, "manual"),
        (20, 29, "manual"),
    ]
    replay(bench, "undo", second)
    replay(bench, "undo", first)
    assert sorted((entry.box[1], entry.length) for entry in bench.segments(image)) == [(20, 120), (40, 120)]
    bench.detect(20, 40)  # an edit that is undone holds nothing back
    assert sorted((entry.box[1], entry.length) for entry in bench.segments(image)) == [(20, 120), (40, 120)]


def test_an_undecided_part_opens_a_finished_image_again(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    image = bench.images[0]
    with bench.database.write() as session:
        session.get_one(Review, image).status = "done"
    assert edit(bench, "trace", (), line(90)).status == "done"
    stored = edit(bench, "cut", (bench.at(image, 20),), line(20, 10, 60), line(20, 61, 130))
    assert (stored.status, stored.verdicts.undecided) == ("open", 2)


@pytest.mark.parametrize(
    ("kind", "adds", "error", "where"),
    [
        ("trace", (), InvalidInput, "adds"),
        ("trace", (line(20), line(30)), InvalidInput, "adds"),
        ("trace", (line(20)[:1],), InvalidInput, "adds[0]"),
        ("trace", (np.array([[1, 2], [np.nan, 3]], np.float32),), InvalidInput, "adds[0][1]"),
        ("trace", (line(200),), InvalidInput, "adds[0][0]"),
        ("trace", (line(20, 190, 205),), InvalidInput, "adds[0][10]"),
        ("trace", (np.array([[5, 5], [5, 5.2]], np.float32),), InvalidInput, "adds[0]"),
        ("trace", (np.zeros((MOST_POINTS + 1, 2), np.float32),), TooLarge, "adds"),
        ("trim", (line(20),), InvalidInput, "replaces"),
        ("join", (line(20),), InvalidInput, "replaces"),
    ],
)
def test_what_makes_no_edit_is_refused_and_nothing_is_stored(small_bench, kind, adds, error, where) -> None:
    with pytest.raises(error) as raised:
        edit(small_bench, kind, (), *adds)
    assert raised.value.where == where
    assert small_bench.segments(small_bench.images[0]) == ()


def test_segments_of_other_images_are_not_edited(small_bench) -> None:
    bench = small_bench
    bench.detect(20)
    other = bench.at(bench.images[1], 20)
    with pytest.raises(InvalidInput, match="isn't of image"):
        edit(bench, "trim", (other,), line(20, 10, 50))
    with bench.database.read() as session:
        with pytest.raises(InvalidInput, match="isn't of image"):
            edited_image(session, bench.images[0], [other])
        with pytest.raises(NotFound):
            edited_image(session, 10_000)


def test_edits_are_made_of_what_they_replace() -> None:
    def trace(points: np.ndarray, how: str) -> np.ndarray:
        return line(20, 5, 140) if how == "extend" else line(20, points[0, 0], points[1, 0])

    def made(kind: str, *polylines: np.ndarray, at: tuple[float, float] | None = None) -> list[list[float]]:
        found = made_polylines(kind, polylines, at, trace)
        return [[float(points[0, 0]), float(points[-1, 0])] for points in found]

    assert made("cut", line(20), at=(59.6, 22)) == [[10, 59], [60, 130]]
    assert made("trim", line(20), at=(99.6, 22)) == [[10, 99]]
    assert made("extend", line(20)) == [[5, 140]]
    assert made("join", line(20, 80, 130), line(20, 10, 60)) == [[10, 130]]
    assert len(made_polylines("join", (line(20, 10, 60), line(20, 80, 130)), None, trace)[0]) == 121
    for kind in ("cut", "trim"):
        with pytest.raises(InvalidInput, match="missing"):
            made(kind, line(20))
    with pytest.raises(InvalidInput, match="traced line"):
        made("trace")


def test_of_two_edits_at_the_same_moment_one_is_told_of_the_other(bench) -> None:
    bench.detect(20)
    whole = bench.at(bench.images[0], 20)
    start = Barrier(2)

    def cut(place: float) -> StoredEdit | StaleEdit:
        start.wait()
        try:
            return edit(bench, "cut", (whole,), line(20, 10, place), line(20, place + 1, 130))
        except StaleEdit as error:
            return error

    with ThreadPoolExecutor(2) as threads:
        outcomes = list(threads.map(cut, [50.0, 90.0]))
    (won,) = [outcome for outcome in outcomes if isinstance(outcome, StoredEdit)]
    (lost,) = [outcome for outcome in outcomes if isinstance(outcome, StaleEdit)]
    assert lost.details["current"][0]["replaced_by"] == list(won.added)
    assert [entry.id for entry in bench.segments(bench.images[0])] == list(won.added)


@pytest.mark.parametrize("kind", ["trim", "cut"])
def test_an_edit_that_would_overrule_an_unseen_verdict_is_refused(bench, kind) -> None:
    bench.detect(20)
    image = bench.images[0]
    whole = bench.at(image, 20)
    bench.decide(image, {whole: "reject"})
    adds = (line(20, 10, 60), line(20, 61, 130)) if kind == "cut" else (line(20, 10, 60),)
    given = EditGiven(str(uuid4()), kind, (whole,), adds, seen=0)
    if kind == "cut":  # the parts are rejected as the whole is: nobody is overruled
        with bench.database.write() as session:
            assert store_edit(session, image, given, "Jon", bench.now).verdicts.reject == 2
        return
    with pytest.raises(StaleVerdict) as caught, bench.database.write() as session:
        store_edit(session, image, given, "Jon", bench.now)
    (conflict,) = caught.value.details["conflicts"]
    assert (conflict["segment_id"], conflict["yours"], conflict["theirs"]["verdict"]) == (whole, "keep", "reject")
    assert [entry.id for entry in bench.segments(image)] == [whole]
    seen = replace(given, seen=conflict["theirs"]["decision_id"])
    with bench.database.write() as session:
        assert store_edit(session, image, seen, "Jon", bench.now).verdicts.keep == 1
