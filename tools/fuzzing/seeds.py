"""Small valid files of every kind that is read, always the same ones."""

from __future__ import annotations

import io
import json
import pickle
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Mapping

import cv2
import numpy as np
import yaml
from PIL import Image

from app.calibration.exports.export import export_lens
from app.calibration.exports.intrinsics import nominal_intrinsics
from app.calibration.lens import CameraLens
from app.formats.json_writer import write_json, write_json_set
from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz, write_npz_set
from app.vision.segments import Segments
from tools.fuzzing.image_files import bmp, png, riff, tiff, tiff_entries

SIZE = (24, 18)
NAMES = ("a/one", "b/two")
CAMERA = {
    "width": 1242,
    "height": 375,
    "K": [[721.5, 0, 609.6], [0, 721.5, 172.9], [0, 0, 1]],
    "D": [-0.3, 0.1, 0, 0, 0],
}


def labelled() -> LabelledSegments:
    """Two segments with all that a file can say of them."""
    lines = [np.array([[1.5, 2], [9, 3.25], [20, 4]]), np.array([[3, 15], [22, 11.5]])]
    return LabelledSegments(
        Segments.from_list(lines, [0.5, 0.25]),
        straightness=np.array([0.9, 0.1], np.float32),
        verdicts=("keep", "reject"),
        origins=("pipeline", "manual"),
        ids=("1", "2"),
        reasons=(None, "shadow"),
    )


def plain() -> LabelledSegments:
    """The same segments alone."""
    return LabelledSegments(labelled().segments)


def label_npy(protocol: int) -> bytes:
    """Return a label file as numpy writes it: an object array of segments, pickled."""
    lines = np.empty(2, object)
    for place, line in enumerate(labelled().segments):
        lines[place] = line.astype(np.float64).reshape(-1, 1, 2)
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": "|O", "fortran_order": False, "shape": (2,)})
    return stream.getvalue() + pickle.dumps(lines, protocol=protocol)


def plain_npy(array: np.ndarray) -> bytes:
    """Return an array as npy."""
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


def npz_arrays() -> dict[str, bytes]:
    """Members of a npz of segments."""
    segments = labelled().segments
    return {"points": plain_npy(segments.points), "offsets": plain_npy(segments.offsets)}


def labels_as(kind: str) -> bytes:
    """Return labels as json, json-set, npz or npz-set."""
    match kind:
        case "json":
            return write_json(labelled())
        case "json-set":
            return write_json_set((name, labelled()) for name in NAMES)
        case "npz":
            return write_npz(plain())
        case _:
            return write_npz_set((name, plain()) for name in NAMES)


def archive(members: Mapping[str, bytes], kind: str) -> bytes:
    """Return the members as a zip or an unpacked tar."""
    stream = io.BytesIO()
    if kind == "zip":
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
            for name, content in members.items():
                packed.writestr(zipfile.ZipInfo(name), content)
    else:
        with tarfile.open(fileobj=stream, mode="w", format=tarfile.PAX_FORMAT) as packed:
            for name, content in members.items():
                info = tarfile.TarInfo(name)
                info.size = len(content)
                packed.addfile(info, io.BytesIO(content))
    return stream.getvalue()


def predictions() -> dict[str, bytes]:
    """Members of a submission."""
    return {f"{NAMES[0]}.json": labels_as("json"), f"{NAMES[1]}.npz": labels_as("npz"), "readme.txt": b"lines"}


def calibrations() -> list[bytes]:
    """A camera as each kind of file that is read, and one with aliases, which aren't."""
    lens = CameraLens("opencv", 1242, 375, (-0.18, 0.05, 0.0, 0.0, 0.0, 0.01, -0.02))
    intrinsics = nominal_intrinsics(1242, 375, lens.center)
    keys = ("opencv-yaml", "opencv-json", "ros", "clearlines")
    files = [export_lens(lens, key, camera_name="front", intrinsics=intrinsics).content for key in keys]
    anchored = yaml.safe_dump({"front": CAMERA, "rear": CAMERA}).encode()  # PyYAML writes the second as an alias
    return [*files, json.dumps({"front": CAMERA}).encode(), anchored]


def images() -> list[bytes]:
    """Small images of every format."""
    random = np.random.default_rng(1)
    colour = random.integers(0, 256, (SIZE[1], SIZE[0], 3), dtype=np.uint8)
    found = [cv2.imencode(ending, colour)[1].tobytes() for ending in (".png", ".jpg", ".bmp", ".webp", ".ppm")]
    found += [cv2.imencode(".png", colour.astype(np.uint16) * 257)[1].tobytes()]
    for kind, options in (
        ("TIFF", {"compression": "tiff_lzw"}),
        ("TIFF", {"compression": "tiff_adobe_deflate"}),
        ("TIFF", {"big_tiff": True}),
        ("JPEG", {"progressive": True}),
        ("WEBP", {"lossless": True}),
        ("PNG", {"exif": orientation(6)}),
        ("JPEG", {"exif": orientation(8)}),
    ):
        stream = io.BytesIO()
        Image.fromarray(colour).save(stream, kind, **options)
        found.append(stream.getvalue())
    width, height = SIZE
    found += [
        tiff(tiff_entries(width, height), colour[..., 0].tobytes()),
        tiff(tiff_entries(width, height), colour[..., 0].tobytes(), order=">"),
        bmp(width, -height, colour.tobytes()),
        png(width, height),
        riff((b"VP8X", struct.pack("<IHBHB", 0, width - 1, 0, height - 1, 0)), (b"VP8L", b"/" + zlib.compress(b"x"))),
        b"P5 # made by hand\n24 18\n65535\n" + colour[..., :2].tobytes(),
        b"P2\n3 2\n255\n1 2 3\n4 5 6\n",
    ]
    return found


def orientation(value: int) -> Image.Exif:
    """Return EXIF that asks a viewer to turn the image."""
    exif = Image.Exif()
    exif[0x0112] = value
    return exif
