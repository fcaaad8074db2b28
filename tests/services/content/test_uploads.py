from __future__ import annotations

import io
import json
import threading
import zipfile
from concurrent.futures import ThreadPoolExecutor

import pytest

from app.db.models import Camera, Decision, Event, SegmentState
from app.errors import InvalidInput
from app.formats.label_npy import write_label_npy
from app.services.exporting import write_export
from app.services.import_reports import ImportLimits, ImportReport
from app.services.uploads import UploadedFile, import_upload
from app.vision.segments import Segments

CAMERA = {"width": 64, "height": 48, "K": [[50, 0, 32], [0, 50, 24], [0, 0, 1]], "D": [-0.2, 0.1, 0, 0]}


def files_of(contents: dict[str, bytes]) -> list[UploadedFile]:
    return [UploadedFile(name, io.BytesIO(content)) for name, content in contents.items()]


def zip_of(contents: dict[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in contents.items():
            archive.writestr(name, content)
    return stream.getvalue()


def names(report) -> list[str]:
    return [image.name for image in report.added]


def test_images_labels_and_tables_together(place, png, segments) -> None:
    importer = place.importer(place.dataset(), person="owner")
    contents = {
        "street/images/a/1.png": png(1),
        "street/images/a/2.png": png(2),
        "street/labels/a/1_edge_segments_filtered.npy": write_label_npy(segments(2)),
        "street/images.csv": b"name,camera\na/1,left\n",
        "street/cameras.json": json.dumps({"left": CAMERA}).encode(),
        "street/.DS_Store": b"x",
    }
    report = import_upload(importer, files_of(contents))
    assert (names(report), report.failed, report.labels) == (["a/1", "a/2"], (), 1)
    assert [(image.camera.name, image.status) for image in report.added] == [("left", "done"), ("a 64x48", "open")]
    with place.database.read() as session:
        assert session.query(Camera).filter_by(name="left").one().reference is not None
        assert session.query(Event).filter_by(kind="images.imported").one().person == "owner"


def test_a_zip_in_the_dataset_layout(place, png, segments) -> None:
    content = zip_of(
        {
            "images/a/1.png": png(1),
            "labels/a/1_edge_segments_filtered.npy": write_label_npy(segments(2)),
            "images.csv": b"name,sequence\na/1,00\n",
            "README.md": b"ignored",
        }
    )
    report = import_upload(place.importer(place.dataset()), files_of({"set.zip": content}))
    assert (names(report), report.failed, report.labels) == (["a/1"], (), 1)
    assert (report.added[0].sequence, report.added[0].verdicts.keep) == ("00", 2)


def test_each_bad_file_fails_alone(place, png) -> None:
    importer = place.importer(place.dataset(), limits=ImportLimits(file_bytes=2_000))
    contents = {
        "good.png": png(1),
        "bad.png": b"no image",
        "notes.txt": b"hello",
        "huge.png": b"x" * 2_001,
        "../out.png": png(2),
        "twin.png": png(3),
        "Twin.jpg": png(4),
        "broken.zip": b"PK no zip",
        "evil.zip": zip_of({"../a.png": png(5)}),
        "empty.zip": zip_of({"readme.md": b""}),
        "images.csv": b"name,camera\nnobody,left\n",
        "cameras.json": b"[]",
        "nobody_edge_segments_filtered.npy": write_label_npy(Segments.empty()),
    }
    report = import_upload(importer, files_of(contents))
    assert names(report) == ["good"]
    assert {file.name: file.error["code"] for file in report.failed} == {
        "bad.png": "invalid-image",
        "notes.txt": "invalid-file",
        "huge.png": "too-large",
        "../out.png": "invalid-file",
        "twin.png": "conflict",
        "Twin.jpg": "conflict",
        "broken.zip": "invalid-file",
        "evil.zip": "invalid-file",
        "empty.zip": "invalid-file",
        "images.csv": "invalid-file",
        "cameras.json": "invalid-file",
        "nobody_edge_segments_filtered.npy": "invalid-file",
    }


def test_nothing_usable_is_an_error_with_every_reason(place) -> None:
    importer = place.importer(place.dataset())
    with pytest.raises(InvalidInput) as error:
        import_upload(importer, files_of({"a.png": b"x", "b.txt": b"y"}))
    assert [file["name"] for file in error.value.details["failed"]] == ["b.txt", "a.png"]
    with pytest.raises(InvalidInput) as single:
        import_upload(importer, files_of({"a.png": b"x"}))
    assert single.value.where == "a.png"


def test_the_same_upload_again_finds_everything_there(place, png) -> None:
    importer = place.importer(place.dataset())
    first = import_upload(importer, files_of({"a.png": png(1), "b.png": png(2)}))
    again = import_upload(importer, files_of({"a.png": png(1), "b.png": png(2), "c.png": png(1)}))
    assert [(entry.name, entry.image_id) for entry in again.existing] == [
        ("a", first.added[0].id),
        ("b", first.added[1].id),
        ("c", first.added[0].id),
    ]
    assert (again.added, again.failed) == ((), ())


def test_another_image_of_a_present_name_is_a_conflict(place, png) -> None:
    importer = place.importer(place.dataset())
    import_upload(importer, files_of({"a.png": png(1)}))
    report = import_upload(importer, files_of({"a.jpg": png(2), "b.png": png(3)}))
    assert names(report) == ["b"]
    assert report.failed[0].error["details"] == {"images": ["a.png", "a.jpg"]}


def test_labels_may_come_after_their_images(place, png, segments) -> None:
    importer = place.importer(place.dataset())
    import_upload(importer, files_of({"set/images/a/1.png": png(1)}))
    labels = {
        "set/labels/a/1_edge_segments_filtered.npy": write_label_npy(segments(2)),
        "set/labels/a/1_edge_segments_ambiguous.npy": write_label_npy(segments(1)),
        "set/labels/a/9_edge_segments_filtered.npy": write_label_npy(segments(1)),
    }
    report = import_upload(importer, files_of(labels))
    assert (report.labels, [file.name for file in report.failed]) == (1, ["set/labels/a/9_edge_segments_filtered.npy"])
    again = import_upload(importer, files_of({**labels, "set/images/a/1.png": png(1)}))
    assert (again.labels, len(again.existing)) == (0, 1)


def test_labels_bring_the_reasons_of_rejections(place, png) -> None:
    lines = [
        {"points": [[1, 1], [40, 1]], "verdict": "reject", "reason": "car"},
        {"points": [[1, 9], [40, 9]], "verdict": "keep"},
        {"points": [[1, 20], [40, 20]], "verdict": "reject"},
    ]
    labels = json.dumps({"segments": lines}).encode()
    report = import_upload(place.importer(place.dataset()), files_of({"images/a.png": png(1), "labels/a.json": labels}))
    assert (names(report), report.failed, report.labels) == (["a"], (), 1)
    with place.database.read() as session:
        decided = session.query(Decision).order_by(Decision.id)
        assert [(row.verdict, row.reason) for row in decided] == [("reject", "car"), ("keep", None), ("reject", None)]
        states = session.query(SegmentState).order_by(SegmentState.segment_id)
        assert [(row.verdict, row.reason) for row in states] == [("reject", "car"), ("keep", None), ("reject", None)]


def test_an_export_comes_back_as_it_was(place, png) -> None:
    slug = place.dataset()
    first, second = place.image(slug, "a/1", camera="left", source="KITTI", sequence="00"), place.image(slug, "b/2")
    place.label(first, ["keep", "reject", "ambiguous", "keep"])
    place.label(second, ["reject"])
    with place.database.write() as session:
        session.query(Camera).filter_by(name="left").one().reference = {"K": CAMERA["K"], "D": [0.1, 0, 0, 0, 0]}
    stream = io.BytesIO()
    with place.database.read() as session:
        assert write_export(session, place.blobs, slug, stream) == len(stream.getvalue())
    copy = place.importer(place.dataset("Copy"))
    report = import_upload(copy, [UploadedFile("export.zip", stream)])
    assert (names(report), report.failed, report.labels) == (["a/1", "b/2"], (), 2)
    one, two = report.added
    assert (one.camera.name, one.source, one.sequence, one.status) == ("left", "KITTI", "00", "done")
    assert (one.verdicts.keep, one.verdicts.ambiguous, one.candidates) == (2, 1, 3)
    assert (two.candidates, two.status) == (0, "done")
    with place.database.read() as session:
        references = [row.reference for row in session.query(Camera).filter_by(name="left")]
    assert references[0] == references[1]


def test_of_many_that_upload_the_same_at_once_one_adds_it_and_the_others_find_it(place, png) -> None:
    importer = place.importer(place.dataset())
    content = png(1)
    together = threading.Barrier(6)

    def upload(_number: int) -> ImportReport:
        together.wait()
        return import_upload(importer, [UploadedFile("a.png", io.BytesIO(content))])

    with ThreadPoolExecutor(6) as threads:
        reports = list(threads.map(upload, range(6)))
    assert sorted((len(report.added), len(report.existing)) for report in reports) == [(0, 1)] * 5 + [(1, 0)]
