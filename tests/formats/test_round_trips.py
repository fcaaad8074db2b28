"""Whatever is written is read back: each format, with random segments."""

import csv
import io
import json
import zipfile
from collections import Counter
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.formats.decimals import shifted, shortest
from app.formats.exports import EXPORTS
from app.formats.inert_npy import read_label_npy
from app.formats.json_segments import read_json, read_json_set
from app.formats.json_writer import write_json, write_json_set
from app.formats.label_npy import write_label_npy
from app.formats.labelled import ORIGINS, LabelledSegments
from app.formats.labelled_image import LabelledImage
from app.formats.members import stream_zip
from app.formats.npz import is_npz_set, read_npz, read_npz_set, write_npz, write_npz_set
from app.verdicts import REASONS, VERDICTS
from app.vision.segments import Segments

few = settings(max_examples=12, deadline=None)
some = settings(max_examples=30, deadline=None)

coordinates = st.floats(-3000, 9000, width=32, allow_subnormal=False)
polyline = st.integers(1, 6).flatmap(lambda n: arrays(np.float32, (n, 2), elements=coordinates))
fraction = st.floats(0, 1, width=32)
names = st.lists(
    st.sampled_from(["a", "KITTI/000000", "deep/er/x.y", "strasse_ü", "b c", "日本/画像"]), unique=True, max_size=4
)


@st.composite
def labelled(draw, with_fields=None):
    lines = draw(st.lists(polyline, max_size=5))
    count = len(lines)

    def values(elements):
        wanted = draw(st.booleans()) if with_fields is None else with_fields
        return draw(st.lists(elements, min_size=count, max_size=count)) if wanted and count else None

    def words(elements):
        given = values(elements)
        return None if given is None or set(given) == {None} else tuple(given)

    straightness = values(fraction)
    verdicts = words(st.sampled_from([*VERDICTS, None]))
    rejected = [verdict == "reject" for verdict in verdicts or ()]
    given = words(st.sampled_from([*REASONS, None])) if any(rejected) else None
    reasons = tuple(reason if known else None for reason, known in zip(given or (), rejected, strict=False))
    return LabelledSegments(
        Segments.from_list(lines, values(fraction)),
        None if straightness is None else np.array(straightness, np.float32),
        verdicts,
        words(st.sampled_from([*ORIGINS, None])),
        words(
            st.one_of(st.none(), st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp", "Cn"]), max_size=5))
        ),
        reasons if any(reasons) else None,
    )


@st.composite
def images(draw):
    chosen = draw(names)
    return [LabelledImage(name, f"{name}.png", 640, 480, draw(labelled())) for name in chosen]


def export(name, given):
    return dict(EXPORTS[name](iter(given)))


def bare(segments):
    return Segments(segments.points, segments.offsets)


@some
@given(labelled())
def test_label_npy_holds_the_points_and_numpy_reads_the_same(item):
    data = write_label_npy(item.segments)
    assert read_label_npy(data) == bare(item.segments)
    loaded = np.load(io.BytesIO(data), allow_pickle=True)
    assert loaded.shape == (len(item),)
    for array, points in zip(loaded, item.segments, strict=True):
        assert array.dtype == np.float64
        assert array.shape == (len(points), 1, 2)
        assert np.array_equal(array[:, 0], points)


@some
@given(labelled())
def test_npz_holds_all_but_origins_ids_and_reasons(item):
    back = read_npz(write_npz(item))
    assert back == LabelledSegments(item.segments, item.straightness, item.verdicts)


@some
@given(labelled())
def test_json_holds_everything(item):
    back = read_json(write_json(item))
    if len(item):
        assert back == item
    else:
        assert len(back) == 0


@some
@given(st.lists(labelled(with_fields=True), max_size=3))
def test_one_file_for_all_images(items):
    named = {f"folder/{index}": item for index, item in enumerate(items)}
    from_json = read_json_set(write_json_set(named.items()))
    from_npz = read_npz_set(write_npz_set(named.items()))
    assert list(from_json) == list(from_npz) == list(named)
    for name, item in named.items():
        if len(item):
            assert from_json[name] == item
            assert from_npz[name].segments == item.segments
            back = from_npz[name]
            assert LabelledSegments(back.segments, back.straightness) == LabelledSegments(
                item.segments, item.straightness
            )
        else:
            assert len(from_json[name]) == len(from_npz[name]) == 0


def test_the_kinds_of_npz_are_told_apart():
    item = LabelledSegments(Segments.from_list([[[0, 0], [1, 1]]]))
    assert not is_npz_set(write_npz(item))
    assert is_npz_set(write_npz_set([("a", item)]))


@some
@given(arrays(np.float32, st.integers(0, 40), elements=st.floats(width=32, allow_nan=False, allow_infinity=False)))
def test_shortest_decimals_are_the_same_float32(values):
    assert np.array_equal(shortest(values).astype(np.float32), values)


def test_shortest_decimals_are_short():
    values = np.array([0.1, 42.433243, 1024.5, 3.0], np.float32)
    assert [repr(value) for value in shortest(values).tolist()] == ["0.1", "42.433243", "1024.5", "3.0"]
    assert shifted(values, 0.5).tolist() == [0.6, 42.933243, 1025.0, 3.5]


# Each foreign format is parsed here as its own documentation says, by code that shares nothing with the exporter.


def parse_coco(files):
    document = json.loads(files["annotations/instances_default.json"])
    assert [category["name"] for category in document["categories"]] == ["segment"]
    found = {image["file_name"].removesuffix(".png"): [] for image in document["images"]}
    by_id = {image["id"]: image for image in document["images"]}
    assert len({annotation["id"] for annotation in document["annotations"]}) == len(document["annotations"])
    for annotation in document["annotations"]:
        ((*flat,),) = annotation["segmentation"]
        assert len(flat) >= 6  # fewer are a box to pycocotools
        ring = np.array(flat).reshape(-1, 2)
        line = ring[: len(ring) // 2 + 1]
        assert np.array_equal(ring[len(ring) // 2 + 1 :], line[-2:0:-1])
        x, y, w, h = annotation["bbox"]
        assert np.allclose([*line.min(0), *line.max(0)], [x, y, x + w, y + h], atol=1e-5)
        known = annotation["attributes"]
        found[by_id[annotation["image_id"]]["file_name"].removesuffix(".png")].append((line - 0.5, known))
    return found


def parse_cvat(files):
    root: Any = ElementTree.fromstring(files["annotations.xml"])
    assert root.findtext("version") == "1.1"
    label = root.find("meta/task/labels/label")
    declared = {attribute.findtext("name") for attribute in label.iter("attribute")}
    found = {}
    for image in root.iter("image"):
        lines = []
        for shape in image.iter("polyline"):
            assert shape.get("label") == label.findtext("name")
            points = [tuple(map(float, pair.split(","))) for pair in shape.get("points").split(";")]
            known = {attribute.get("name"): attribute.text or "" for attribute in shape.iter("attribute")}
            assert set(known) <= declared
            lines.append((np.array(points) - 0.5, known))
        found[image.get("name").removesuffix(".png")] = lines
    return found


def parse_datumaro(files):
    document = json.loads(files["annotations/default.json"])
    assert document["categories"]["label"]["labels"][0]["name"] == "segment"
    found = {}
    for item in document["items"]:
        assert item["image"] == {"path": f"{item['id']}.png", "size": [480, 640]}
        assert {annotation["type"] for annotation in item["annotations"]} <= {"polyline"}
        found[item["id"]] = [
            (np.array(annotation["points"]).reshape(-1, 2) - 0.5, annotation["attributes"])
            for annotation in item["annotations"]
        ]
    return found


def parse_labelme(files):
    found = {}
    for path, content in files.items():
        document = json.loads(content)
        assert (document["imageWidth"], document["imageHeight"], document["imageData"]) == (640, 480, None)
        assert document["imagePath"] == path.split("/")[-1].removesuffix(".json") + ".png"
        assert {shape["shape_type"] for shape in document["shapes"]} <= {"linestrip"}
        found[path.removesuffix(".json")] = [
            (np.array(shape["points"]) - 0.5, json.loads(shape["description"] or "{}")) for shape in document["shapes"]
        ]
    return found


def parse_geojson(files):
    found = {}
    for path, content in files.items():
        document = json.loads(content)
        lines = []
        for number, feature in enumerate(document["features"]):
            assert feature["geometry"]["type"] == "LineString"
            assert feature["properties"].pop("segment") == number
            lines.append((np.array(feature["geometry"]["coordinates"]), feature["properties"]))
        found[path.removesuffix(".geojson")] = lines
    return found


PARSERS = {
    "coco": parse_coco,
    "cvat": parse_cvat,
    "datumaro": parse_datumaro,
    "labelme": parse_labelme,
    "geojson": parse_geojson,
}


def as_line(points):
    """What a tool that needs two points gets, and COCO three."""
    return np.repeat(points, 2, axis=0) if len(points) == 1 else points


@pytest.mark.parametrize("name", PARSERS)
@few
@given(given_images=images())
def test_no_polyline_vanishes_on_the_way_to_another_tool(name, given_images):
    found = PARSERS[name](export(name, given_images))
    assert list(found) == [image.name for image in given_images]
    for image in given_images:
        assert len(found[image.name]) == len(image.labelled)
        for index, (line, known) in enumerate(found[image.name]):
            expected = as_line(image.labelled.segments[index].astype(np.float64))
            if name == "coco" and len(expected) == 2:
                expected = np.array([expected[0], expected.mean(axis=0), expected[1]])
            assert line.shape == expected.shape
            # one unit of float32: 6e-5 px up to 1,024 px, twice that up to 2,048 px
            unit = np.spacing(np.float32(np.abs(expected).max())) + 1e-9
            assert (np.abs(line - expected) <= unit).all()
            assert known.get("verdict") == (image.labelled.verdicts or {index: None})[index]
            scores = image.labelled.segments.scores
            if scores is not None and len(scores):
                assert np.float32(known["score"]) == scores[index]


@few
@given(given_images=images())
def test_csv_tables(given_images):
    files = {
        path: list(csv.DictReader(io.StringIO(data.decode()))) for path, data in export("csv", given_images).items()
    }
    points = Counter((row["image"], int(row["segment"])) for row in files["points.csv"])
    rows = {(row["image"], int(row["segment"])): row for row in files["segments.csv"]}
    assert points == {key: int(row["points"]) for key, row in rows.items()}
    for image in given_images:
        mine = [row for row in files["points.csv"] if row["image"] == image.name]
        read = np.array([(row["x"], row["y"]) for row in mine], dtype=np.float64).reshape(-1, 2).astype(np.float32)
        assert np.array_equal(read, image.labelled.segments.points)
        for index in range(len(image.labelled)):
            verdict = (image.labelled.verdicts or {index: None})[index]
            assert rows[image.name, index]["verdict"] == (verdict or "")


@few
@given(given_images=images())
def test_own_formats_one_file_per_image(given_images):
    from_json, from_npz = export("json", given_images), export("npz", given_images)
    for image in given_images:
        assert read_json(from_json[f"{image.name}.json"]).segments.points.tolist() == (
            image.labelled.segments.points.tolist()
        )
        assert read_npz(from_npz[f"{image.name}.npz"]).segments == image.labelled.segments


@pytest.mark.parametrize("name", EXPORTS)
def test_every_export_fits_into_a_zip_and_holds_the_image_where_the_tool_looks_for_it(name):
    item = LabelledSegments(Segments.from_list([[[1, 2], [3, 4], [5, 6.5]]]))
    image = LabelledImage("KITTI/0", "KITTI/0.png", 640, 480, item, content=lambda: b"pixels")
    place = {
        "clearlines": "images/KITTI/0.png",
        "coco": "images/KITTI/0.png",
        "cvat": "images/KITTI/0.png",
        "datumaro": "images/default/KITTI/0.png",
        "labelme": "KITTI/0.png",
    }
    data = b"".join(stream_zip(EXPORTS[name]([image])))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        pictures = [path for path in archive.namelist() if path.endswith(".png")]
        assert pictures == ([place[name]] if name in place else [])
        assert all(archive.read(path) == b"pixels" for path in pictures)
    assert data == b"".join(stream_zip(EXPORTS[name]([image])))
