"""The label files of the paper, as numpy writes and reads them."""

import io
import pickle
from pathlib import Path

import numpy as np
import pytest

from app.errors import InvalidFile, TooLarge
from app.formats.inert_npy import read_label_arrays, read_label_npy
from app.formats.limits import SegmentLimits
from app.vision.segments import Segments

YORK = Path(__file__).parents[3] / "shared" / "data" / "york" / "labels"
TWO = [[[0.5, 1], [2, 3.25]], [[4, 5], [6, 7], [8, 9.125]]]
SAME = [[[0.5, 1], [2, 3.25]], [[4, 5], [6, 7]]]


def objects(items):
    array = np.empty(len(items), dtype=object)
    for index, item in enumerate(items):
        array[index] = item
    return array


def paper(lines, dtype=np.float64):
    return objects([np.array(line, dtype).reshape(-1, 1, 2) for line in lines])


def npy(array, protocol=None):
    stream = io.BytesIO()
    if protocol is None:
        np.save(stream, array, allow_pickle=True)
    else:
        header = {"descr": "|O", "fortran_order": False, "shape": array.shape}
        np.lib.format.write_array_header_1_0(stream, header)
        stream.write(pickle.dumps(array, protocol=protocol))
    return stream.getvalue()


def header(descr="|O", shape=(1,), fortran=False):
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": descr, "fortran_order": fortran, "shape": shape})
    return stream.getvalue()


def test_real_label_files_read_equal_to_numpy():
    files = sorted(YORK.glob("*.npy"))
    if not files:
        pytest.skip("the York labels are not beside the project")
    assert len(files) == 51
    for path in files:
        data = path.read_bytes()
        expected = np.load(io.BytesIO(data), allow_pickle=True)
        found = read_label_arrays(data)
        assert len(found) == len(expected)
        for mine, theirs in zip(found, expected, strict=True):
            assert mine.dtype == theirs.dtype
            assert np.array_equal(mine, theirs)
        assert read_label_npy(data) == Segments.from_list(list(expected))


@pytest.mark.parametrize("protocol", range(6))
@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", ">f8", ">i2", "u1", "i8"])
def test_every_protocol_and_number_type(protocol, dtype):
    array = objects([np.array(line, dtype).reshape(-1, 1, 2) for line in TWO])
    data = npy(array, protocol)
    found = read_label_arrays(data)
    for mine, theirs in zip(found, np.load(io.BytesIO(data), allow_pickle=True), strict=True):
        assert np.array_equal(mine, theirs)
        assert mine.dtype.isnative
    assert read_label_npy(data) == Segments.from_list([np.array(line, dtype).astype(float) for line in TWO])


@pytest.mark.parametrize("protocol", range(6))
def test_column_major_segments(protocol):
    array = objects([np.asfortranarray(np.array(line)) for line in TWO])
    assert read_label_npy(npy(array, protocol)) == Segments.from_list(TWO)


@pytest.mark.parametrize("protocol", range(6))
@pytest.mark.parametrize("shape", [(2, 2, 1, 2), (2, 2, 2)])
def test_segments_that_numpy_stacked_into_an_object_array(protocol, shape):
    array = np.array(SAME).reshape(shape).astype(object)
    assert read_label_npy(npy(array, protocol)) == Segments.from_list(SAME)
    assert read_label_npy(npy(np.asfortranarray(array), protocol)) == Segments.from_list(SAME)


@pytest.mark.parametrize("shape", [(2, 2, 1, 2), (2, 2, 2)])
@pytest.mark.parametrize("dtype", ["f8", "f4", ">f8"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_segments_that_numpy_stacked_into_a_plain_array(shape, dtype, order):
    array = np.array(np.array(SAME).reshape(shape), dtype, order=order)
    assert read_label_npy(npy(array)) == Segments.from_list(SAME)


@pytest.mark.parametrize(
    "array", [objects([]), np.array([]), np.zeros((0, 1, 2)), np.zeros((0, 5), object), np.zeros((0, 1, 2), object)]
)
def test_no_segments(array):
    found = read_label_npy(npy(array))
    assert len(found) == 0
    assert found.points.shape == (0, 2)


def test_one_array_used_twice_is_two_segments():
    line = np.array(TWO[0])
    assert read_label_npy(npy(objects([line, line]))) == Segments.from_list([line, line])


def test_a_version_2_header():
    stream = io.BytesIO()
    np.lib.format.write_array(stream, paper(TWO), version=(2, 0))
    assert read_label_npy(stream.getvalue()) == Segments.from_list(TWO)


@pytest.mark.parametrize(
    ("array", "message", "where"),
    [
        (objects([np.zeros((3, 2)), np.zeros((3, 3))]), "shape (3, 3)", "segment 1"),
        (objects([np.zeros((3, 2, 1))]), "shape (3, 2, 1)", "segment 0"),
        (objects([np.zeros((2, 2, 2))]), "shape (2, 2, 2)", "segment 0"),
        (objects([np.zeros(4)]), "shape (4,)", "segment 0"),
        (objects([np.zeros((1, 1, 1, 2))]), "shape (1, 1, 1, 2)", "segment 0"),
        (objects([np.zeros((0, 1, 2))]), "no points", "segment 0"),
        (objects([np.array([[1, 2], [3, np.nan]])]), "not finite", "segment 0, point 1"),
        (objects([np.ones((2, 2)), np.array([[np.inf, 2]])]), "not finite", "segment 1, point 0"),
        (objects([np.array([[1e300, 2]])]), "outside", "segment 0, point 0"),
        (objects([np.array([["a", "b"]])]), "data type", "segment 0"),
        (objects([np.array([[True, False]])]), "data type", "segment 0"),
        (objects([np.array([[1j, 2]])]), "data type", "segment 0"),
        (objects([np.zeros((2, 2), np.longdouble)]), "data type", "segment 0"),
        (objects([objects([np.zeros((2, 2))])]), "data type", "segment 0"),
        (objects([objects([[1.0, 2.0]])]), "data type", "segment 0"),
        (objects([[[1.0, 2.0]]]), "no array", "segment 0"),
        (objects([None]), "no array", "segment 0"),
        (objects([3.0]), "no array", "segment 0"),
        (np.array(["x"], object), "no array", "segment 0"),
        (np.array([[None, None]], object), "no numbers", "file"),
        (np.array(5.0, object), "shape ()", "file"),
        (np.zeros((3, 2), object) * 1.0, "shape (3, 2)", "file"),
        (np.zeros((3, 2)), "shape (3, 2)", "file"),
        (np.zeros((3, 1, 2)), "shape (3, 1, 2)", "file"),
        (np.array(5.0), "shape ()", "file"),
        (np.zeros((2, 2, 2), complex), "data type", "file"),
        (np.array([[["a", "b"]] * 2]), "data type", "file"),
        (np.zeros(3, [("x", "f8")]), "data type", "file"),
        (np.zeros(3, [("x", "O")]), "fields", "file"),
    ],
)
def test_other_contents_are_refused_by_name(array, message, where):
    with pytest.raises(InvalidFile) as caught:
        read_label_npy(npy(array), where="labels/a.npy")
    assert message in caught.value.message
    assert caught.value.where == ("labels/a.npy" if where == "file" else f"labels/a.npy: {where}")


@pytest.mark.parametrize("element", [np.zeros(2, [("x", "f8"), ("y", "f8")]), np.array([[np.datetime64(1, "s")] * 2])])
def test_elements_with_fields_or_dates_are_refused(element):
    with pytest.raises(InvalidFile) as caught:
        read_label_npy(npy(objects([element])), where="labels/a.npy")
    assert "pickle" in caught.value.message


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x93NUMPY",
        b"\x93NUMPY\x01\x00",
        b"\x93NUMPY\x03\x00\x04\x00\x00\x00{}  ",
        b"\x93NUMPY\x09\x00\x04\x00{}  ",
        b"PK\x03\x04 no numpy file",
        pickle.dumps(paper(TWO)),
        header()[:-20],
        b"\x93NUMPY\x01\x00\x04\x00((((",
        b"\x93NUMPY\x01\x00\x10\x00{'descr': '|O', ",
        b"\x93NUMPY\x01\x00\x1d\x00__import__('os').system('id')",
        b"\x93NUMPY\x01\x00" + (3000).to_bytes(2, "little") + b"-" * 3000,
        b"\x93NUMPY\x02\x00" + (2**31).to_bytes(4, "little") + b" " * 100,
        header("V99999999999999", (1,)),
        header("|O, 5", (1,)),
    ],
)
def test_broken_headers(data):
    with pytest.raises(InvalidFile) as caught:
        read_label_npy(data)
    assert "no .npy file" in caught.value.message


def test_a_header_longer_than_any_array_needs():
    text = b"{'descr': '|O', 'fortran_order': False, 'shape': (1,), }" + b" " * 60_000 + b"\n"
    data = b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text + pickle.dumps(paper(TWO[:1]))
    with pytest.raises(InvalidFile):
        read_label_npy(data)


@pytest.mark.parametrize("descr", ["|O", "<f8"])
@pytest.mark.parametrize("shape", [(10**12,), (10**12, 2, 2), (2**62,), (2**62, 2**62), (0, 2**62, 2**62), (-1,)])
def test_a_header_that_promises_the_moon_takes_no_memory(descr, shape):
    body = pickle.dumps(paper(TWO), protocol=4) if descr == "|O" else b"\0" * 64
    with pytest.raises((InvalidFile, TooLarge)):
        read_label_npy(header(descr, shape) + body)


@pytest.mark.parametrize("shape", [(1,), (3,), (), (2, 1)])
def test_header_and_pickle_must_agree(shape):
    with pytest.raises(InvalidFile) as caught:
        read_label_npy(header("|O", shape) + pickle.dumps(paper(TWO), protocol=4))
    assert "promises" in caught.value.message


def test_a_file_cut_off_anywhere_is_refused():
    for data in (npy(paper(TWO)), npy(paper(TWO), 0), npy(np.array(SAME))):
        for end in range(len(data)):
            with pytest.raises(InvalidFile):
                read_label_npy(data[:end])


@pytest.mark.parametrize("array", [paper(TWO), np.array(SAME)])
def test_bytes_after_the_end_are_refused(array):
    with pytest.raises(InvalidFile):
        read_label_npy(npy(array) + b"\0")


@pytest.mark.parametrize("array", [paper(TWO), np.array(SAME), np.array(SAME).astype(object)])
@pytest.mark.parametrize("limits", [SegmentLimits(segments=1), SegmentLimits(points=3), SegmentLimits(file_bytes=100)])
def test_limits(array, limits):
    with pytest.raises(TooLarge):
        read_label_npy(npy(array), limits=limits)


def test_points_are_counted_before_they_are_copied():
    line = np.zeros((1000, 2))
    with pytest.raises(TooLarge) as caught:
        read_label_npy(npy(objects([line] * 5001)))
    assert "5,001,000 points" in caught.value.message
