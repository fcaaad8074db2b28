"""Maps of every pixel: exact where they are computed, close between, and each the way back of the other."""

from __future__ import annotations

import io
import struct
import zipfile
from collections.abc import Mapping
from typing import Any

import cv2
import numpy as np
import pytest

from app.calibration.exports import choose_intrinsics, export_lens
from app.calibration.exports.pixel_map import CELL, NOWHERE, interpolated, pixel_map
from app.calibration.lens import CameraLens


def bent(points: Any) -> Any:
    return points + 1e-3 * points[:, ::-1] ** 2


@pytest.mark.parametrize(("width", "height"), [(1, 1), (4, 5), (13, 9), (8, 8)])
def test_a_map_is_exact_at_its_nodes_and_close_between(width: int, height: int) -> None:
    found = pixel_map(bent, width, height)
    grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1)
    exact = bent(grid.reshape(-1, 2).astype(float)).reshape(height, width, 2)
    np.testing.assert_allclose(found[::CELL, ::CELL], exact[::CELL, ::CELL], rtol=1e-6)
    # of a parabola the chord is off by the second derivative times the cell squared over eight
    assert np.abs(found - exact).max() <= 2e-3 * CELL**2 / 8 + 1e-5


def test_what_has_no_source_leads_far_outside() -> None:
    def half(points: Any) -> Any:
        return np.where(points[:, :1] < 10, points, np.nan)

    found = pixel_map(half, 20, 6)
    assert (found[:, :8] >= 0).all()
    # what lies in a cell with a node that has none has none
    assert (found[:, 8:] == NOWHERE).all()


def test_single_pixels_are_looked_up_as_in_the_whole_map() -> None:
    found = pixel_map(bent, 30, 20)
    pixels = np.array([[0, 0], [3, 5], [17, 19], [29, 1]], float)
    x, y = pixels.astype(int).T
    np.testing.assert_allclose(interpolated(bent, pixels), found[y, x], rtol=1e-6)


def maps_of(content: bytes) -> tuple[np.ndarray, np.ndarray]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = sorted(name for name in archive.namelist() if name.endswith(".tif"))
        images = [cv2.imdecode(np.frombuffer(archive.read(name), np.uint8), cv2.IMREAD_UNCHANGED) for name in names]
    redistort, undistort = (np.asarray(each) for each in images)
    return undistort, redistort


def as_px(image: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    height, width = image.shape[:2]
    return (image[:, :, 2] * width - 0.5).astype(np.float32), ((1 - image[:, :, 1]) * height - 0.5).astype(np.float32)


@pytest.mark.parametrize("name", ["barrel", "pincushion", "decentred"])
def test_there_and_back_is_where_it_began(name: str, lenses: Mapping[str, CameraLens]) -> None:
    lens = lenses[name]
    content = export_lens(lens, "stmap", camera_name="a", intrinsics=choose_intrinsics(lens)).content
    undistort, redistort = maps_of(content)
    source = np.dstack(as_px(undistort))
    back = cv2.remap(
        source, *as_px(redistort), cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=(-99, -99)
    )
    grid = np.dstack(np.meshgrid(np.arange(lens.width), np.arange(lens.height)))
    # at the border a neighbour of the looked up place may lie outside
    inner = (slice(3, -3), slice(3, -3))
    assert np.abs(back - grid)[inner].max() < 0.1


def test_the_whole_frame_is_in_the_undistorted_image(lenses: Mapping[str, CameraLens]) -> None:
    lens = lenses["barrel"]
    _, redistort = maps_of(export_lens(lens, "stmap", camera_name="a", intrinsics=choose_intrinsics(lens)).content)
    assert redistort[:, :, 1:].min() > 0
    assert redistort[:, :, 1:].max() < 1


def test_red_is_across_and_comes_first_in_the_file() -> None:
    """Read without OpenCV, whose own order of channels is the other way round."""
    lens = CameraLens.identity("brown", 16, 8)
    content = export_lens(lens, "stmap", camera_name="a", intrinsics=choose_intrinsics(lens)).content
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert archive.namelist() == ["a_undistort.tif", "a_redistort.tif", "README.txt"]
        tiff = archive.read("a_undistort.tif")
    upper_left = struct.pack("<6f", 0.5 / 16, 1 - 0.5 / 8, 0, 1.5 / 16, 1 - 0.5 / 8, 0)
    assert upper_left in tiff


def test_a_bent_line_is_straight_once_remapped() -> None:
    lens = CameraLens("division", 400, 300, (0.2, 0.0, 0.0, 0.0, 0.0))
    content = export_lens(lens, "remap", camera_name="a", intrinsics=choose_intrinsics(lens)).content
    with np.load(io.BytesIO(content), allow_pickle=False) as fields:
        map_x, map_y = fields["map_x"], fields["map_y"]
    corners = lens.undistort(np.array([[20.0, 30.0], [380.0, 30.0]]))
    bow = lens.distort(np.linspace(corners[0], corners[1], 200))
    image = np.zeros((300, 400), np.uint8)
    cv2.polylines(image, [np.round(bow * 16).astype(np.int32)], False, 255, 2, cv2.LINE_AA, 4)
    straight = cv2.remap(image, map_x, map_y, cv2.INTER_LINEAR).astype(float)
    columns = np.flatnonzero(straight.sum(axis=0) > 300)
    rows = (straight * np.arange(300)[:, None]).sum(axis=0)[columns] / straight.sum(axis=0)[columns]
    assert np.ptp(bow[:, 1]) > 8
    assert np.ptp(rows[5:-5]) < 0.5
