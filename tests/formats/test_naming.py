from pathlib import PurePosixPath, PureWindowsPath

import pytest

from app.errors import InvalidFile, InvalidInput
from app.formats.naming import (
    AMBIGUOUS,
    check_image_name,
    check_names,
    is_image_path,
    is_segment_path,
    name_images,
    name_of,
    pair_by_name,
    segment_file_name,
)


@pytest.mark.parametrize(
    ("path", "name"),
    [
        ("000000.png", "000000"),
        ("KITTI/000000.png", "KITTI/000000"),
        (PurePosixPath("a/b/c.d.png"), "a/b/c.d"),
        (PureWindowsPath("a\\b.png"), "a/b"),
        ("v1.2/x.jpeg", "v1.2/x"),
        ("e\u0301.png", "\u00e9"),
    ],
)
def test_a_name_is_the_path_without_extension(path, name):
    assert name_of(path) == name


@pytest.mark.parametrize(
    ("path", "image", "segments"),
    [
        ("a.PNG", True, False),
        ("a/b.jpeg", True, False),
        ("a.gif", False, False),
        ("a.npz", False, True),
        ("x/a_edge_segments_filtered.npy", False, True),
        ("prelabel.json", False, False),
        ("cameras.json", False, False),
        (".a.png", False, False),
        ("__MACOSX/a.png", False, False),
        (".cache/a.npz", False, False),
        ("a.txt", False, False),
    ],
)
def test_kinds_of_files(path, image, segments):
    assert (is_image_path(path), is_segment_path(path)) == (image, segments)


@pytest.mark.parametrize(
    ("path", "images", "expected"),
    [
        ("a.npy", (), ("a", False)),
        ("K/a_edge_segments_filtered.npy", (), ("K/a", False)),
        ("K/a_edge_segments_ambiguous.npy", (), ("K/a", True)),
        ("a_edge_segments_filtered.npz", {"a_edge_segments_filtered"}, ("a_edge_segments_filtered", False)),
    ],
)
def test_which_image_a_file_is_for(path, images, expected):
    assert segment_file_name(path, images) == expected


def test_images_are_named_and_sorted():
    assert name_images(["b.png", "a/c.jpg", "a/b.png"]) == {"a/b": "a/b.png", "a/c": "a/c.jpg", "b": "b.png"}


@pytest.mark.parametrize("pair", [("a.png", "a.jpg"), ("K/a.png", "k/A.png"), ("e\u0301.png", "\u00e9.png")])
def test_two_images_of_one_name_are_an_error(pair):
    with pytest.raises(InvalidInput) as caught:
        name_images([*pair, "other.png", "x.png", "x.bmp"])
    assert caught.value.details["images"] == sorted([sorted(pair), ["x.bmp", "x.png"]])


def test_files_are_paired_by_name_whatever_their_order():
    pairing = pair_by_name(
        ["a", "K/b", "c"],
        ["z.json", "c_edge_segments_filtered.npy", "K/b.npz", "a_edge_segments_ambiguous.npy", "q/y.npy"],
    )
    assert pairing.files == {"K/b": "K/b.npz", "c": "c_edge_segments_filtered.npy"}
    assert pairing.ambiguous == {"a": "a_edge_segments_ambiguous.npy"}
    assert pairing.missing == ("a",)
    assert pairing.extra == ("q/y.npy", "z.json")
    with pytest.raises(InvalidInput) as caught:
        pairing.require_complete("predictions")
    assert caught.value.message == "predictions don't fit the images: 1 missing (a); 2 extra (q/y.npy, z.json)"
    pair_by_name(["a"], ["a.npz"]).require_complete("predictions")


def test_two_files_for_one_image_are_an_error():
    with pytest.raises(InvalidInput) as caught:
        pair_by_name(["a", "b"], ["a.npz", "a_edge_segments_filtered.npy", "b.json", "b.npy"])
    assert caught.value.details["files"] == [["a.npz", "a_edge_segments_filtered.npy"], ["b.json", "b.npy"]]


@pytest.mark.parametrize(
    "name", ["", "/a", "a//b", "a/", "..", "a/../b", "./a", "a\\b", "a\x00", "a\u2028b", "x" * 1001]
)
def test_names_that_are_no_paths(name):
    with pytest.raises(InvalidFile):
        check_names(["good/name", name], where="file")


@pytest.mark.parametrize("name", ["../a", "a/.b/c", ".a", "__MACOSX/a", "x" * 228, "K/" + "é" * 114])
def test_names_that_could_not_be_exported_and_read_again(name):
    with pytest.raises(InvalidFile):
        check_image_name(name, where="name")


@pytest.mark.parametrize("name", ["a", "K/0.1", "a.b/c..d", "x" * 227, "K/" + "é" * 113])
def test_names_whose_label_files_can_be_written(name, tmp_path):
    check_image_name(name, where="name")
    path = tmp_path / f"{name}{AMBIGUOUS}.npy"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"")
