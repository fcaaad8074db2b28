"""The tools that read the files, by name of the format.

Each reads a file with its own reader and says for points of the undistorted image where it sees them in the measured
one. Where a tool can't be had (MATLAB, Kalibr, mrcal) its documented formula stands in for it, which is OpenCV's.
"""

from __future__ import annotations

import ast
import importlib
import io
import json
import re
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pycolmap
import pytest
import yaml
from numpy.typing import NDArray
from scipy.io import loadmat

from app.calibration.exports import Exported, Intrinsics
from app.calibration.lens import CameraLens
from app.vision.frame import frame_grid

# both are compiled and say nothing of their types
lensfunpy: Any = importlib.import_module("lensfunpy")
etree: Any = importlib.import_module("lxml.etree")

Array = NDArray[np.float64]
Consumer = Callable[[Exported, CameraLens], tuple[Array, Array]]


def frame_points(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    """Points of the corrected image that cover the frame, px, and their rays; other points than those of the fit."""
    corrected = lens.undistort(frame_grid(lens.width, lens.height, 53))
    return corrected, rays_of(corrected, exported.intrinsics)


def rays_of(corrected: Array, intrinsics: Intrinsics) -> Array:
    return (corrected - intrinsics.principal_point) / intrinsics.focal_length


def seen_by_opencv(rays: Array, matrix: Any, coefficients: Any) -> Array:
    directions = np.column_stack([rays, np.ones(len(rays))])
    points, _ = cv2.projectPoints(directions, np.zeros(3), np.zeros(3), np.asarray(matrix), np.asarray(coefficients))
    return np.asarray(points, np.float64).reshape(-1, 2)


def pinhole(fx: float, fy: float, cx: float, cy: float) -> Array:
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])


def opencv(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    storage = cv2.FileStorage(exported.content.decode(), cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)
    assert (storage.getNode("image_width").real(), storage.getNode("image_height").real()) == (lens.width, lens.height)
    matrix, coefficients = (storage.getNode(name).mat() for name in ("camera_matrix", "distortion_coefficients"))
    corrected, rays = frame_points(exported, lens)
    return corrected, seen_by_opencv(rays, matrix, coefficients)


def ros(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    fields = yaml.safe_load(exported.content)
    assert fields["distortion_model"] in {"plumb_bob", "rational_polynomial"}
    shapes = {name: (each["rows"], each["cols"]) for name, each in fields.items() if isinstance(each, dict)}
    arrays = {name: np.reshape(fields[name]["data"], shape) for name, shape in shapes.items()}
    assert shapes["distortion_coefficients"] == (1, 5 if fields["distortion_model"] == "plumb_bob" else 8)
    # rectification: the ray is turned and projected by P; what isn't turned must come out where the lens corrects to
    corrected, rays = frame_points(exported, lens)
    directions = np.column_stack([rays, np.ones(len(rays))]) @ arrays["rectification_matrix"].T
    projected = directions @ arrays["projection_matrix"][:, :3].T + arrays["projection_matrix"][:, 3]
    rectified = projected[:, :2] / projected[:, 2:]
    np.testing.assert_allclose(rectified, corrected, atol=1e-8)
    return rectified, seen_by_opencv(rays, arrays["camera_matrix"], arrays["distortion_coefficients"])


def kalibr(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    camera = yaml.safe_load(exported.content)["cam0"]
    assert (camera["camera_model"], camera["distortion_model"]) == ("pinhole", "radtan")
    assert camera["resolution"] == [lens.width, lens.height]
    assert len(camera["distortion_coeffs"]) == 4
    corrected, rays = frame_points(exported, lens)
    return corrected, seen_by_opencv(rays, pinhole(*camera["intrinsics"]), camera["distortion_coeffs"])


def colmap(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    with tempfile.TemporaryDirectory() as folder:
        for name in ("images.txt", "points3D.txt"):
            Path(folder, name).touch()
        Path(folder, "cameras.txt").write_bytes(exported.content)
        camera = pycolmap.Reconstruction(folder).cameras[1]
    assert (camera.width, camera.height) == (lens.width, lens.height)
    corrected, rays = frame_points(exported, lens)
    seen: Any = camera.img_from_cam(np.column_stack([rays, np.ones(len(rays))]))
    return corrected, seen - 0.5


def matlab(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    fields = loadmat(io.BytesIO(exported.content))
    assert fields["ImageSize"].tolist() == [[lens.height, lens.width]]
    k1, k2, k3 = fields["RadialDistortion"].ravel()
    p1, p2 = fields["TangentialDistortion"].ravel()
    corrected, rays = frame_points(exported, lens)
    return corrected, seen_by_opencv(rays, fields["IntrinsicMatrix"].T, [k1, k2, p1, p2, k3]) - 1


def mrcal(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    camera = ast.literal_eval(exported.content.decode())
    count = int(camera["lensmodel"].removeprefix("LENSMODEL_OPENCV"))
    assert len(camera["intrinsics"]) == 4 + count
    assert camera["imagersize"] == [lens.width, lens.height]
    assert camera["extrinsics"] == [0.0] * 6
    corrected, rays = frame_points(exported, lens)
    return corrected, seen_by_opencv(rays, pinhole(*camera["intrinsics"][:4]), camera["intrinsics"][4:])


def lensfun(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    """Every pixel of Lensfun's corrected image; how much larger that is than ours is told in the file alone.

    Three columns at a time: of four pixels or more Lensfun 0.3 computes four at once, and wrongly so with ptlens.
    """
    return _lensfun(exported, lens, 3)


def lensfun_at_once(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    """The same in one call, as photo editors do it."""
    return _lensfun(exported, lens, lens.width)


def _lensfun(exported: Exported, lens: CameraLens, columns: int) -> tuple[Array, Array]:
    tree = etree.fromstring(exported.content)
    database = lensfunpy.Database(xml=exported.content.decode(), load_common=False, load_bundled=False)
    (camera,) = database.cameras
    (found,) = database.find_lenses(camera)
    modifier = lensfunpy.Modifier(found, camera.crop_factor, lens.width, lens.height)
    focal_length = float(tree.find("lens/focal").get("value"))
    modifier.initialize(focal_length, 8, 1000, pixel_format=np.uint8, flags=lensfunpy.ModifyFlags.DISTORTION)
    strips = [modifier.apply_geometry_distortion(x, 0, columns, lens.height) for x in range(0, lens.width, columns)]
    measured = np.concatenate(strips, axis=1)[:, : lens.width].astype(np.float64).reshape(-1, 2)
    comments = " ".join(str(each.text) for each in tree.iter(etree.Comment))
    scale = re.search(r"corrected image is ([\d.]+) times", comments)
    larger = float(scale[1]) if scale else 1.0
    return (pixels_of(lens) - lens.center) / larger + lens.center, measured


def remap(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    with np.load(io.BytesIO(exported.content), allow_pickle=False) as archive:
        fields = dict(archive)
    assert fields["map_x"].shape == fields["map_y"].shape == (lens.height, lens.width)
    assert fields["map_x"].dtype == fields["map_y"].dtype == np.float32
    inverse = fields["camera_matrix"] @ np.linalg.inv(fields["new_camera_matrix"])
    corrected = (np.column_stack([pixels_of(lens), np.ones(lens.width * lens.height)]) @ inverse.T)[:, :2]
    return corrected, np.stack([fields["map_x"].ravel(), fields["map_y"].ravel()], -1).astype(np.float64)


def stmap(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    with zipfile.ZipFile(io.BytesIO(exported.content)) as archive:
        (name,) = [each for each in archive.namelist() if each.endswith("undistort.tif")]
        packed = np.frombuffer(archive.read(name), np.uint8)
        readme = archive.read("README.txt").decode()
    pixels = cv2.imdecode(packed, cv2.IMREAD_UNCHANGED)
    assert pixels is not None
    assert pixels.shape == (lens.height, lens.width, 3)
    assert pixels.dtype == np.float32
    blue, t, s = (pixels[:, :, channel].ravel().astype(np.float64) for channel in range(3))
    assert not blue.any()
    matrix = np.array([line.split() for line in readme.splitlines()[-3:]], np.float64)
    rays = (pixels_of(lens) - matrix[:2, 2]) / matrix[[0, 1], [0, 1]]
    corrected = exported.intrinsics.focal_length * rays + exported.intrinsics.principal_point
    return corrected, np.stack([s * lens.width - 0.5, (1 - t) * lens.height - 0.5], -1)


def clearlines(exported: Exported, lens: CameraLens) -> tuple[Array, Array]:
    other = CameraLens.from_dict(json.loads(exported.content)["lens"])
    corrected, _ = frame_points(exported, lens)
    return corrected, other.distort(corrected)


def pixels_of(lens: CameraLens) -> Array:
    grid = np.meshgrid(np.arange(lens.width, dtype=np.float64), np.arange(lens.height, dtype=np.float64))
    return np.stack(grid, -1).reshape(-1, 2)


@pytest.fixture(scope="session")
def consumers() -> Mapping[str, Consumer]:
    return {
        "opencv-yaml": opencv,
        "opencv-json": opencv,
        "ros": ros,
        "kalibr": kalibr,
        "colmap": colmap,
        "matlab": matlab,
        "lensfun": lensfun,
        "mrcal": mrcal,
        "stmap": stmap,
        "remap": remap,
        "clearlines": clearlines,
    }


@pytest.fixture(scope="session")
def lensfun_whole() -> Consumer:
    return lensfun_at_once


@pytest.fixture(scope="session")
def lenses() -> Mapping[str, CameraLens]:
    """Lenses of all families, barrel and pincushion, landscape and portrait, with centres off the middle."""
    return {
        "plain": CameraLens("brown", 240, 160, (0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
        "barrel": CameraLens("division", 207, 63, (0.1, 0.02, 0.0, 0.01, -0.01)),
        "wide": CameraLens("division", 232, 86, (0.238, -0.048, 0.047, 0.005, -0.018)),
        "pincushion": CameraLens("opencv", 120, 180, (0.08, -0.01, 0.002, 0.0005, -0.001, -0.01, 0.02)),
        "decentred": CameraLens("brown", 200, 150, (0.15, 0.01, 0.01, 0.001, -0.0015, 0.02, 0.01)),
        "barrel as OpenCV writes it": CameraLens("opencv", 201, 150, (-0.2, 0.06, -0.01, 0.001, -0.001, 0.005, 0.0)),
    }
