from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest

from app.db.models import Camera, Decision, Event, Image, Review, Segment
from app.errors import InvalidFile, InvalidInput, NotFound
from app.formats.inert_npy import read_label_npy
from app.formats.label_npy import write_label_npy
from app.services.image_lists import ImageFilter, list_images
from app.services.import_reports import ImportLimits
from app.services.imports import import_folder
from app.vision.segments import Segments

YORK = Path(__file__).parents[4] / "shared" / "data" / "york"
CAMERA = {"width": 64, "height": 48, "K": [[50, 0, 32], [0, 50, 24], [0, 0, 1]], "D": [-0.2, 0.1, 0, 0]}


@pytest.fixture
def folder(tmp_path: Path, png, segments) -> Path:
    """The dataset layout: three images, one with labels of both kinds, one with an empty label file, one without."""
    root = tmp_path / "street"
    for seed, name in enumerate(("a/1", "a/2", "b/3")):
        write(root / f"images/{name}.png", png(seed))
    write(root / "labels/a/1_edge_segments_filtered.npy", write_label_npy(segments(3)))
    write(root / "labels/a/1_edge_segments_ambiguous.npy", write_label_npy(segments(1)))
    write(root / "labels/a/2_edge_segments_filtered.npy", write_label_npy(segments(0)))
    write(root / "images.csv", b"name,camera,source,sequence\na/1,left,KITTI,00\na/2,left,KITTI,00\n")
    write(root / "cameras.json", json.dumps({"left": CAMERA}).encode())
    return root


def write(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def test_folder_with_labels_table_and_cameras(place, folder) -> None:
    steps = []
    result = import_folder(
        place.database,
        place.blobs,
        folder,
        "Street",
        place.now,
        person="owner",
        progress=lambda *step: steps.append(step),
    )
    report = result.report
    assert (result.slug, [image.name for image in report.added], report.existing, report.failed, report.labels) == (
        "street",
        ["a/1", "a/2", "b/3"],
        (),
        (),
        2,
    )
    assert steps == [(1, 3, "a/1"), (2, 3, "a/2"), (3, 3, "b/3")]
    first, second, third = report.added
    assert [image.status for image in report.added] == ["done", "done", "open"]
    assert (first.camera.name, first.source, first.sequence) == ("left", "KITTI", "00")
    assert (third.camera.name, third.source, third.sequence) == ("b 64x48", "b", None)
    assert vars(first.verdicts) == {"keep": 3, "reject": 0, "ambiguous": 1, "undecided": 0}
    assert second.candidates == 0
    with place.database.read() as session:
        camera = session.query(Camera).filter_by(name="left").one()
        assert camera.reference == {"K": CAMERA["K"], "D": CAMERA["D"]}
        assert session.query(Review).filter_by(status="done", person="owner").count() == 2
        decisions = session.query(Decision).all()
        assert {(row.kind, row.previous, row.person) for row in decisions} == {("import", "undecided", "owner")}
        assert sorted(row.verdict for row in decisions) == ["ambiguous", "keep", "keep", "keep"]
        assert {row.origin for row in session.query(Segment)} == {"import"}
        assert session.query(Event).filter_by(kind="images.imported").one().details["added"] == 3


def test_points_are_stored_as_they_were(place, folder, segments) -> None:
    import_folder(place.database, place.blobs, folder, "Street", place.now)
    with place.database.read() as session:
        rows = session.query(Segment).order_by(Segment.ordinal).all()[:3]
        stored = [np.frombuffer(row.points, "<f4").reshape(-1, 2) for row in rows]
        boxes = [(row.x0, row.y0, row.x1, row.y1, row.length, row.n_points) for row in rows]
    assert all(np.array_equal(a, b) for a, b in zip(stored, segments(3), strict=True))
    assert boxes == [(0, 10 * row, 29, 10 * row, 29, 30) for row in range(3)]


def test_again_changes_nothing(place, folder) -> None:
    first = import_folder(place.database, place.blobs, folder, "Street", place.now)
    before = dump(place)
    again = import_folder(place.database, place.blobs, folder, "Street", place.now)
    assert again.slug == first.slug
    assert [(entry.name, entry.image_id) for entry in again.report.existing] == [
        (image.name, image.id) for image in first.report.added
    ]
    assert (again.report.added, again.report.failed, again.report.labels) == ((), (), 0)
    assert dump(place) == before


def dump(place) -> list:
    tables = (Image, Camera, Review, Segment, Decision, Event)
    with place.database.read() as session:
        return [
            [
                tuple(getattr(row, column.key) for column in table.__table__.columns)
                for row in session.query(table).order_by(*table.__table__.primary_key)
            ]
            for table in tables
        ]


def test_a_second_import_does_not_undo_what_people_did(place, folder) -> None:
    import_folder(place.database, place.blobs, folder, "Street", place.now)
    with place.database.write() as session:
        for review in session.query(Review):
            review.status = "open"
        session.query(Camera).filter_by(name="left").one().reference = {"K": CAMERA["K"], "D": [1, 0, 0, 0]}
    import_folder(place.database, place.blobs, folder, "Street", place.now)
    with place.database.read() as session:
        assert session.query(Review).filter_by(status="open").count() == 3
        assert session.query(Camera).filter_by(name="left").one().reference["D"] == [1, 0, 0, 0]


def test_a_broken_image_fails_alone(place, folder) -> None:
    write(folder / "images/a/0.png", b"no image")
    write(folder / "images/c/9.png", (folder / "images/b/3.png").read_bytes() + b"x" * 3000)
    limits = ImportLimits(file_bytes=3000)
    report = import_folder(place.database, place.blobs, folder, "Street", place.now, limits=limits).report
    assert [image.name for image in report.added] == ["a/1", "a/2", "b/3"]
    failed = {file.name: file.error for file in report.failed}
    assert failed["images/a/0.png"]["code"] == "invalid-image"
    assert failed["images/a/0.png"]["where"] == "a/0.png"
    assert failed["images/c/9.png"]["code"] == "too-large"


def test_broken_labels_fail_alone(place, folder) -> None:
    write(folder / "labels/a/1_edge_segments_filtered.npy", b"\x93NUMPY garbage")
    report = import_folder(place.database, place.blobs, folder, "Street", place.now).report
    assert [image.status for image in report.added] == ["open", "done", "open"]
    [failed] = report.failed
    assert failed.name == "labels/a/1_edge_segments_filtered.npy"
    assert failed.error["code"] == "invalid-file"
    assert report.labels == 1


def test_a_reference_for_another_size_fails_with_its_image(place, folder) -> None:
    write(folder / "cameras.json", json.dumps({"left": CAMERA | {"width": 640}}).encode())
    report = import_folder(place.database, place.blobs, folder, "Street", place.now).report
    assert [image.name for image in report.added] == ["b/3"]
    assert {file.error["where"] for file in report.failed} == {"reference"}


def test_a_reference_of_one_image_makes_a_camera_of_its_own(place, folder) -> None:
    (folder / "images.csv").unlink()
    write(folder / "cameras.json", json.dumps({"a/1": CAMERA, "b 64x48": CAMERA}).encode())
    report = import_folder(place.database, place.blobs, folder, "Street", place.now).report
    assert [image.camera.name for image in report.added] == ["a/1", "a 64x48", "b 64x48"]
    with place.database.read() as session:
        assert [row.reference is not None for row in session.query(Camera).order_by(Camera.name)] == [False, True, True]


def test_json_labels_keep_their_verdicts(place, folder, segments) -> None:
    (folder / "labels/a/1_edge_segments_filtered.npy").unlink()
    (folder / "labels/a/1_edge_segments_ambiguous.npy").unlink()
    verdicts = ["keep", "reject", "ambiguous", "undecided", None]
    points = [{"points": line.tolist(), "score": 0.5} for line in segments(5)]
    document = {
        "segments": [entry | ({"verdict": word} if word else {}) for entry, word in zip(points, verdicts, strict=True)]
    }
    write(folder / "labels/a/1.json", json.dumps(document).encode())
    report = import_folder(place.database, place.blobs, folder, "Street", place.now).report
    assert vars(report.added[0].verdicts) == {"keep": 2, "reject": 1, "ambiguous": 1, "undecided": 1}
    assert report.added[0].status == "open"  # somebody has one left to decide
    with place.database.read() as session:
        assert {row.score for row in session.query(Segment)} == {0.5}


def test_folder_that_can_not_be_imported(place, tmp_path: Path, folder, png) -> None:
    with pytest.raises(NotFound):
        import_folder(place.database, place.blobs, tmp_path / "missing", "Street", place.now)
    (tmp_path / "empty").mkdir()
    with pytest.raises(NotFound):
        import_folder(place.database, place.blobs, tmp_path / "empty", "Street", place.now)
    write(folder / "images.csv", b"name,camera\nnobody,left\n")
    with pytest.raises(InvalidFile, match="nobody"):
        import_folder(place.database, place.blobs, folder, "Street", place.now)
    write(folder / "images/a/1.jpg", png(7))
    with pytest.raises(InvalidInput, match=r"a/1.jpg and a/1.png"):
        import_folder(place.database, place.blobs, folder, "Street", place.now)
    with place.database.read() as session:
        assert session.query(Image).count() == 0


def test_a_dataset_is_found_by_name_or_slug(place, folder, tmp_path, png) -> None:
    slug = place.dataset("Street view")
    for number, name in enumerate(("Street view", "street-view")):
        write(tmp_path / name / "x.png", png(100 + number))
        assert import_folder(place.database, place.blobs, folder, name, place.now).slug == slug


@pytest.mark.skipif(not YORK.exists(), reason="the York Urban images are not here")
def test_york_labels_are_stored_as_they_are_read(place, tmp_path) -> None:
    for path in sorted((YORK / "images").iterdir())[:6]:
        for part in (f"images/{path.name}", f"labels/{path.stem}_edge_segments_filtered.npy"):
            write(tmp_path / "york" / part, (YORK / part).read_bytes())
    write(tmp_path / "york/cameras.json", (YORK / "cameras.json").read_bytes())
    result = import_folder(place.database, place.blobs, tmp_path / "york", "York", place.now)
    report = result.report
    assert (len(report.added), report.labels, report.failed) == (6, 6, ())
    with place.database.read() as session:
        for image in report.added:
            expected = read_label_npy((YORK / f"labels/{image.name}_edge_segments_filtered.npy").read_bytes())
            rows = session.query(Segment).filter_by(image_id=image.id).order_by(Segment.ordinal).all()
            stored = Segments.from_list([np.frombuffer(row.points, "<f4").reshape(-1, 2) for row in rows])
            assert stored == expected
        cameras = session.query(Camera).filter(Camera.reference.is_not(None)).order_by(Camera.id)
        assert [row.name for row in cameras] == [image.name for image in report.added]
        done = list_images(session, place.find(session, result.slug), ImageFilter(status="done"))
    assert done.total == 6


def test_table_of_a_spreadsheet(place, folder) -> None:
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerows([["sequence", "name", "note"], ["drive 7", "a/1.png", "x"]])
    write(folder / "images.csv", b"\xef\xbb\xbf" + text.getvalue().encode())
    report = import_folder(place.database, place.blobs, folder, "Street", place.now).report
    assert (report.added[0].sequence, report.added[0].source, report.added[0].camera.name) == (
        "drive 7",
        "a",
        "a 64x48",
    )


def test_a_file_that_vanishes_on_the_way_fails_alone(place, folder) -> None:
    vanishing = folder / "images" / "gone.png"
    vanishing.symlink_to(folder / "images.csv")

    def progress(done: int, _total: int, _name: str) -> None:
        if done == 1:
            vanishing.unlink(missing_ok=True)

    report = import_folder(place.database, place.blobs, folder, "Vanishing", place.now, progress=progress).report
    assert [(failed.name, failed.error["code"]) for failed in report.failed] == [("images/gone.png", "invalid-file")]
    assert report.added


def test_a_long_folder_is_a_source_all_the_same(place, tmp_path: Path, png) -> None:
    deep = tmp_path / "deep" / "/".join(["f" * 100] * 4)
    deep.mkdir(parents=True)
    (deep / "a.png").write_bytes(png(1))
    report = import_folder(place.database, place.blobs, tmp_path / "deep", "Deep", place.now).report
    assert not report.failed
    assert len(report.added[0].source or "") == 300
