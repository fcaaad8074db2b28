"""Every parser that reads what others bring, with valid files to begin from; each reads, or raises our errors."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from app.errors import ClearLinesError
from app.formats.archives import open_archive
from app.formats.calibration_files import read_calibration_file
from app.formats.images_csv import read_images_csv
from app.formats.inert_npy import read_label_npy
from app.formats.json_segments import read_json, read_json_set
from app.formats.layout import find_layout
from app.formats.limits import ArchiveLimits
from app.formats.naming import check_image_name, name_images, name_segment_files
from app.formats.npz import is_npz_set, read_npz, read_npz_set
from app.formats.reference_camera import read_cameras
from app.formats.submission_files import ExpectedImage, canonical_form, read_submission
from app.formats.tars import read_tar
from app.images import decode_display, describe, thumbnail
from app.services.paging import read_cursor, write_cursor
from tools.fuzzing import seeds
from tools.fuzzing.forms import Form, as_it_is, gzipped, npz_member, png_with_sums, tar_member, zip_member

MAX_PIXELS = 1_000_000
LIMITS = ArchiveLimits(members=200, member_bytes=2**22, total_bytes=2**23)


@dataclass(frozen=True)
class Seed:
    """A valid file: what is changed of it, and what packs it again."""

    content: bytes
    form: Form = as_it_is


@dataclass(frozen=True)
class Parser:
    """A parser.

    Attributes:
        name: For the command line.
        read: Reads the bytes; raises nothing but errors of the tree.
        seeds: Makes the valid files.
    """

    name: str
    read: Callable[[bytes], object]
    seeds: Callable[[], list[Seed]]


def outcome(parser: Parser, data: bytes) -> ClearLinesError | None:
    """Read and return the error of the tree, if it was one; any other error gets through."""
    try:
        parser.read(data)
    except ClearLinesError as error:
        json.dumps(error.as_dict())  # it is sent as a problem document
        str(error).encode()
        return error
    return None


def _plain(*contents: bytes) -> list[Seed]:
    return [Seed(content) for content in contents]


def _label_files() -> list[Seed]:
    return _plain(*(seeds.label_npy(protocol) for protocol in (0, 2, 3, 5)), seeds.npz_arrays()["points"])


def _npz_files() -> list[Seed]:
    arrays = seeds.npz_arrays()
    members = [Seed(content, npz_member(name, arrays)) for name, content in arrays.items()]
    return [*_plain(seeds.labels_as("npz")), *members]


def _read_any_npz(data: bytes) -> None:
    if is_npz_set(data):
        read_npz_set(data)
    else:
        read_npz(data)


def _read_zip(data: bytes) -> None:
    with open_archive(data, limits=LIMITS) as archive:
        for member in archive.members:
            archive.read(member)


def _read_tar(data: bytes) -> None:
    for _ in read_tar(io.BytesIO(data), size=len(data), limits=LIMITS):
        pass


def _read_submission(name: str) -> Callable[[bytes], None]:
    images = [ExpectedImage(image, *seeds.SIZE) for image in seeds.NAMES]

    def read(data: bytes) -> None:
        canonical_form(read_submission(name, io.BytesIO(data), len(data), images))

    return read


def _read_image(data: bytes) -> None:
    header = describe(data, max_pixels=MAX_PIXELS)
    pixels = decode_display(data, max_pixels=MAX_PIXELS)
    if pixels.shape != (header.height, header.width, 3):
        raise AssertionError(f"{header} was decoded to {pixels.shape}")
    thumbnail(data, 16, max_pixels=MAX_PIXELS)


def _image_files() -> list[Seed]:
    found = seeds.images()
    return [*_plain(*found), *(Seed(data, png_with_sums) for data in found if data.startswith(b"\x89PNG"))]


def _read_names(data: bytes) -> None:
    paths = data.decode("utf-8", "surrogateescape").split("\n")
    find_layout(paths)
    for path in paths:
        check_image_name(path, where="names")
    name_images(paths)
    name_segment_files(paths)


def _read_cursor(data: bytes) -> None:
    read_cursor("name", data.decode("latin-1"))


def _parsers() -> Iterator[Parser]:
    yield Parser("npy", read_label_npy, _label_files)
    yield Parser("npz", _read_any_npz, lambda: [*_npz_files(), *_plain(seeds.labels_as("npz-set"))])
    yield Parser("json", read_json, lambda: _plain(seeds.labels_as("json")))
    yield Parser("json-set", read_json_set, lambda: _plain(seeds.labels_as("json-set")))
    table = b"name,camera,source,sequence\r\na/one,front,KITTI,00\r\nb/two.png,,,\r\n"
    yield Parser("images-csv", lambda data: read_images_csv(data, seeds.NAMES), lambda: _plain(table))
    cameras = json.dumps({"front": seeds.CAMERA, "rear": seeds.CAMERA}).encode()
    yield Parser("cameras", read_cameras, lambda: _plain(cameras, json.dumps(seeds.CAMERA).encode()))
    yield Parser("calibration", lambda data: read_calibration_file(data, size=(1242, 375)), _calibrations)
    zipped = seeds.archive(seeds.predictions(), "zip")
    tarred = seeds.archive(seeds.predictions(), "tar")
    yield Parser("zip", _read_zip, lambda: _plain(zipped))
    yield Parser("tar", _read_tar, lambda: [Seed(tarred, gzipped), *_plain(gzipped(tarred))])
    label = seeds.labels_as("json")
    in_zip = [Seed(label, zip_member("a/one.json")), Seed(seeds.label_npy(2), zip_member("b/two.npy"))]
    yield Parser("submission-zip", _read_submission("results.zip"), lambda: [*_plain(zipped), *in_zip])
    in_tar = [Seed(tarred, gzipped), Seed(label, tar_member("a/one.json"))]
    yield Parser("submission-tar", _read_submission("results.tar.gz"), lambda: in_tar)
    yield Parser("submission-npz", _read_submission("results.npz"), lambda: _plain(seeds.labels_as("npz-set")))
    yield Parser("submission-json", _read_submission("results.json"), lambda: _plain(seeds.labels_as("json-set")))
    yield Parser("image", _read_image, _image_files)
    names = b"images/a/one.png\nlabels/a/one_edge_segments_filtered.npy\nimages/b/zwei.JPG\nimages.csv"
    yield Parser("names", _read_names, lambda: _plain(names))
    cursor = write_cursor("name", "a/one", 7).encode()
    yield Parser("cursor", _read_cursor, lambda: _plain(cursor, cursor + b"="))


def _calibrations() -> list[Seed]:
    return _plain(*seeds.calibrations())


PARSERS = {parser.name: parser for parser in _parsers()}
