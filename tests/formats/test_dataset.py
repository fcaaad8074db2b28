import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pytest

from app.errors import InvalidFile, InvalidInput, NotFound
from app.formats.archives import open_archive
from app.formats.dataset import assign_cameras, list_images, read_dataset, reference_of, write_dataset
from app.formats.images_csv import ImageRow, read_images_csv, write_images_csv
from app.formats.inert_npy import read_label_npy
from app.formats.labelled import LabelledSegments
from app.formats.labelled_image import LabelledImage
from app.formats.layout import find_layout
from app.formats.members import fill_folder, stream_zip
from app.formats.reference_camera import ALL, ReferenceCamera, read_cameras, write_cameras
from app.formats.segment_files import list_segment_files, read_all, read_segment_set, read_segments
from app.vision.segments import Segments

DATA = Path(__file__).parents[3] / "shared" / "data"
CAMERA = ReferenceCamera(640, 480, ((500, 0, 320), (0, 500, 240), (0, 0, 1)), (-0.2, 0.01, 0, 0, 0))
LINES = Segments.from_list([[[0, 1], [2, 3]], [[4, 5], [6, 7.5]], [[8, 9]], [[1, 1]]])
LABELLED = LabelledSegments(LINES, verdicts=("keep", "reject", "ambiguous", None))


def image(name, labelled=LABELLED, **fields):
    return LabelledImage(name, f"{name}.png", 640, 480, labelled, content=lambda: name.encode(), **fields)


def test_a_dataset_is_written_and_read(tmp_path):
    written = [
        image("KITTI/0", camera="left", source="KITTI", sequence="00", reference=CAMERA),
        image("KITTI/1", LabelledSegments(LINES), camera="left", source="KITTI"),
        image("b, ü", LABELLED.select([1])),
    ]
    fill_folder(write_dataset(written), tmp_path)
    found = read_dataset(tmp_path)
    assert [item.name for item in found.images] == ["KITTI/0", "KITTI/1", "b, ü"]
    assert [(item.camera, item.source, item.sequence) for item in found.images] == [
        ("left", "KITTI", "00"),
        ("left", "KITTI", ""),
        ("", "", ""),
    ]
    first, second, third = found.images
    assert (tmp_path / first.path).read_bytes() == b"KITTI/0"
    assert read_label_npy((tmp_path / first.labels).read_bytes()) == Segments.from_list([LINES[0]])
    assert read_label_npy((tmp_path / first.ambiguous).read_bytes()) == Segments.from_list([LINES[2]])
    assert read_label_npy((tmp_path / second.labels).read_bytes()) == LINES  # no verdicts: all are kept
    assert second.ambiguous is None
    assert len(read_label_npy((tmp_path / third.labels).read_bytes())) == 0
    assert found.cameras == {"left": CAMERA}
    assert reference_of("KITTI/1", "left", found.cameras) == CAMERA
    assert reference_of("b, ü", "", found.cameras) is None


def test_the_same_members_as_a_zip():
    data = b"".join(stream_zip(write_dataset([image("KITTI/0"), image("KITTI/1")])))
    with open_archive(data) as archive:
        layout = find_layout(member.path for member in archive.members)
        content = {member.path: archive.read(member) for member in archive.members}
    items = list_images(layout, content[layout.images_csv or ""])
    assert [item.name for item in items] == ["KITTI/0", "KITTI/1"]
    assert len(read_label_npy(content[items[0].labels or ""])) == 1


def test_a_path_that_leaves_the_folder_is_not_written(tmp_path):
    for path in ("../x", "/x", "a/../../x"):
        with pytest.raises(InvalidFile):
            fill_folder([(path, b"")], tmp_path / "inner")
        with pytest.raises(InvalidFile):
            list(stream_zip([(path, b"")]))
    assert not (tmp_path / "x").exists()


@pytest.mark.parametrize(
    ("paths", "images", "labels"),
    [
        (["images/a.png", "labels/a.npz", "images/x.npz", "other.png"], ["a"], ["a"]),
        (["images/K/a.png", "labels/K/a_edge_segments_filtered.npy"], ["K/a"], ["K/a"]),
        (["top/images/K/a.png", "top/labels/K/a.npy", "top/images.csv"], ["K/a"], ["K/a"]),
        (["K/a.png", "K/a.npz", "b.jpg"], ["K/a", "b"], ["K/a"]),
        (["K/a.png", "labels/K/a.npz"], ["K/a"], ["K/a"]),
        (["one/images/a.png", "two/images/a.png"], ["one/images/a", "two/images/a"], []),
        (["K/a.png", "K/b.png"], ["K/a", "K/b"], []),
    ],
)
def test_layouts(paths, images, labels):
    layout = find_layout(paths)
    assert list(layout.images) == images
    assert list(layout.labels) == labels
    assert all(path in paths for path in [*layout.images.values(), *layout.labels.values()])


def test_labels_without_an_image_are_listed():
    assert find_layout(["images/a.png", "labels/a.npy", "labels/q.npy"]).extra_labels == ("labels/q.npy",)


def test_two_images_of_one_name(tmp_path):
    fill_folder([("images/a.png", b""), ("images/a.jpg", b"")], tmp_path)
    with pytest.raises(InvalidInput, match=r"a\.jpg and a\.png"):
        read_dataset(tmp_path)


def test_folders_without_images(tmp_path):
    with pytest.raises(NotFound):
        read_dataset(tmp_path / "none")
    with pytest.raises(NotFound):
        read_dataset(tmp_path)


def test_without_a_table_a_folder_is_a_source_and_with_its_size_a_camera(tmp_path):
    fill_folder([(path, b"") for path in ("x.png", "K/a.png", "K/b.png", "K/deep/c.png")], tmp_path)
    images = read_dataset(tmp_path).images
    assert {item.name: item.source for item in images} == {"x": "", "K/a": "K", "K/b": "K", "K/deep/c": "K/deep"}
    sizes = {"x": (4, 3), "K/a": (4, 3), "K/b": (8, 6), "K/deep/c": (4, 3)}
    assert assign_cameras(images, sizes) == {
        "x": "4x3",
        "K/a": "K 4x3",
        "K/b": "K 8x6",
        "K/deep/c": "K/deep 4x3",
    }


def test_images_csv_round_trip():
    rows = {"a": ImageRow("left, front", 'say "x"', ""), "K/b": ImageRow("", "ü", "7")}
    assert read_images_csv(write_images_csv(rows.items()), set(rows)) == rows


def test_images_csv_as_a_person_writes_it():
    text = "\ufeffsource,name,comment\r\n KITTI ,K/a.png,hello\r\n,b,\r\n"
    assert read_images_csv(text.encode(), {"K/a", "b", "c"}) == {"K/a": ImageRow("", "KITTI", ""), "b": ImageRow()}
    assert read_images_csv(b"", {"a"}) == {}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("camera\nx\n", "no column name"),
        ("name,camera\na,x,y\n", "more fields"),
        ("name\na\na\n", "twice"),
        ("name\na\nq\nz\n", "q, z"),
        ("name,camera\na," + "x" * 301 + "\n", "too long"),
        ('name,camera\na,"x\ny"\n', "control"),
        ('name,camera\na,"x\n', "can't be read"),
    ],
)
def test_mistakes_in_images_csv(text, message):
    with pytest.raises(InvalidFile) as caught:
        read_images_csv(text.encode(), {"a", "b"})
    assert message in caught.value.message


def test_cameras_json_round_trip():
    cameras = {"left": CAMERA, "KITTI/0": CAMERA}
    assert read_cameras(write_cameras(cameras)) == cameras


def test_one_camera_for_all():
    found = read_cameras(json.dumps(CAMERA.as_dict()).encode())
    assert found == {ALL: CAMERA}
    assert reference_of("any", "camera", found) == CAMERA


@pytest.mark.parametrize(
    "change",
    [
        {"width": 0},
        {"height": 4.5},
        {"width": True},
        {"K": [[1, 0, 0], [0, 1, 0]]},
        {"K": [[0, 0, 0], [0, 1, 0], [0, 0, 1]]},
        {"K": [["1", 0, 0], [0, 1, 0], [0, 0, 1]]},
        {"D": [1, 2, 3]},
        {"D": None},
        {"D": [0, 0, 0, 10**400]},
    ],
)
def test_mistakes_in_cameras_json(change):
    with pytest.raises(InvalidFile):
        read_cameras(json.dumps({"a": {**CAMERA.as_dict(), **change}}).encode())


@pytest.mark.parametrize("data", [b"[]", b'{"a": 5}', b"{", b'{"a": {}, "a": {}}'])
def test_other_json_than_cameras(data):
    with pytest.raises(InvalidFile):
        read_cameras(data)


def test_the_real_datasets():
    if not DATA.is_dir():
        pytest.skip("the real data are not beside the project")
    york = read_dataset(DATA / "york")
    assert len(york.images) == 51
    assert all(item.labels and item.name in york.cameras for item in york.images)
    kitti = read_dataset(DATA / "kitti")
    assert len(kitti.images) == 15
    assert kitti.cameras[ALL].width == 1300


def test_any_file_of_segments_by_its_extension(tmp_path):
    item = LabelledSegments(LINES)
    files = {**dict(write_dataset([LabelledImage("a", "a.png", 1, 1, item)]))}
    npy = files["labels/a_edge_segments_filtered.npy"]
    assert read_segments("x/a.NPY", npy).segments == LINES
    with pytest.raises(InvalidFile):
        read_segments("a.txt", npy)
    with pytest.raises(InvalidFile):
        read_segment_set("a.npy", npy)
    fill_folder([("K/a.npy", npy), ("prelabel.json", b"{}"), ("b.txt", b""), ("a.json", b"{}")], tmp_path)
    assert list_segment_files(tmp_path) == ["K/a.npy", "a.json"]
    with pytest.raises(NotFound):
        list_segment_files(tmp_path / "none")


def test_all_broken_files_are_named_at_once():
    good = b'{"segments": [{"points": [[1, 2]]}]}'
    files = [("a", "a.json", b"{"), ("b", "b.json", good), ("c", "c.npz", b"no zip")]
    found = []
    with pytest.raises(InvalidFile) as caught:
        found.extend(name for name, _ in read_all(files))
    assert [error["where"] for error in caught.value.details["errors"]] == ["a.json: line 1, column 2", "c.npz"]
    assert [name for name, _ in read_all(files[1:2])] == ["b"]


def test_a_streamed_zip_holds_one_member_at_a_time():
    def members():
        for index in range(3):
            yield f"{index}.png", bytes([index]) * 100_000

    pieces = list(stream_zip(members()))
    assert len(pieces) == 4
    assert max(map(len, pieces)) < 101_000
    with zipfile.ZipFile(io.BytesIO(b"".join(pieces))) as archive:
        assert archive.namelist() == ["0.png", "1.png", "2.png"]
        assert np.frombuffer(archive.read("2.png"), np.uint8).sum() == 200_000
