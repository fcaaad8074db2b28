"""What is told of a finished calibration: its lines in pages, its images, advice, and what has changed since."""

from __future__ import annotations

from datetime import timedelta

import numpy as np
import pytest

from app.db.models import Camera, Image, Segment
from app.errors import InvalidInput, NotFound
from app.services.calibration_advice import advice_of
from app.services.calibration_images import image_for, images_of_result, view_of, viewed_lines
from app.services.calibration_lines import LineOrder, list_lines
from app.services.calibration_summaries import list_calibrations
from app.services.calibrations import finished_calibration
from app.services.camera_details import CameraDetail, camera_detail
from app.services.datasets import get_dataset
from app.services.images import delete_images

GRACE = timedelta(days=7)


def detail(bench) -> CameraDetail:
    with bench.database.read() as session:
        return camera_detail(session, session.get_one(Camera, bench.camera_id), grace=GRACE)


@pytest.mark.parametrize(("order", "places"), [("residual", [4, 3, 2, 1, 0]), ("length", [0, 1, 2, 3, 4])])
def test_lines_come_in_pages(small_bench, order: LineOrder, places: list[int]) -> None:
    bench = small_bench
    images = [bench.image("a", ["keep"] * 2), bench.image("b", ["keep"] * 3)]
    segments = [segment for image in images for segment in bench.segments(image)]
    calibration = bench.calibrated(images)
    seen: list[int] = []
    cursor = None
    with bench.database.read() as session:
        row = finished_calibration(session, calibration)
        while True:
            page = list_lines(session, row, order=order, limit=2, cursor=cursor)
            assert page.total == 5
            seen += [entry.segment_id for entry in page.items]
            if (cursor := page.next_cursor) is None:
                break
    assert seen == [segments[place] for place in places]


def test_lines_know_what_became_of_their_segments(bench) -> None:
    images = [bench.image("a", ["keep"] * 3), bench.image("b", ["keep"])]
    calibration = bench.calibrated(images)
    replaced, purged, current = bench.segments(images[0])
    with bench.database.write() as session:
        session.get_one(Segment, replaced).retired_at = bench.now
        session.delete(session.get_one(Segment, purged))
        delete_images(session, get_dataset(session, "bench"), images[1:], bench.now, grace=GRACE)
    with bench.database.read() as session:
        row = finished_calibration(session, calibration)
        entries = list_lines(session, row, order="image").items
        assert [entry.state for entry in entries] == ["replaced", "gone", "current", "gone"]
        assert [entry.box is None for entry in entries] == [False, True, False, True]
        assert [entry.image for entry in entries] == ["a", "a", "a", None]
        shown = viewed_lines(session, row, image_for(session, row, images[0]))
        assert [line.segment_id for line in shown.lines] == [replaced, current]
        assert [(image.name, image.is_there) for image in images_of_result(session, row)] == [
            ("a", True),
            (f"then {images[1]}", False),
        ]


def test_a_cursor_is_good_for_its_own_list(small_bench) -> None:
    image = small_bench.image("a", ["keep"] * 3)
    first, second = small_bench.calibrated([image]), small_bench.calibrated([image])
    with small_bench.database.read() as session:
        cursor = list_lines(session, finished_calibration(session, first), limit=1).next_cursor
        with pytest.raises(InvalidInput):
            list_lines(session, finished_calibration(session, second), limit=1, cursor=cursor)
        with pytest.raises(InvalidInput):
            list_lines(session, finished_calibration(session, first), order="length", limit=1, cursor=cursor)


def test_lines_are_shown_where_the_picture_shows_them(small_bench) -> None:
    image = small_bench.image("a", ["keep"] * 3)
    unread, of_another = small_bench.image("b", ["undecided"]), small_bench.image("c", ["keep"])
    calibration = small_bench.calibrated([image])
    with small_bench.database.write() as session:
        front = session.get_one(Camera, small_bench.camera_id)
        rear = Camera(
            dataset_id=front.dataset_id,
            name="rear",
            width=front.width,
            height=front.height,
            created_at=small_bench.now,
        )
        session.get_one(Image, of_another).camera = rear
    with small_bench.database.read() as session:
        row = finished_calibration(session, calibration)
        shown = viewed_lines(session, row, image_for(session, row, image))
        assert image_for(session, row, unread).id == unread
        for missing in (of_another, 999):
            with pytest.raises(NotFound):
                image_for(session, row, missing)
    view = view_of(row)
    line = shown.lines[0]
    assert len(line.measured) == len(line.undistorted) == 33
    assert np.allclose(view.project(np.array(line.measured)), line.undistorted, atol=0.02)
    ends = np.array(line.undistorted)
    across = np.array([-(ends[-1] - ends[0])[1], (ends[-1] - ends[0])[0]])
    across /= np.hypot(*across)
    assert np.abs((ends - ends[0]) @ across).max() < 1.5, "a straight line of the scene is straight in the picture"


def test_decisions_since_counts_lines_that_are_kept_now_and_weren_t_then(bench) -> None:
    image = bench.image("a", ["keep", "keep", "undecided", "undecided"])
    bench.image("b", ["keep"])
    assert (detail(bench).decisions_since, detail(bench).latest_calibration_id) == (3, None)
    bench.calibrated([image])
    assert detail(bench).decisions_since == 0
    kept, other, third, fourth = bench.segments(image)
    bench.decide(fourth, "reject")
    assert detail(bench).decisions_since == 0, "a line that wasn't kept and isn't changes nothing"
    bench.decide(third, "keep")
    bench.decide(kept, "reject")
    assert detail(bench).decisions_since == 2
    bench.decide(third, "undecided")
    assert detail(bench).decisions_since == 1, "what was taken back has not changed"
    with bench.database.write() as session:
        session.get_one(Segment, other).retired_at = bench.now
    found = detail(bench)
    assert (found.kept_lines, found.images_labelled, found.images, found.candidates) == (2, 2, 2, 5)


def test_the_history_is_newest_first_in_pages(bench) -> None:
    image = bench.image("a", ["keep"] * 3)
    made = [bench.calibrated([image]) for _ in range(3)]
    with bench.database.read() as session:
        camera = session.get_one(Camera, bench.camera_id)
        first = list_calibrations(session, camera, grace=GRACE, limit=2)
        second = list_calibrations(session, camera, grace=GRACE, limit=2, cursor=first.next_cursor)
    assert [entry.id for page in (first, second) for entry in page.items] == made[::-1]
    assert (first.total, second.next_cursor) == (3, None)
    assert "newest_decision" not in first.items[0].parameters


def test_advice_leaves_out_what_was_labelled_since(bench) -> None:
    labelled = bench.image("a", ["keep"] * 3)
    near, far, done = (bench.image(name, ["undecided"] * 2) for name in ("near", "far", "done"))
    gains = [{"image_id": image, "gain": gain} for image, gain in ((near, 0.1), (far, 0.3), (done, 0.2))]
    calibration = bench.calibrated([labelled], images=gains)
    with bench.database.read() as session:
        found = advice_of(session, finished_calibration(session, calibration))
    assert [(image.name, image.gain) for image in found.images] == [("far", 0.3), ("done", 0.2), ("near", 0.1)]
    bench.decide(bench.segments(done)[0], "keep")
    with bench.database.read() as session:
        found = advice_of(session, finished_calibration(session, calibration))
    assert [image.name for image in found.images] == ["far", "near"]
