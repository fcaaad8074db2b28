from __future__ import annotations

import random

import pytest
from sqlalchemy import select

from app.db.models import Decision, Image, Run, RunImage, Segment, SegmentState
from app.services.candidates import current_segments, refresh_counts


def current(place, image_id: int) -> list[tuple[int, str]]:
    with place.database.read() as session:
        return [
            (segment.id, verdict)
            for segment, verdict in session.execute(current_segments().where(Segment.image_id == image_id))
        ]


def decide(session, segment: Segment, verdict: str, number: int, now) -> None:
    decision = Decision(
        image_id=segment.image_id,
        segment_id=segment.id,
        verdict=verdict,
        previous="undecided",
        kind="judge",
        client_id=f"{number:036}",
        group_id="g",
        created_at=now,
    )
    session.add(decision)
    session.flush()
    session.merge(SegmentState(segment_id=segment.id, verdict=verdict, decision_id=decision.id))


def test_order_is_pipeline_then_manual_then_import(place) -> None:
    image_id = place.image(place.dataset(), "a")
    imported = place.label(image_id, ["keep", "reject"])
    place.run([image_id], candidates=2)
    with place.database.write() as session:
        pipeline = [row.id for row in session.query(Segment).filter_by(origin="pipeline").order_by(Segment.ordinal)]
        manual = Segment(
            image_id=image_id, ordinal=0, n_points=1, points=bytes(8), x0=0, y0=0, x1=0, y1=0, length=0, origin="manual"
        )
        session.add(manual)
        session.flush()
        manual_id = manual.id
    assert [segment_id for segment_id, _ in current(place, image_id)] == [*pipeline, manual_id, *imported]


def test_of_a_deleted_run_only_decided_segments_stay(place) -> None:
    image_id = place.image(place.dataset(), "a")
    run_id = place.run([image_id], candidates=3)
    with place.database.write() as session:
        first, second, _ = session.query(Segment).order_by(Segment.ordinal)
        decide(session, first, "reject", 1, place.now)
        decide(session, second, "undecided", 2, place.now)
        session.get_one(Run, run_id).deleted_at = place.now
        refresh_counts(session, [image_id])
        kept = first.id
    assert current(place, image_id) == [(kept, "reject")]
    with place.database.read() as session:
        image = session.get_one(Image, image_id)
        assert (image.n_candidates, image.n_reject, image.n_keep) == (1, 1, 0)


def test_retired_segments_are_gone_whatever_was_decided(place) -> None:
    image_id = place.image(place.dataset(), "a")
    place.label(image_id, ["keep", "reject"])
    with place.database.write() as session:
        for segment in session.query(Segment):
            segment.retired_at = place.now
        refresh_counts(session, [image_id])
        assert session.get_one(Image, image_id).n_candidates == 0
    assert current(place, image_id) == []


@pytest.mark.parametrize("seed", range(4))
def test_counts_are_the_current_segments(place, seed) -> None:
    """Whatever happened to segments, verdicts and runs: the counts in the rows equal a count from scratch."""
    chance = random.Random(seed)
    slug = place.dataset()
    ids = place.images(slug, "a", "b", "c", "d")
    runs = [place.run(chance.sample(ids, 3), candidates=chance.randint(1, 4)) for _ in range(4)]
    place.label(ids[0], ["keep", "undecided", "ambiguous"])
    with place.database.write() as session:
        for number, segment in enumerate(session.query(Segment).order_by(Segment.id).all()):
            if chance.random() < 0.5 and segment.origin == "pipeline":
                decide(session, segment, chance.choice(["keep", "reject", "ambiguous", "undecided"]), number, place.now)
            if chance.random() < 0.2:
                segment.retired_at = place.now
        for run_id in chance.sample(runs, 2):
            session.get_one(Run, run_id).deleted_at = place.now
            refresh_counts(session, select(RunImage.image_id).where(RunImage.run_id == run_id))
        refresh_counts(session, ids)
    with place.database.read() as session:
        images = {image.id: image for image in session.query(Image)}
    for image_id in ids:
        verdicts = [verdict for _, verdict in current(place, image_id)]
        image = images[image_id]
        assert (image.n_candidates, image.n_keep, image.n_reject, image.n_ambiguous) == (
            len(verdicts),
            *(verdicts.count(word) for word in ("keep", "reject", "ambiguous")),
        )


def test_counts_are_fresh_in_the_session_that_wrote_them(place) -> None:
    image_id = place.image(place.dataset(), "a")
    with place.database.write() as session:
        image = session.get_one(Image, image_id)
        image.sequence = "not written yet"
        session.add(
            Segment(
                image_id=image_id,
                ordinal=0,
                n_points=1,
                points=bytes(8),
                x0=0,
                y0=0,
                x1=0,
                y1=0,
                length=0,
                origin="manual",
            )
        )
        refresh_counts(session, [image_id])
        assert (image.n_candidates, image.sequence) == (1, "not written yet")
