import io
import stat
import struct
import zipfile

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import ClearLinesError, InvalidFile, TooLarge
from app.formats.archives import open_archive
from app.formats.limits import ArchiveLimits
from app.formats.zips import open_zip


def zipped(*members, method=zipfile.ZIP_DEFLATED):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        for name, content in members:
            info = name if isinstance(name, zipfile.ZipInfo) else zipfile.ZipInfo(name)
            info.compress_type = method
            archive.writestr(info, content)
    return stream.getvalue()


def entry(name, mode=0):
    info = zipfile.ZipInfo(name)
    info.external_attr = mode << 16
    return info


def rename(data, old, new):
    """Write a name that zipfile itself would not write; both have the same length."""
    assert len(old) == len(new)
    return data.replace(old, new)


def reasons(data, limits=None):
    with pytest.raises(InvalidFile) as caught, open_archive(data, where="up.zip", limits=limits or ArchiveLimits()):
        pass
    return caught.value.details.get("problems", [caught.value.message])


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_members_are_read_one_at_a_time(method):
    data = zipped(("KITTI/0.png", b"zero"), ("KITTI/", b""), ("ü 日本.png", b"one"), method=method)
    for source in (data, io.BytesIO(data)):
        with open_archive(source) as archive:
            assert [(member.path, member.size) for member in archive.members] == [("KITTI/0.png", 4), ("ü 日本.png", 3)]
            assert [archive.read(member) for member in archive.members] == [b"zero", b"one"]
            assert archive.ignored == (("KITTI/", "a folder"),)


def test_what_systems_add_and_nested_archives_are_left_out():
    names = ["__MACOSX/._a.png", "x/.DS_Store", "Thumbs.db", "desktop.ini", "._a.png", "in.zip", "b.tar.gz", "c.7z"]
    with open_archive(zipped(("a.png", b""), ("a.npz", b""), *((name, b"") for name in names))) as archive:
        assert [member.path for member in archive.members] == ["a.png", "a.npz"]
        assert [path for path, _ in archive.ignored] == names
        assert {why for _, why in archive.ignored[-3:]} == {"an archive inside the archive"}


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("../a.png", "leaves"),
        ("a/../../b.png", "leaves"),
        ("./a.png", "leaves"),
        ("/etc/passwd", "absolute"),
        ("C:/a.png", "absolute"),
        ("a//b.png", "empty part"),
        ("a\nb.png", "control"),
        ("a\x7fb.png", "control"),
        ("x" * 256, "too long"),
        ("/".join(["x" * 200] * 6), "too long"),
        (entry("link.png", stat.S_IFLNK | 0o777), "link"),
        (entry("pipe.png", stat.S_IFIFO | 0o666), "no ordinary file"),
        (entry("device.png", stat.S_IFBLK | 0o666), "no ordinary file"),
    ],
)
def test_hostile_entries_refuse_the_whole_archive(name, reason):
    (problem,) = reasons(zipped(("good.png", b"x"), (name, b"target")))
    assert reason in problem


def test_backslashes_and_null_bytes():
    data = zipped(("a+b.png", b""), ("good.png", b""))
    assert "backslash" in reasons(rename(data, b"a+b.png", b"a\\b.png"))[0]
    assert "control" in reasons(rename(data, b"a+b.png", b"a\0b.png"))[0]


def test_all_problems_are_named_at_once():
    assert len(reasons(zipped(("../a", b""), ("/b", b""), ("c", b""), ("C", b"")))) == 3


@pytest.mark.parametrize(
    "pair", [("a.png", "A.png"), ("K/a.png", "k/a.png"), ("e\u0301.png", "\u00e9.png"), ("ß.png", "ss.png")]
)
def test_names_equal_but_for_case(pair):
    (problem,) = reasons(zipped((pair[0], b"1"), (pair[1], b"2")))
    assert "same name" in problem


def test_the_same_name_twice():
    with pytest.warns(UserWarning, match="Duplicate"):
        data = zipped(("a.png", b"1"), ("a.png", b"2"))
    assert "same name" in reasons(data)[0]


def test_names_in_another_encoding():
    data = zipped(("a+b.png", b""), ("good.png", b""))
    latin = rename(data, b"a+b.png", b"a\xfcb.png")
    assert "not UTF-8" in reasons(latin)[0]
    plain = rename(zipped(("a++b.png", b"1")), b"a++b.png", "aüb.png".encode())
    with open_archive(plain) as archive:  # UTF-8 without the flag, as macOS writes it
        assert [member.path for member in archive.members] == ["aüb.png"]
        assert archive.read(archive.members[0]) == b"1"
    flagged = zipped(("aüb.png", b"1"))
    reasons(rename(flagged, "aüb.png".encode(), b"a\xff\xffb.png"))


def test_encrypted_members():
    data = bytearray(zipped(("a.png", b"secret")))
    data[data.index(b"PK\x03\x04") + 6] |= 1
    data[data.index(b"PK\x01\x02") + 8] |= 1
    assert "encrypted" in reasons(bytes(data))[0]


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_other_packings(method):
    assert "method" in reasons(zipped(("a.png", b"x" * 100), method=method))[0]


@pytest.mark.parametrize(
    "data", [b"", b"PK", b"no zip at all" * 10, zipped(), zipped(("a/", b"")), zipped((".DS_Store", b""))]
)
def test_no_zip_or_nothing_in_it(data):
    reasons(data)


def test_cut_off_archives():
    data = zipped(("a.png", bytes(range(256)) * 20), ("b.png", b"x"))
    for end in range(0, len(data), 11):
        with pytest.raises(InvalidFile), open_archive(data[:end]) as archive:
            [archive.read(member) for member in archive.members]


def test_changed_bytes_are_noticed():
    data = bytearray(zipped(("a.png", bytes(range(256)) * 4), method=zipfile.ZIP_STORED))
    data[100] ^= 1
    with open_archive(bytes(data)) as archive, pytest.raises(InvalidFile):
        archive.read(archive.members[0])


@pytest.mark.parametrize(
    "limits", [ArchiveLimits(members=2), ArchiveLimits(member_bytes=9), ArchiveLimits(total_bytes=29)]
)
def test_limits(limits):
    data = zipped(*((f"{index}.png", b"0123456789") for index in range(3)))
    with pytest.raises(TooLarge), open_archive(data, limits=limits):
        pass
    with open_archive(data, limits=ArchiveLimits(members=3, member_bytes=10, total_bytes=30)) as archive:
        assert len(archive.members) == 3


def test_a_bomb_is_refused_before_it_is_unpacked():
    data = zipped(("a.png", bytes(20 * 2**20)))
    assert len(data) < 30_000
    with pytest.raises(TooLarge) as caught, open_archive(data):
        pass
    assert "times its size" in caught.value.message


def test_a_member_that_lies_about_its_size_is_cut_off_there():
    data = bytearray(zipped(("a.png", bytes(2**20))))
    directory = data.index(b"PK\x01\x02")
    data[directory + 24 : directory + 28] = struct.pack("<I", 1000)
    with open_archive(bytes(data)) as archive, pytest.raises(InvalidFile):
        archive.read(archive.members[0])


def test_a_directory_of_a_million_entries_is_never_read():
    name = b"a"
    header = struct.pack("<4s6H3L5H2L", b"PK\x01\x02", 20, 20, 0, 0, 0, 0, 0, 0, 0, len(name), 0, 0, 0, 0, 0, 0) + name
    directory = header * 500_000
    end = struct.pack("<4s4H2LH", b"PK\x05\x06", 0, 0, 1, 1, len(directory), 0, 0)
    with pytest.raises(TooLarge) as caught, open_archive(directory + end, limits=ArchiveLimits(members=1000)):
        pass
    assert "directory" in caught.value.message


def test_the_callers_own_errors_pass_through():
    data = zipped(("a.png", b""))
    with pytest.raises(ValueError, match="mine"), open_archive(data):
        raise ValueError("mine")
    with pytest.raises(KeyError), open_zip(data, where="file", members=5):
        raise KeyError("mine")


WHOLE = zipped(("a.png", b"hello" * 20), ("b/c.npz", bytes(range(100))))


@settings(max_examples=200, deadline=None)
@given(st.lists(st.tuples(st.integers(0, len(WHOLE) - 1), st.integers(0, 255)), min_size=1, max_size=4))
def test_mutated_archives_are_read_or_refused_and_nothing_else(changes):
    data = bytearray(WHOLE)
    for at, value in changes:
        data[at] = value
    try:
        with open_archive(bytes(data)) as archive:
            for member in archive.members:
                assert len(archive.read(member)) == member.size
    except ClearLinesError:
        pass
