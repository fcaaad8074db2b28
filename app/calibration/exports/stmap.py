"""STMaps of visual effects (Nuke, Fusion, Blender): 32-bit float images that hold, for each pixel, where to look it up.

Red is across and green is up, both from 0 to 1 over the image, from its lower left corner; pixels count by their
centres, so the first column is at 0.5 / width.
"""

from __future__ import annotations

import io
import zipfile
from functools import partial

import cv2
import numpy as np
from numpy.typing import NDArray

from app.calibration.exports.draft import Draft
from app.calibration.exports.names import file_stem
from app.calibration.exports.pixel_map import PlaneMap, pixel_map
from app.calibration.exports.undistorted_frame import place, source, view_matrix
from app.errors import BrokenInstallation
from app.vision.undistorted_view import undistorted_view

MADE = (1980, 1, 1, 0, 0, 0)
"""Time of the members: the same lens gives the same bytes."""
UNCOMPRESSED = 1
README = """\
undistort.tif  takes the distortion out: apply it to the plate.
redistort.tif  puts it back: apply it to what was made on the undistorted plate.

32-bit float TIFF, {width} x {height} px. Red: s = (x + 0.5) / {width}. Green: t = 1 - (y + 0.5) / {height}, with x
and y the column and row, from the upper left pixel, that the pixel is looked up at. s and t count from the lower left
corner of the image. Values outside 0..1 lead outside the image. Blue is 0.

{lines}
Camera matrix of the undistorted plate, px, centre of the upper left pixel at (0, 0):
{matrix}
"""


def write_stmap(draft: Draft) -> bytes:
    """Write a zip of two float TIFFs, there and back, with a text that tells their convention."""
    view = undistorted_view(draft.lens)
    matrix = view_matrix(view, draft.corrected_matrix)
    readme = README.format(
        width=draft.lens.width,
        height=draft.lens.height,
        lines="".join(f"{line}\n" for line in draft.lines),
        matrix="\n".join(" ".join(f"{value:.9g}" for value in row) for row in matrix),
    )
    stem = file_stem(draft.camera_name)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, lookup in (("undistort", partial(source, view)), ("redistort", partial(place, view))):
            archive.writestr(_member(f"{stem}_{name}.tif"), _tiff(lookup, draft.lens.width, draft.lens.height))
        archive.writestr(_member("README.txt"), readme)
    return stream.getvalue()


def _tiff(lookup: PlaneMap, width: int, height: int) -> bytes:
    found = pixel_map(lookup, width, height)
    pixels: NDArray[np.float32] = np.zeros((height, width, 3), np.float32)
    # OpenCV takes blue, green, red
    pixels[:, :, 2] = (found[:, :, 0] + 0.5) / width
    pixels[:, :, 1] = 1 - (found[:, :, 1] + 0.5) / height
    done, content = cv2.imencode(".tiff", pixels, [cv2.IMWRITE_TIFF_COMPRESSION, UNCOMPRESSED])
    if not done:
        raise BrokenInstallation("OpenCV writes no float TIFF", hint="install opencv-python-headless with TIFF")
    return content.tobytes()


def _member(name: str) -> zipfile.ZipInfo:
    member = zipfile.ZipInfo(name, MADE)
    member.compress_type = zipfile.ZIP_DEFLATED
    return member
