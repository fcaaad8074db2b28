"""Verdicts of the same edges in the frames before and after an image."""

from __future__ import annotations

import pytest

from app.db.models import Blob, Image, Review
from app.errors import NotFound
from app.services.neighbour_verdicts import NeighbourVerdict, frames_to_match, neighbour_verdicts

HEIGHTS = (20, 50, 80, 110, 140)


def in_one_drive(bench) -> None:
    with bench.database.write() as session:
        for image_id in bench.images:
            session.get_one(Image, image_id).sequence = "drive"


def said(bench, image: int) -> tuple[NeighbourVerdict, ...]:
    with bench.database.read() as session:
        frames = frames_to_match(session, image)
    return neighbour_verdicts(frames)


def by_height(bench, image: int) -> dict[float, tuple[str, str | None]]:
    heights = {entry.id: entry.box[1] for entry in bench.segments(image)}
    return {heights[entry.segment_id]: (entry.verdict, entry.reason) for entry in said(bench, image)}


def test_verdicts_of_the_same_edges_are_told_with_their_reasons(bench) -> None:
    in_one_drive(bench)
    bench.detect(*HEIGHTS)
    before, after = bench.images
    bench.decide(before, {bench.at(before, 20.0): "keep", bench.at(before, 80.0): "ambiguous"})
    bench.decide(before, {bench.at(before, 50.0): "reject"}, reason="shadow")
    assert by_height(bench, after) == {20.0: ("keep", None), 50.0: ("reject", "shadow"), 80.0: ("ambiguous", None)}
    assert {entry.from_image_id for entry in said(bench, after)} == {before}
    assert said(bench, before) == ()


def test_what_is_decided_here_is_left_alone(small_bench) -> None:
    bench = small_bench
    in_one_drive(bench)
    bench.detect(*HEIGHTS)
    before, after = bench.images
    bench.decide(before, {bench.at(before, height): "keep" for height in map(float, HEIGHTS)})
    bench.decide(after, {bench.at(after, 50.0): "reject"})
    assert set(by_height(bench, after)) == {20.0, 80.0, 110.0, 140.0}


def test_nothing_is_told_where_the_drive_is_unknown(small_bench) -> None:
    bench = small_bench
    bench.detect(*HEIGHTS)
    before, after = bench.images
    bench.decide(before, {bench.at(before, 20.0): "keep"})
    assert said(bench, after) == ()


def test_nothing_is_told_where_the_frames_beside_disagree(small_bench) -> None:
    bench = small_bench
    in_one_drive(bench)
    bench.detect(*HEIGHTS)
    before, middle = bench.images
    with bench.database.write() as session:
        session.get_one(Image, middle).name = "frame-2"
        first = session.get_one(Image, before)
        session.add(Blob(sha256="f" * 64, size=1, media_type="image/png", created_at=bench.now))
        session.flush()
        fields = ("dataset_id", "camera_id", "sequence", "width", "height", "bits", "created_at")
        last = Image(
            name="frame-3",
            file_name="frame-3.png",
            sha256="f" * 64,
            review=Review(status="open", updated_at=bench.now),
            **{name: getattr(first, name) for name in fields},
        )
        session.add(last)
        session.flush()
        after = last.id
    run = bench.start([after], camera="per-image")
    for claim in bench.claim():
        bench.store_lines(claim, *HEIGHTS)
    assert bench.finish() == [run]
    bench.decide(before, {bench.at(before, 20.0): "keep", bench.at(before, 50.0): "keep"})
    bench.decide(after, {bench.at(after, 20.0): "reject", bench.at(after, 50.0): "keep"})
    assert by_height(bench, middle) == {50.0: ("keep", None)}


def test_a_deleted_image_has_no_neighbours(small_bench) -> None:
    bench = small_bench
    with bench.database.write() as session:
        session.get_one(Image, bench.images[0]).deleted_at = bench.now
    with pytest.raises(NotFound):
        said(bench, bench.images[0])
