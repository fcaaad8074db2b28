"""Uploads of results: every accepted form gives the same segments, and everything that is wrong is told at once."""

from __future__ import annotations

import contextlib
import io
import json
import tarfile
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.formats.label_npy import write_label_npy
from app.formats.labelled import LabelledSegments
from app.formats.npz import read_npz_set, write_npz, write_npz_set
from app.formats.submission_files import (
    ExpectedImage,
    SubmissionContent,
    canonical_form,
    content_hash,
    read_submission,
)
from app.formats.submission_limits import SubmissionLimits
from app.formats.submission_problems import InvalidSubmission
from app.vision.segments import Segments

IMAGES = [ExpectedImage(f"KITTI/{number:06}", 400, 300) for number in range(3)]
FOUND = Segments.from_list([[[10, 20], [110, 25], [210, 31]], [[300, 40], [310, 250]]])
SCORED = Segments(FOUND.points, FOUND.offsets, np.array([0.75, 0.5], np.float32))
JSON = {"segments": [{"points": line.tolist()} for line in FOUND]}


def zip_of(members: Mapping[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in members.items():
            archive.writestr(path, content)
    return stream.getvalue()


def tar_of(members: Mapping[str, bytes], change: Callable[[tarfile.TarInfo], None] | None = None) -> bytes:
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w:gz") as archive:
        for path, content in members.items():
            info = tarfile.TarInfo(path)
            info.size = len(content)
            if change is not None:
                change(info)
            archive.addfile(info, io.BytesIO(content))
    return stream.getvalue()


PACKERS = {"results.zip": zip_of, "results.tar.gz": tar_of}


def read(name: str, data: bytes, **limits: Any) -> SubmissionContent:
    return read_submission(name, io.BytesIO(data), len(data), IMAGES, SubmissionLimits(**limits))


def problems(name: str, data: bytes, **limits: Any) -> list[dict[str, Any]]:
    with pytest.raises(InvalidSubmission) as caught:
        read(name, data, **limits)
    assert caught.value.status == 422
    found = caught.value.details["errors"]
    assert caught.value.details["count"] >= len(found) >= 1
    assert all(set(each) == {"file", "segment", "point", "message", "expected", "hint"} for each in found)
    return found


def forms() -> dict[str, bytes]:
    npz, json_file = write_npz(LabelledSegments(FOUND)), json.dumps(JSON).encode()
    whole = write_npz_set([("KITTI/000001", LabelledSegments(FOUND))])
    return {
        "one per image.zip": zip_of({"KITTI/000001.npz": npz}),
        "with a folder around.zip": zip_of({"out/run 1/KITTI/000001.npz": npz, "out/run 1/prelabel.json": b"{}"}),
        "called as labels.zip": zip_of({"KITTI/000001_edge_segments_filtered.npy": write_label_npy(FOUND)}),
        "of system files too.tar.gz": tar_of({"./KITTI/000001.json": json_file, "./KITTI/._x.json": b"rubbish"}),
        "short.tgz": tar_of({"KITTI/000001.npz": npz}),
        "set.npz": whole,
        "set.json": json.dumps({"images": {"KITTI/000001": JSON}}).encode(),
        "set in a zip.zip": zip_of({"all.npz": whole}),
    }


@pytest.mark.parametrize("name", forms())
def test_every_form_gives_the_same_segments(name: str) -> None:
    content = read(name, forms()[name])
    assert list(content.segments) == ["KITTI/000001"]
    assert content.segments["KITTI/000001"] == FOUND
    assert content.missing == ("KITTI/000000", "KITTI/000002")
    assert (content.n_segments, content.n_points, content.has_scores) == (2, 5, False)
    assert content_hash(content) == content_hash(read("set.npz", forms()["set.npz"]))
    assert read_npz_set(canonical_form(content))["KITTI/000001"].segments == FOUND


def test_scores_count_where_every_image_has_them() -> None:
    whole = zip_of({image.name + ".npz": write_npz(LabelledSegments(SCORED)) for image in IMAGES})
    assert read("a.zip", whole).has_scores
    empty = write_npz(LabelledSegments(Segments.empty()))
    mixed = zip_of({"KITTI/000000.npz": write_npz(LabelledSegments(SCORED)), "KITTI/000001.npz": empty})
    assert read("a.zip", mixed).has_scores
    some = zip_of(
        {
            "KITTI/000000.npz": write_npz(LabelledSegments(SCORED)),
            "KITTI/000001.npz": write_npz(LabelledSegments(FOUND)),
        }
    )
    content = read("a.zip", some)
    assert not content.has_scores
    assert "not all images have scores, so none is used and there is no AP" in content.warnings
    assert content_hash(content) != content_hash(read("a.zip", whole))


def test_all_that_is_wrong_is_told_at_once_with_its_place() -> None:
    wild = {
        "segments": [
            {"points": [[1, 2], [3, 4]], "score": 0.5},
            {"points": [[1, 2], [3, float("nan")], [float("inf"), 4]], "score": 1.5},
            {"points": []},
            {"points": [[1, 2], [3]], "score": 0.5},
            {"points": [[1, 2], [9000, 4]], "score": True},
        ]
    }
    data = zip_of(
        {
            "KITTI/000000.json": json.dumps(wild).encode(),
            "KITTI/000001.npy": b"\x93NUMPY and then nothing",
            "KITTI/000007.npz": write_npz(LabelledSegments(FOUND)),
            "kitti/000002.npz": write_npz(LabelledSegments(FOUND)),
        }
    )
    found = [(each["file"], each["segment"], each["point"], each["message"]) for each in problems("a.zip", data)]
    first = "KITTI/000000.json"
    assert set(found) == {
        (first, 1, 1, "a coordinate is not finite, and 1 more of the segment"),
        (first, 1, None, "the score 1.5 is out of range"),
        (first, 2, None, "a segment has no points"),
        (first, 2, None, "no score, although other segments have one"),
        (first, 3, 1, "[3] is no point"),
        (first, 4, 1, "a point lies far outside the image"),
        (first, 4, None, "True is no score"),
        ("KITTI/000001.npy", None, None, "this is no .npy file, or its header is broken"),
        ("KITTI/000007.npz", None, None, "there is no image of this name"),
        ("kitti/000002.npz", None, None, "there is no image of this name"),
    }
    hints = {each["file"]: each["hint"] for each in problems("a.zip", data)}
    assert hints["kitti/000002.npz"] == "is it KITTI/000002?"


def test_two_files_for_an_image_are_refused() -> None:
    npz = write_npz(LabelledSegments(FOUND))
    data = zip_of({"KITTI/000001.npz": npz, "KITTI/000001_edge_segments_filtered.npz": npz})
    (problem,) = problems("a.zip", data)
    assert "a second file for the image KITTI/000001" in problem["message"]


def test_only_so_many_complaints_are_told_and_all_are_counted() -> None:
    points = np.full((50, 2), np.nan, np.float32)
    stream = io.BytesIO()
    np.savez(stream, points=points, offsets=np.arange(51))
    data = zip_of({"KITTI/000001.npz": stream.getvalue()})
    with pytest.raises(InvalidSubmission) as caught:
        read("a.zip", data, problems=7)
    assert (len(caught.value.details["errors"]), caught.value.details["count"]) == (7, 50)


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"segments": 1}, "2 segments are too many"),
        ({"image_segments": 1}, "2 segments are too many for one image"),
        ({"points": 4}, "5 points are too many"),
        ({"segment_points": 2}, "a segment has 3 points"),
        ({"image_length": 100.0}, "px long together"),
        ({"upload_bytes": 10}, "the upload has"),
        ({"members": 0}, "members"),
        ({"member_bytes": 10}, "unpacks to"),
        ({"unpacked_bytes": 10}, "unpacks to"),
    ],
)
@pytest.mark.parametrize("name", PACKERS)
def test_each_limit_is_kept(name: str, limits: dict[str, Any], message: str) -> None:
    data = PACKERS[name]({"KITTI/000001.npz": write_npz(LabelledSegments(FOUND))})
    assert any(message in each["message"] for each in problems(name, data, **limits)), problems(name, data, **limits)


def test_limits_count_over_all_images() -> None:
    data = zip_of({f"{image.name}.npz": write_npz(LabelledSegments(FOUND)) for image in IMAGES})
    assert problems("a.zip", data, segments=5)[0]["message"] == "the upload has more than 5 segments"
    assert problems("a.zip", data, points=14)[0]["message"] == "the upload has more than 14 points"


def pickle_with_code() -> bytes:
    class Evil:
        def __reduce__(self) -> tuple[Any, ...]:
            return Path.touch, (Path("/tmp/never-made-by-a-submission"),)

    stream = io.BytesIO()
    np.save(stream, np.array([Evil()], dtype=object), allow_pickle=True)
    return stream.getvalue()


def huge_header() -> bytes:
    header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (500000000000, 2), }"
    header += b" " * (118 - len(header) - 1) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header


def npz_of(**arrays: Any) -> bytes:
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)
    return stream.getvalue()


def many_images(count: int) -> bytes:
    names = np.arange(count).astype("U8")
    return npz_of(points=np.zeros((0, 2)), offsets=[0], names=names, image_offsets=np.zeros(count + 1, int))


def no_character() -> bytes:
    names = np.array([0x7FFFFFFF], "<u4").view("<U1")
    return npz_of(points=np.zeros((0, 2)), offsets=[0], names=names, image_offsets=[0, 0])


def many_keys() -> bytes:
    keys = [*range(300_000), 299_999]
    return b'{"images": {%s}}' % b",".join(b'"%d": 1' % key for key in keys)


def many_segments() -> bytes:
    return npz_of(points=np.zeros((10**6, 2), np.uint8), offsets=np.arange(10**6 + 1))


HOSTILE_FILES: dict[str, Callable[[], bytes]] = {
    "pickle with code.npy": pickle_with_code,
    "10^12 elements.npy": huge_header,
    "10^12 elements.npz": lambda: zip_of({"points.npy": huge_header(), "offsets.npy": huge_header()}),
    "10^6 segments.npz": many_segments,
    "npz of objects.npz": lambda: npz_of(points=np.array([None, "x"], dtype=object), offsets=np.arange(3)),
    "many images.npz": lambda: many_images(30_000),
    "no character.npz": no_character,
    "many keys and one twice.json": many_keys,
    "text.json": lambda: b"{",
    "deep.json": lambda: b'{"segments":' + b"[" * 100_000,
    "NaN.json": lambda: b'{"segments": [{"points": [[NaN, 1], [2, 3]]}]}',
    "infinity.npz": lambda: npz_of(points=np.array([[1e300, 1], [2, 2]]), offsets=np.array([0, 2])),
}


@pytest.mark.parametrize("packer", PACKERS)
@pytest.mark.parametrize("name", HOSTILE_FILES)
def test_a_hostile_file_is_refused_by_name(name: str, packer: str) -> None:
    path = f"KITTI/000001{Path(name).suffix}"
    found = problems(packer, PACKERS[packer]({path: HOSTILE_FILES[name]()}))
    assert {each["file"] for each in found} == {path}
    assert not Path("/tmp/never-made-by-a-submission").exists()


@pytest.mark.parametrize("name", ["a.npz", "a.json"])
def test_half_a_character_in_a_name_is_spelt_out(name: str) -> None:
    half = "\ud800"
    of_npz = npz_of(points=np.zeros((0, 2)), offsets=[0], names=np.array([half]), image_offsets=[0, 0])
    of_json = json.dumps({"images": {half: {"segments": []}}}).encode()
    [problem] = problems(name, of_npz if name == "a.npz" else of_json)
    assert problem["file"] == f"{name}: image \\ud800"


def is_link(info: tarfile.TarInfo) -> None:
    info.type, info.linkname, info.size = tarfile.SYMTYPE, "/etc/passwd", 0


def is_device(info: tarfile.TarInfo) -> None:
    info.type, info.size = tarfile.CHRTYPE, 0


def raw_name(name: bytes) -> bytes:
    """A tar.gz whose one member has this very name."""
    import gzip

    data = gzip.decompress(tar_of({"KITTI/000001.npz": b"x" * 10}))
    header = bytearray(data[:512])
    header[:100] = name.ljust(100, b"\0")
    header[148:156] = b" " * 8
    header[148:156] = b"%06o\0 " % sum(header)
    return gzip.compress(bytes(header) + data[512:])


def long_extended_header() -> bytes:
    """A tar.gz with an extended header of 64 MiB, of which gzip makes 64 kB."""
    import gzip

    info = tarfile.TarInfo("x")
    info.type, info.size = tarfile.XHDTYPE, 64 * 2**20
    return gzip.compress(info.tobuf(tarfile.USTAR_FORMAT) + b"0" * info.size + b"\0" * 1024)


def header_chain() -> bytes:
    """A tar.gz of extended headers alone; `tarfile` calls itself for each."""
    import gzip

    info = tarfile.TarInfo("x")
    info.type, info.size = tarfile.XHDTYPE, 11
    return gzip.compress((info.tobuf(tarfile.USTAR_FORMAT) + b"11 path=ab\n".ljust(512, b"\0")) * 5_000)


NPZ = write_npz(LabelledSegments(FOUND))
HOSTILE_TARS: dict[str, tuple[Callable[[], bytes], str]] = {
    "link": (lambda: tar_of({"KITTI/000001.npz": b""}, is_link), "it is a link"),
    "device": (lambda: tar_of({"KITTI/000001.npz": b""}, is_device), "it is no ordinary file"),
    "traversal": (lambda: tar_of({"../KITTI/000001.npz": NPZ}), "its path leaves the archive's root"),
    "absolute": (lambda: tar_of({"/KITTI/000001.npz": NPZ}), "its path is absolute"),
    "other case": (lambda: tar_of({"KITTI/000001.npz": NPZ, "kitti/000001.NPZ": NPZ}), "the same name as"),
    "not UTF-8": (lambda: raw_name(b"KITTI/\xff.npz"), "its name is not UTF-8"),
    "nested": (lambda: tar_of({"more.zip": zip_of({"KITTI/000001.npz": NPZ})}), "an archive inside the archive"),
    "bomb": (lambda: tar_of({"KITTI/000001.npz": b"\0" * 60 * 2**20}), "unpacks to"),
    "header bomb": (long_extended_header, "a header in the tar is too long"),
    "header chain": (header_chain, "broken"),
    "cut off": (lambda: tar_of({"KITTI/000001.npz": NPZ})[:-40], "broken"),
    "empty": (lambda: tar_of({}), "the tar holds no file that could be read"),
    "no tar": (lambda: b"\x1f\x8bhello", "broken"),
    "nothing": (lambda: b"", "broken"),
}


@pytest.mark.parametrize("name", HOSTILE_TARS)
def test_a_hostile_tar_is_refused(name: str) -> None:
    make, message = HOSTILE_TARS[name]
    assert any(message in each["message"] for each in problems("a.tar.gz", make()))


def test_a_tar_cut_off_before_it_was_packed_is_noticed() -> None:
    import gzip

    whole = gzip.decompress(tar_of({"KITTI/000000.npz": NPZ, "KITTI/000001.npz": NPZ}))
    for size in (len(NPZ), 512 + 2 * len(NPZ), 1500):
        assert problems("a.tar.gz", gzip.compress(whole[:size]))


@pytest.mark.parametrize("name", ["results.rar", "results.tar", "results", "results.csv"])
def test_other_kinds_of_files_are_refused(name: str) -> None:
    (problem,) = problems(name, NPZ)
    assert "one .npz, .json or .npy per image" in problem["expected"]


@given(st.binary(max_size=400), st.sampled_from(["a.zip", "a.tar.gz", "a.npz", "a.npy", "a.json"]))
def test_rubbish_is_an_error_of_ours(data: bytes, name: str) -> None:
    assert problems(name, data)


@given(st.integers(0, 600), st.integers(0, 255), st.sampled_from(["results.zip", "results.tar.gz"]))
def test_a_changed_byte_is_read_or_told(place: int, value: int, name: str) -> None:
    data = bytearray(PACKERS[name]({"KITTI/000001.npz": NPZ}))
    data[place % len(data)] = value
    with contextlib.suppress(InvalidSubmission):  # any other error fails the test
        content = read(name, bytes(data))
        assert set(content.segments) <= {image.name for image in IMAGES}
