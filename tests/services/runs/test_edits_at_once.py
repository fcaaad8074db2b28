"""Edits, decisions and reviews beside one another: what one read before it waited for the other counts no more."""

from __future__ import annotations

from uuid import uuid4

import numpy as np
import pytest
from sqlalchemy import update

from app.db.models import Image
from app.errors import UndecidedLeft
from app.services.deciding import decide
from app.services.decision_batch import Wish
from app.services.edits import store_edit
from app.services.images import get_image
from app.services.reviews import set_review
from app.services.stored_edits import EditGiven


def traced(y: float) -> EditGiven:
    x = np.arange(10, 131, dtype=np.float32)
    return EditGiven(str(uuid4()), "trace", (), (np.stack([x, np.full_like(x, y)], axis=1),))


def test_revisions_rise_by_one_for_each_of_two_edits_side_by_side(bench) -> None:
    if bench.database.is_sqlite:
        pytest.skip("on SQLite nobody writes between a writer's look and its change")
    image = bench.images[0]
    with bench.database.write() as slow:
        held = get_image(slow, image)  # as whoever calls store_edit may hold it
        with bench.database.write() as quick:
            store_edit(quick, image, traced(20), "Jon", bench.now)
        assert store_edit(slow, image, traced(40), "Mara", bench.now).revision == held.revision == 2


def test_an_image_is_not_done_by_counts_from_before_another_change(bench) -> None:
    if bench.database.is_sqlite:
        pytest.skip("on SQLite nobody writes between a writer's look and its change")
    image = bench.images[0]
    bench.detect(20)
    bench.decide(image, {bench.at(image, 20): "keep"})
    with bench.database.write() as slow:
        held = get_image(slow, image)
        bench.decide(image, {bench.at(image, 20): "undecided"})
        with pytest.raises(UndecidedLeft):
            set_review(slow, image, "done", now=bench.now)
        assert held.n_keep == 0


def test_a_late_verdict_raises_the_revision_that_is(bench) -> None:
    if bench.database.is_sqlite:
        pytest.skip("on SQLite nobody writes between a writer's look and its change")
    image = bench.images[0]
    bench.detect(20)
    gone = bench.at(image, 20)
    bench.detect(100)  # finds nothing there
    with bench.database.write() as slow:
        held = get_image(slow, image)
        with bench.database.write() as quick:
            quick.execute(update(Image).where(Image.id == image).values(revision=40))
        decide(slow, image, [Wish(str(uuid4()), str(uuid4()), gone, "keep")], "owner", bench.now)
        assert held.revision == 41
    with bench.database.read() as session:
        assert session.get_one(Image, image).revision == 41


@pytest.mark.parametrize(("kinds", "heights"), [("uru", []), ("ur", [20.0]), ("uur", [20.0]), ("uruur", [20.0])])
def test_undo_and_redo_that_arrive_together_count_in_their_order(small_bench, kinds, heights) -> None:
    bench = small_bench
    image = bench.images[0]
    with bench.database.write() as session:
        stored = store_edit(session, image, traced(20), "owner", bench.now)
        group = str(uuid4())
    moves = {"u": ("undecided", "undo"), "r": ("keep", "redo")}
    wishes = [
        Wish(str(uuid4()), group, stored.added[0], verdict, kind, stored.client_id)
        for verdict, kind in (moves[letter] for letter in kinds)
    ]
    with bench.database.write() as session:
        decide(session, image, wishes, "owner", bench.now)
    assert [entry.box[1] for entry in bench.segments(image)] == heights


def test_an_edit_reads_no_other_images_decisions(small_bench, count_queries) -> None:
    bench = small_bench
    with count_queries(bench.database) as statements, bench.database.write() as session:
        store_edit(session, bench.images[0], traced(20), "owner", bench.now)
    asked = [each for each in statements if each.startswith("SELECT") and "FROM decisions" in each]
    assert asked
    with bench.database.read() as session:
        for each in asked:
            plan = session.connection().exec_driver_sql(f"EXPLAIN QUERY PLAN {each}", ("1",) * each.count("?")).all()
            assert not [row for row in plan if row[3].startswith("SCAN")], each
