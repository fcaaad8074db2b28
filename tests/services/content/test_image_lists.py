from __future__ import annotations

import re
import zlib
from datetime import timedelta
from typing import Any

import pytest
from sqlalchemy import insert

from app.db.models import Blob, Dataset, Image, Review
from app.errors import InvalidInput
from app.services.image_lists import ORDERS, ImageFilter, facets, list_images
from app.services.images import delete_images
from app.services.paging import COUNTED, read_cursor, write_cursor


@pytest.fixture
def street(place):
    """Six images of three sources: one labelled, one with a failed run, one with candidates, one discarded."""
    slug = place.dataset()
    ids = place.images(slug, "a/1", "a/2", "b/1", "b/20% off", "c_x", "c-x")
    place.label(ids[0], ["keep", "reject"])
    place.run([ids[1]], status="failed")
    place.run([ids[2]], candidates=5)
    with place.database.write() as session:
        session.get_one(Review, ids[3]).status = "discarded"
        session.get_one(Image, ids[1]).sequence = "drive"
    return slug, ids


def names(place, slug: str, **fields) -> list[str]:
    sort = fields.pop("sort", "name")
    with place.database.read() as session:
        page = list_images(session, dataset(session, slug), ImageFilter(**fields), sort=sort)
    assert page.total == len(page.items)
    return [item.name for item in page.items]


def dataset(session, slug: str) -> Dataset:
    return session.query(Dataset).filter_by(slug=slug).one()


def test_filters(place, street) -> None:
    slug, ids = street
    assert names(place, slug) == ["a/1", "a/2", "b/1", "b/20% off", "c-x", "c_x"]
    assert names(place, slug, status="done") == ["a/1"]
    assert names(place, slug, status="discarded") == ["b/20% off"]
    assert names(place, slug, source="a") == ["a/1", "a/2"]
    assert names(place, slug, source="") == ["c-x", "c_x"]
    assert names(place, slug, sequence="drive") == ["a/2"]
    assert names(place, slug, prelabel="failed") == ["a/2"]
    assert names(place, slug, prelabel="done", source="b") == ["b/1"]
    assert names(place, slug, prelabel="none") == ["a/1", "b/20% off", "c-x", "c_x"]
    with place.database.read() as session:
        camera = session.get_one(Image, ids[2]).camera_id
    assert names(place, slug, camera=camera) == ["b/1", "b/20% off"]


def test_search_takes_every_character_as_itself(place, street) -> None:
    slug, _ = street
    assert names(place, slug, search="B/") == ["b/1", "b/20% off"]
    assert names(place, slug, search="0%") == ["b/20% off"]
    assert names(place, slug, search="_") == ["c_x"]
    assert names(place, slug, search="nothing") == []


def test_deleted_images_have_a_list_of_their_own(place, street) -> None:
    slug, ids = street
    with place.database.write() as session:
        delete_images(session, dataset(session, slug), ids[:2], place.now, grace=timedelta(days=7))
    assert names(place, slug, deleted=True) == ["a/1", "a/2"]
    assert names(place, slug, source="a") == []


def test_a_failed_run_shows_its_reason_until_a_newer_one_did_better(place, street) -> None:
    slug, ids = street
    with place.database.read() as session:
        [failed] = list_images(session, dataset(session, slug), ImageFilter(prelabel="failed")).items
    assert (failed.prelabel, failed.error) == ("failed", {"code": "invalid-image", "message": "broken"})
    place.run([ids[1]], status="cancelled")  # says nothing about the image
    assert names(place, slug, prelabel="failed") == ["a/2"]
    place.run([ids[1]], candidates=1)
    assert names(place, slug, prelabel="failed") == []


@pytest.mark.parametrize("sort", list(ORDERS))
@pytest.mark.parametrize("limit", [1, 2, 4, 6, 7])
def test_pages_together_are_the_list(sqlite_place, request, sort, limit) -> None:
    place = sqlite_place
    slug = place.dataset()
    ids = place.images(slug, "d", "a", "c", "b", "f", "e")
    place.run(ids[:4], candidates=2)
    place.run(ids[:1], candidates=3)
    seen: list = []
    cursor = None
    with place.database.read() as session:
        for _ in range(7):
            page = list_images(session, dataset(session, slug), sort=sort, limit=limit, cursor=cursor)
            assert page.total == 6
            seen += page.items
            cursor = page.next_cursor
            if cursor is None:
                break
            assert len(page.items) == limit
    keys = {
        "name": lambda item: item.name,
        "created": lambda item: item.created_at,
        "candidates": lambda item: item.candidates,
    }
    key = keys[sort.removeprefix("-")]
    expected = sorted(seen, key=lambda item: (key(item), item.id), reverse=sort.startswith("-"))
    assert cursor is None
    assert seen == expected
    assert len({item.id for item in seen}) == 6


def test_paging_by_time_works_on_both_databases(place) -> None:
    slug = place.dataset()
    ids = place.images(slug, "a", "b", "c")
    with place.database.write() as session:
        for hours, image_id in enumerate(ids):
            session.get_one(Image, image_id).created_at = place.now + timedelta(hours=hours, microseconds=hours)
    seen = []
    cursor = None
    with place.database.read() as session:
        for _ in range(3):
            page = list_images(session, dataset(session, slug), sort="-created", limit=1, cursor=cursor)
            seen += [item.id for item in page.items]
            cursor = page.next_cursor
    assert (seen, cursor) == (ids[::-1], None)


def test_an_image_that_comes_meanwhile_shifts_nothing(place) -> None:
    slug = place.dataset()
    place.images(slug, "b", "d", "f")
    with place.database.read() as session:
        first = list_images(session, dataset(session, slug), limit=2)
    place.images(slug, "a", "c", "e")
    with place.database.read() as session:
        second = list_images(session, dataset(session, slug), limit=10, cursor=first.next_cursor)
    assert [item.name for item in first.items + second.items] == ["b", "d", "e", "f"]


@pytest.mark.parametrize(
    "cursor",
    ["nonsense", "", "é", write_cursor("-name", "a", 1), write_cursor("name", "a", True), "W10", "bnVsbA", "[]"],
)
def test_cursors_of_other_lists_are_refused(cursor) -> None:
    with pytest.raises(InvalidInput, match="doesn't belong"):
        read_cursor("name", cursor)


def test_what_is_not_known_is_refused(sqlite_place) -> None:
    slug = sqlite_place.dataset()
    with sqlite_place.database.read() as session:
        where = dataset(session, slug)
        cases: tuple[tuple[ImageFilter, dict[str, Any]], ...] = (
            (ImageFilter(status="x"), {}),
            (ImageFilter(prelabel="cancelled"), {}),
            (ImageFilter(), {"sort": "size"}),
            (ImageFilter(), {"limit": 0}),
            (ImageFilter(), {"limit": 1001}),
            (ImageFilter(), {"sort": "created", "cursor": write_cursor("created", "yesterday", 1)}),
        )
        for chosen, fields in cases:
            with pytest.raises(InvalidInput):
                list_images(session, where, chosen, **fields)


def test_facets(place, street) -> None:
    slug, _ = street
    with place.database.read() as session:
        found = facets(session, dataset(session, slug))
    assert [(facet.value, facet.count) for facet in found.sources] == [("a", 2), ("b", 2), (None, 2)]
    assert [(facet.value, facet.count) for facet in found.sequences] == [("drive", 1), (None, 5)]
    assert [(camera.name, camera.count) for camera in found.cameras] == [("64x48", 2), ("a 64x48", 2), ("b 64x48", 2)]
    assert found.status == {"open": 4, "done": 1, "discarded": 1}
    assert found.prelabel == {"none": 4, "queued": 0, "running": 0, "done": 1, "failed": 1}


def test_ten_thousand_images_take_no_more_queries_than_one(place, count_queries) -> None:
    slug = place.dataset()
    first = place.image(slug, "first")
    with place.database.read() as session, count_queries(place.database) as few:
        list_images(session, dataset(session, slug), ImageFilter(prelabel="none"))
        facets(session, dataset(session, slug))
    with place.database.write() as session:
        add_rows(session, session.get_one(Image, first), 10_000)
    with place.database.read() as session, count_queries(place.database) as many:
        page = list_images(session, dataset(session, slug), ImageFilter(prelabel="none"), limit=500)
        assert facets(session, dataset(session, slug)).status["open"] == 10_001
    assert (len(page.items), page.total) == (500, 10_001)
    assert len(many) == len(few) + 1 <= 13  # where all are on one page, nothing has to tell how many there are


def add_rows(session, like: Image, number: int) -> None:
    hashes = [f"{zlib.crc32(b'%d' % index):08x}{index:056x}" for index in range(number)]
    session.execute(
        insert(Blob),
        [{"sha256": sha, "size": 1, "media_type": "image/png", "created_at": like.created_at} for sha in hashes],
    )
    rows = [
        {
            "dataset_id": like.dataset_id,
            "name": f"more/{index:06}",
            "file_name": f"more/{index:06}.png",
            "sha256": sha,
            "width": 64,
            "height": 48,
            "bits": 8,
            "camera_id": like.camera_id,
            "created_at": like.created_at,
        }
        for index, sha in enumerate(hashes)
    ]
    session.execute(insert(Image), rows)
    ids = session.query(Image.id).filter(Image.id != like.id)
    session.execute(
        insert(Review), [{"image_id": row.id, "status": "open", "updated_at": like.created_at} for row in ids]
    )


def test_images_are_chosen_by_score_without_reading_their_candidates(sqlite_place, count_queries) -> None:
    slug = sqlite_place.dataset()
    with sqlite_place.database.read() as session, count_queries(sqlite_place.database) as statements:
        list_images(session, dataset(session, slug), ImageFilter(min_score=0.25, max_score=0.75))
        (listed,) = [each for each in statements if "segments.score" in each]
        values = (1,) * listed.count("?")
        plan = session.connection().exec_driver_sql(f"EXPLAIN QUERY PLAN {listed}", values).all()
    assert "ix_segments_image_score (image_id=? AND score>? AND score<?)" in str(plan)


def test_what_is_looked_up_image_by_image_is_counted_up_to_a_bound(place) -> None:
    slug = place.dataset()
    first = place.image(slug, "first")
    with place.database.write() as session:
        add_rows(session, session.get_one(Image, first), COUNTED)
    with place.database.read() as session:
        where = dataset(session, slug)
        page = list_images(session, where, ImageFilter(search="r"))
        assert (page.total, page.total_exact, page.next_cursor is None) == (COUNTED, False, False)
        page = list_images(session, where, ImageFilter(search="r", prelabel="none"), limit=1, cursor=page.next_cursor)
        assert (page.total, page.total_exact) == (COUNTED, False)
        page = list_images(session, where, ImageFilter(search="more/0000"))
        assert (page.total, page.total_exact, len(page.items)) == (100, True, 100)
        page = list_images(session, where, ImageFilter(status="open"))
        assert (page.total, page.total_exact) == (COUNTED + 1, True)


def test_pages_by_name_are_read_from_an_index_in_order(place, count_queries) -> None:
    slug = place.dataset()
    first = place.image(slug, "first")
    with place.database.write() as session:
        add_rows(session, session.get_one(Image, first), 2_000)
    if not place.database.is_sqlite:
        with place.database.engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.exec_driver_sql("ANALYZE images")
    with place.database.read() as session, count_queries(place.database) as statements:
        cursor = write_cursor("name", "more/001000", 1)
        list_images(session, dataset(session, slug), ImageFilter(), limit=50, cursor=cursor)
        (listed,) = [each for each in statements if "ORDER BY images.name" in each]
        assert "count(" not in "".join(statements), "tallies know how many there are"
        words = {"dataset_id_1": 1, "param_1": "more/001000", "param_2": 1, "param_3": 51}
        values = (1, "more/001000", 1, 51, 0) if place.database.is_sqlite else words
        explain = "EXPLAIN QUERY PLAN" if place.database.is_sqlite else "EXPLAIN"
        plan = str(session.connection().exec_driver_sql(f"{explain} {listed}", values).all())
    # two thousand reviews are so few that they may well be read whole
    assert "Seq Scan on images" not in plan
    assert "SCAN images" not in plan
    assert re.search(r"(Scan using|SEARCH images USING( COVERING)? INDEX) \w*name\w*", plan), plan
