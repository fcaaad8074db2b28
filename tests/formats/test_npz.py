import io
import zipfile

import numpy as np
import pytest

from app.errors import InvalidFile, TooLarge
from app.formats.limits import SegmentLimits, SetLimits
from app.formats.npz import read_npz, read_npz_set

POINTS = np.array([[0.5, 1], [2, 3], [4, 5], [6, 7], [8, 9]], np.float32)
GOOD = {"points": POINTS, "offsets": np.array([0, 2, 5])}
SET = {**GOOD, "names": np.array(["a", "KITTI/b", "c"]), "image_offsets": np.array([0, 1, 2, 2])}


def npz(save=np.savez, **arrays):
    stream = io.BytesIO()
    save(stream, **arrays)
    return stream.getvalue()


def zipped(**members):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(f"{name}.npy", content)
    return stream.getvalue()


def npy(array):
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


def npy_header(descr, shape):
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": descr, "fortran_order": False, "shape": shape})
    return stream.getvalue()


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
@pytest.mark.parametrize("points", ["f2", "f4", "f8", ">f8", "i4"])
@pytest.mark.parametrize("offsets", ["i4", "i8", "u8", ">i8"])
def test_what_numpy_writes_is_read(save, points, offsets):
    found = read_npz(npz(save, points=POINTS.astype(points), offsets=GOOD["offsets"].astype(offsets)))
    assert np.array_equal(found.segments.points, POINTS.astype(points).astype(np.float32))
    assert found.segments.offsets.tolist() == [0, 2, 5]
    assert found.segments.scores is None
    assert found.straightness is None


def test_column_major_points_and_unknown_arrays():
    found = read_npz(npz(**{**GOOD, "points": np.asfortranarray(POINTS)}, seconds=np.array(3.0), more=np.array("x")))
    assert np.array_equal(found.segments.points, POINTS)


def test_an_unknown_array_of_objects_is_never_looked_at():
    found = read_npz(npz(**GOOD, extra=np.array([{"a": 1}], object)))
    assert len(found) == 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"points": None}, "no array points"),
        ({"offsets": None}, "no array offsets"),
        ({"points": POINTS[:, :1]}, "shape (5, 1)"),
        ({"points": POINTS.ravel()}, "shape (10,)"),
        ({"points": POINTS.astype(complex)}, "complex128"),
        ({"points": POINTS.astype("U4")}, "<U4"),
        ({"points": np.array([[object()] * 2] * 5)}, "Python objects"),
        ({"points": POINTS * np.nan}, "not finite"),
        ({"points": POINTS * np.float32(1e30)}, "outside"),
        ({"offsets": np.array([0, 2, 4])}, "don't cover"),
        ({"offsets": np.array([1, 2, 5])}, "rise"),
        ({"offsets": np.array([0, 4, 2, 5])}, "rise"),
        ({"offsets": np.array([0, 2, 2, 5])}, "no points"),
        ({"offsets": np.array([0, 2**63, 5], np.uint64)}, "rise"),
        ({"offsets": np.array([0.0, 2, 5])}, "float64"),
        ({"offsets": np.zeros(0, int)}, "shape (0,)"),
        ({"scores": np.array([0.5])}, "shape (1,)"),
        ({"scores": np.array([0.5, 1.5])}, "out of range"),
        ({"scores": np.array([0.5, np.nan])}, "out of range"),
        ({"straightness": np.array([-0.1, 0.5])}, "out of range"),
        ({"verdicts": np.array(["keep", "perhaps"])}, "no verdict"),
        ({"verdicts": np.array([1, 2])}, "int64"),
        ({"names": np.array(["a"]), "image_offsets": np.array([0, 2])}, "several images"),
    ],
)
def test_wrong_arrays_are_refused(change, message):
    arrays = {name: array for name, array in {**GOOD, **change}.items() if array is not None}
    with pytest.raises(InvalidFile) as caught:
        read_npz(npz(**arrays), where="a.npz")
    assert message in caught.value.message
    assert str(caught.value.where).startswith("a.npz")


def test_a_bad_point_is_named():
    points = POINTS.copy()
    points[3, 1] = np.inf
    with pytest.raises(InvalidFile) as caught:
        read_npz(npz(points=points, offsets=GOOD["offsets"]), where="a.npz")
    assert caught.value.where == "a.npz: segment 1, point 1"


@pytest.mark.parametrize("limits", [SegmentLimits(segments=1), SegmentLimits(points=4), SegmentLimits(file_bytes=300)])
def test_limits(limits):
    with pytest.raises(TooLarge):
        read_npz(npz(**GOOD), limits=limits)


def test_a_member_that_unpacks_to_more_than_allowed_is_not_unpacked():
    data = zipped(points=npy_header("<f4", (10**7, 2)) + bytes(8 * 10**7), offsets=npy(np.array([0, 10**7])))
    assert len(data) < 200_000
    with pytest.raises(TooLarge):
        read_npz(data, limits=SegmentLimits(file_bytes=10**6))


@pytest.mark.parametrize("shape", [(10**12, 2), (2**62, 2), (4, 2), (6, 2)])
def test_a_header_that_does_not_fit_its_bytes(shape):
    data = zipped(points=npy_header("<f4", shape) + POINTS.tobytes(), offsets=npy(GOOD["offsets"]))
    with pytest.raises(InvalidFile):
        read_npz(data)


def test_the_same_array_twice(recwarn):
    stream = io.BytesIO(npz(**GOOD))
    with zipfile.ZipFile(stream, "a") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("points.npy", npy(POINTS + 1))
    with pytest.raises(InvalidFile):
        read_npz(stream.getvalue())


def test_cut_off_or_changed_files():
    data = npz(np.savez_compressed, **GOOD)
    for end in range(0, len(data), 7):
        with pytest.raises(InvalidFile):
            read_npz(data[:end])
    changed = bytearray(data)
    changed[data.index(b"points.npy") + 60] ^= 0x10
    with pytest.raises(InvalidFile):
        read_npz(bytes(changed))


def test_members_are_as_long_as_the_directory_says():
    data = bytearray(npz(**GOOD))
    entry = data.rindex(b"PK\x01\x02", 0, data.index(b"PK\x05\x06"))
    size = int.from_bytes(data[entry + 24 : entry + 28], "little")
    data[entry + 24 : entry + 28] = (size + 5).to_bytes(4, "little")
    with pytest.raises(InvalidFile):
        read_npz(bytes(data))


def test_one_file_for_all_images():
    found = read_npz_set(npz(**SET, scores=np.array([0.25, 0.75])))
    assert list(found) == ["a", "KITTI/b", "c"]
    assert [len(item) for item in found.values()] == [1, 1, 0]
    assert np.array_equal(found["KITTI/b"].segments.points, POINTS[2:])
    assert found["KITTI/b"].segments.scores == np.float32(0.75)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"names": None}, "no array names"),
        ({"image_offsets": None}, "no array image_offsets"),
        ({"names": np.array(["a", "b"])}, "doesn't fit"),
        ({"image_offsets": np.array([0, 1, 2, 3])}, "doesn't fit"),
        ({"names": np.array(["a", "a", "c"])}, "named twice"),
        ({"names": np.array(["a", "../b", "c"])}, "no name"),
        ({"names": np.array(["a", "/b", "c"])}, "no name"),
        ({"names": np.array(["a", "b\\c", "c"])}, "no name"),
        ({"names": np.array(["a", "b\nc", "c"])}, "no name"),
        ({"names": np.array([1, 2, 3])}, "int64"),
        ({"names": np.array(["a", "e\u0301", "\u00e9"])}, "named twice"),
    ],
)
def test_wrong_sets_are_refused(change, message):
    arrays = {name: array for name, array in {**SET, **change}.items() if array is not None}
    with pytest.raises(InvalidFile) as caught:
        read_npz_set(npz(**arrays))
    assert message in caught.value.message


@pytest.mark.parametrize(
    "limits",
    [SetLimits(images=2), SetLimits(segments=1), SetLimits(points=4), SetLimits(image=SegmentLimits(points=2))],
)
def test_limits_of_sets(limits):
    with pytest.raises(TooLarge):
        read_npz_set(npz(**SET), limits=limits)
