from __future__ import annotations

import io
import json
import zipfile

import numpy as np
import pytest

from app.db.models import Review
from app.errors import Conflict, InvalidInput, NotFound
from app.formats.exports import EXPORTS
from app.formats.inert_npy import read_label_npy
from app.formats.json_segments import read_json
from app.formats.npz import read_npz
from app.services.exporting import ExportChoice, ImagesNotDone, export_members, write_export


@pytest.fixture
def street(place):
    """Two images that are done and one that was discarded."""
    slug = place.dataset()
    first, second, third = place.images(slug, "a/1", "b/2", "c/3")
    place.label(first, ["keep", "reject", "ambiguous", "keep"])
    place.label(second, ["reject"])
    place.label(third, ["keep"])
    with place.database.write() as session:
        session.get_one(Review, third).status = "discarded"
    return slug


def members(place, slug: str, **choice) -> dict[str, bytes]:
    with place.database.read() as session:
        return dict(export_members(session, place.blobs, slug, ExportChoice(**choice)))


def test_clearlines_layout(place, street, segments) -> None:
    found = members(place, street)
    assert sorted(found) == [
        "images.csv",
        "images/a/1.png",
        "images/b/2.png",
        "labels/a/1_edge_segments_ambiguous.npy",
        "labels/a/1_edge_segments_filtered.npy",
        "labels/b/2_edge_segments_filtered.npy",
    ]
    lines = segments(4)
    assert read_label_npy(found["labels/a/1_edge_segments_filtered.npy"]) == lines.select([0, 3])
    assert read_label_npy(found["labels/a/1_edge_segments_ambiguous.npy"]) == lines.select([2])
    assert len(read_label_npy(found["labels/b/2_edge_segments_filtered.npy"])) == 0
    assert found["images.csv"].decode().splitlines()[1:] == ["a/1,a 64x48,a,", "b/2,b 64x48,b,"]


def test_numpy_reads_exactly_the_kept_segments(place, street, segments) -> None:
    content = members(place, street)["labels/a/1_edge_segments_filtered.npy"]
    loaded = np.load(io.BytesIO(content), allow_pickle=True)
    assert [line.tolist() for line in loaded] == [segments(4)[row].reshape(-1, 1, 2).tolist() for row in (0, 3)]


def test_images_that_are_not_done_are_refused_by_name(place, street) -> None:
    place.images(street, "z/open", "y/open")
    with pytest.raises(ImagesNotDone, match="2 images aren't done: y/open, z/open") as error:
        members(place, street)
    assert isinstance(error.value, Conflict)
    assert (error.value.code, error.value.details) == ("images-not-done", {"images": ["y/open", "z/open"]})
    assert "images/y/open.png" in members(place, street, allow_not_done=True)


def test_refused_before_the_first_member_is_made(place, street) -> None:
    place.image(street, "open")
    with place.database.read() as session, pytest.raises(ImagesNotDone):
        export_members(session, place.blobs, street)  # not iterated


def test_undecided_segments_are_no_labels(place) -> None:
    slug = place.dataset()
    place.label(place.image(slug, "a"), ["keep", "undecided"])
    found = members(place, slug, allow_not_done=True)
    assert len(read_label_npy(found["labels/a_edge_segments_filtered.npy"])) == 1


def test_without_images(place, street) -> None:
    assert not any(path.endswith(".png") for path in members(place, street, with_images=False))


@pytest.mark.parametrize("format_name", list(EXPORTS))
def test_every_format_as_a_zip(sqlite_place, format_name) -> None:
    place = sqlite_place
    slug = place.dataset()
    place.label(place.image(slug, "a/1"), ["keep", "ambiguous"])
    stream = io.BytesIO()
    with place.database.read() as session:
        size = write_export(session, place.blobs, slug, stream, ExportChoice(format=format_name))
    assert size == len(stream.getvalue())
    with zipfile.ZipFile(stream) as archive:
        assert archive.testzip() is None
        assert archive.namelist()


def test_verdicts_go_along_where_the_format_has_a_place(place, street) -> None:
    def only(found: dict[str, bytes], suffix: str) -> bytes:
        [content] = [content for path, content in found.items() if "1" in path and path.endswith(suffix)]
        return content

    for format_name, read in (("json", read_json), ("npz", read_npz)):
        labelled = read(only(members(place, street, format=format_name, with_images=False), f".{format_name}"))
        assert labelled.verdicts == ("keep", "ambiguous", "keep")
    coco = json.loads(members(place, street, format="coco", with_images=False)["annotations/instances_default.json"])
    assert len(coco["annotations"]) == 2  # a reader of COCO would take the ambiguous one for a label


def test_what_can_not_be_exported(place, street) -> None:
    with pytest.raises(InvalidInput, match="no format 'xml'"):
        members(place, street, format="xml")
    with pytest.raises(NotFound):
        members(place, "nothing")
    with pytest.raises(InvalidInput, match="no image to export"):
        members(place, place.dataset("Empty"))


def test_long_exports_take_queries_by_the_batch(place, count_queries) -> None:
    slug = place.dataset()
    place.images(slug, *(f"{number:03}" for number in range(25)))
    with count_queries(place.database) as queries:
        found = members(place, slug, with_images=False, allow_not_done=True)
    assert len(found) == 26
    assert len(queries) <= 6
