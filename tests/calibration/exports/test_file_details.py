"""Conventions of single formats: pixel centres, order, which model is chosen."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pycolmap
import pytest
import yaml
from scipy.io import loadmat

from app.calibration.exports import choose_intrinsics, export_lens
from app.calibration.lens import CameraLens
from app.vision.frame import frame_grid


def opencv_lens(*parameters: float) -> CameraLens:
    return CameraLens("opencv", 240, 160, (*parameters, *(0.0,) * (5 - len(parameters)), 0.01, -0.02))


@pytest.mark.parametrize(
    ("lens", "model", "count"),
    [
        (opencv_lens(-0.1), "SIMPLE_RADIAL", 4),
        (opencv_lens(-0.1, 0.03), "RADIAL", 5),
        (opencv_lens(-0.1, 0.03, 0.0, 0.002), "OPENCV", 8),
        (opencv_lens(-0.1, 0.03, 0.1, 0.001), "FULL_OPENCV", 12),
    ],
)
def test_colmap_gets_the_simplest_model_that_is_exact(lens: CameraLens, model: str, count: int) -> None:
    content = export_lens(lens, "colmap", camera_name="a", intrinsics=choose_intrinsics(lens, focal_length=200)).content
    (line,) = [line for line in content.decode().splitlines() if not line.startswith("#")]
    words = line.split()
    assert words[:4] == ["1", model, "240", "160"]
    parameters = [float(word) for word in words[4:]]
    assert len(parameters) == count
    assert parameters[0] == 200
    focal_lengths = 1 if count < 8 else 2
    assert parameters[focal_lengths : focal_lengths + 2] == pytest.approx(np.add(lens.center, 0.5))


def test_matlab_counts_from_one_and_has_its_matrix_transposed_too() -> None:
    lens = opencv_lens(-0.1, 0.03, 0.01, 0.002, -0.001)
    content = export_lens(lens, "matlab", camera_name="a", intrinsics=choose_intrinsics(lens, focal_length=200)).content
    fields = loadmat(io.BytesIO(content))
    x, y = lens.center
    np.testing.assert_allclose(fields["K"], [[200, 0, x + 1], [0, 200, y + 1], [0, 0, 1]])
    np.testing.assert_array_equal(fields["IntrinsicMatrix"], fields["K"].T)
    unit = 200 / lens.scale
    np.testing.assert_allclose(
        fields["RadialDistortion"], [[-0.1 * unit**2, 0.03 * unit**4, 0.01 * unit**6]], rtol=1e-5
    )
    np.testing.assert_allclose(fields["TangentialDistortion"], [[0.002 * unit, -0.001 * unit]], rtol=1e-5)
    assert fields["Skew"].item() == 0


def test_the_projection_of_ros_keeps_the_focal_length_that_was_asked_for() -> None:
    lens = CameraLens("brown", 1392, 512, (0.2, 0.02, 0.03, 0.001, -0.001, 0.005, -0.018))
    x, y = lens.center
    intrinsics = choose_intrinsics(lens, focal_length=980, principal_point=(x + 20, y + 10))
    content = export_lens(lens, "ros", camera_name="Front 1", intrinsics=intrinsics, limit=1).content
    fields = yaml.safe_load(content)
    projection = np.reshape(fields["projection_matrix"]["data"], (3, 4))
    np.testing.assert_allclose(projection, [[980, 0, x + 20, 0], [0, 980, y + 10, 0], [0, 0, 1, 0]])
    assert fields["camera_matrix"]["data"][0] != 980
    assert fields["camera_name"] == "Front_1"


@pytest.mark.parametrize("name", ["wide", "pincushion", "decentred"])
def test_opencv_undistorts_with_the_file_as_our_lens_does(name: str, lenses: Mapping[str, CameraLens]) -> None:
    lens = lenses[name]
    intrinsics = choose_intrinsics(lens, focal_length=0.7 * lens.width)
    exported = export_lens(lens, "opencv-yaml", camera_name="a", intrinsics=intrinsics)
    storage = cv2.FileStorage(exported.content.decode(), cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)
    matrix, coefficients = (storage.getNode(each).mat() for each in ("camera_matrix", "distortion_coefficients"))
    x, y = intrinsics.principal_point
    stated = np.array([[intrinsics.focal_length, 0, x], [0, intrinsics.focal_length, y], [0, 0, 1]])

    size = (lens.width, lens.height)
    maps = cv2.initUndistortRectifyMap(matrix, coefficients, np.eye(3), stated, size, cv2.CV_32FC2)[0]
    corrected = np.stack(np.meshgrid(np.arange(lens.width), np.arange(lens.height)), -1).reshape(-1, 2)
    expected = lens.distort(corrected)
    inside = ((expected >= 0) & (expected <= np.subtract(size, 1))).all(axis=1)
    assert inside.mean() > 0.5
    assert np.abs(maps.reshape(-1, 2) - expected)[inside].max() <= 1.2 * exported.error.maximum + 1e-3

    measured = frame_grid(*size, 17)
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 300, 1e-12)
    found = cv2.undistortPoints(measured.reshape(-1, 1, 2), matrix, coefficients, None, None, stated, stop).reshape(
        -1, 2
    )
    stretch = np.linalg.norm(lens.jacobian(measured), 2, axis=(1, 2))
    off = np.hypot(*(found - lens.undistort(measured)).T)
    assert (off <= 1.5 * stretch * exported.error.maximum + 1e-5).all()


@pytest.mark.parametrize("name", ["plain", "wide", "decentred"])
def test_colmap_corrects_as_our_lens_does(name: str, lenses: Mapping[str, CameraLens], tmp_path: Path) -> None:
    lens = lenses[name]
    intrinsics = choose_intrinsics(lens, focal_length=0.7 * lens.width)
    exported = export_lens(lens, "colmap", camera_name="a", intrinsics=intrinsics)
    (tmp_path / "cameras.txt").write_bytes(exported.content)
    for file_name in ("images.txt", "points3D.txt"):
        (tmp_path / file_name).touch()
    measured = frame_grid(lens.width, lens.height, 17)
    rays: Any = pycolmap.Reconstruction(tmp_path).cameras[1].cam_from_img(measured + 0.5)
    found = intrinsics.focal_length * rays + intrinsics.principal_point
    stretch = np.linalg.norm(lens.jacobian(measured), 2, axis=(1, 2))
    off = np.hypot(*(found - lens.undistort(measured)).T)
    assert (off <= 1.5 * stretch * exported.error.maximum + 1e-5).all()


def test_mrcal_reads_its_own_file(lenses: Mapping[str, CameraLens], tmp_path: Path) -> None:
    mrcal = pytest.importorskip("mrcal", reason="mrcal isn't installed")
    lens = lenses["barrel"]
    intrinsics = choose_intrinsics(lens, focal_length=150)
    exported = export_lens(lens, "mrcal", camera_name="a", intrinsics=intrinsics)
    (tmp_path / exported.file_name).write_bytes(exported.content)
    model = mrcal.cameramodel(str(tmp_path / exported.file_name))
    measured = np.array([[5.0, 5.0], [100.0, 40.0], [200.0, 60.0]])
    rays = mrcal.unproject(measured, *model.intrinsics())
    expected = (lens.undistort(measured) - intrinsics.principal_point) / intrinsics.focal_length
    np.testing.assert_allclose(rays[:, :2] / rays[:, 2:], expected, atol=2 * exported.error.maximum / 150 + 1e-9)
