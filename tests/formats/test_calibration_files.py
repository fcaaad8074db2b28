"""Calibrations of other tools come in whole, and no file, however made, gets past the error tree."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from app.calibration.exports.export import export_lens
from app.calibration.exports.intrinsics import nominal_intrinsics
from app.calibration.lens import CameraLens
from app.errors import ClearLinesError, InvalidFile, TooLarge
from app.formats.calibration_files import read_calibration_file
from app.formats.reference_camera import ReferenceCamera, write_cameras
from app.vision.conversion import OpenCVLens
from app.vision.field import field_error

K = ((721.5, 0.0, 609.6), (0.0, 720.25, 172.9), (0.0, 0.0, 1.0))
D = (-0.36, 0.18, 0.001, -0.0005, -0.05)
CAMERA = ReferenceCamera(1242, 375, K, D)


def ros(**changes: Any) -> dict[str, Any]:
    return {
        "image_width": 1242,
        "image_height": 375,
        "camera_name": "front",
        "camera_matrix": {"rows": 3, "cols": 3, "data": [number for row in K for number in row]},
        "distortion_model": "plumb_bob",
        "distortion_coefficients": {"rows": 1, "cols": 5, "data": list(D)},
        **changes,
    }


def written_by_opencv(path: Path) -> bytes:
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    storage.write("image_width", 1242)
    storage.write("image_height", 375)
    storage.write("camera_matrix", np.array(K))
    storage.write("distortion_coefficients", np.array([D]).T)
    storage.release()
    return path.read_bytes()


@pytest.mark.parametrize("name", ["camera.yml", "camera.yaml", "camera.json"])
def test_what_opencv_writes_is_read(tmp_path: Path, name: str) -> None:
    assert read_calibration_file(written_by_opencv(tmp_path / name)) == CAMERA


@pytest.mark.parametrize(
    "data",
    [
        yaml.safe_dump(ros()).encode(),
        yaml.safe_dump({"width": 1242, "height": 375, "K": [*K[0], *K[1], *K[2]], "D": list(D)}).encode(),
        json.dumps(CAMERA.as_dict()).encode(),
        b"\xef\xbb\xbf" + write_cameras({"front": CAMERA}),
        json.dumps({"image_size": [1242, 375], "cameraMatrix": K, "distCoeffs": [list(D)]}).encode(),
    ],
)
def test_each_kind_gives_the_same_camera(data: bytes) -> None:
    assert read_calibration_file(data, size=(1242, 375)) == CAMERA


@pytest.mark.parametrize(
    ("family", "parameters", "limit"),
    [
        ("opencv", [-0.18, 0.05, -0.01, 0.001, -0.002, 0.01, -0.02], 1e-6),
        ("brown", [0.1, 0.02, 0.0, 0.001, 0.0, 0.01, -0.02], 0.1),
        ("division", [0.15, 0.0, 0.0, -0.01, 0.02], 0.5),
    ],
)
def test_our_own_file_comes_back_as_the_same_lens(family: str, parameters: list[float], limit: float) -> None:
    lens = CameraLens(family, 1242, 375, tuple(parameters))  # type: ignore[arg-type]
    written = export_lens(lens, "clearlines", camera_name="front", intrinsics=nominal_intrinsics(1242, 375))
    camera = read_calibration_file(written.content, where="front.json", size=(1242, 375))
    assert field_error(lens, OpenCVLens(camera.matrix, camera.distortion), 1242, 375).rms < limit


@pytest.mark.parametrize("key", ["opencv-yaml", "opencv-json", "ros", "clearlines"])
def test_what_we_export_is_read_as_the_same_lens(key: str) -> None:
    lens = CameraLens("opencv", 1242, 375, (-0.18, 0.05, 0.0, 0.0, 0.0, 0.01, -0.02))
    written = export_lens(lens, key, camera_name="front", intrinsics=nominal_intrinsics(1242, 375, lens.center))
    camera = read_calibration_file(written.content, size=(1242, 375))
    assert field_error(lens, OpenCVLens(camera.matrix, camera.distortion), 1242, 375).rms < 0.01


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"family": "fisheye"}, "unknown model 'fisheye'"),
        ({"parameters": [0.1]}, "5 finite numbers"),
        ({"width": -3}, "no image side"),
        ({"height": 999_999}, "no camera's image"),
        ({"parameters": [0.1, 1e300, 0.0, 0.0, 0.0]}, "too large"),
        ({"parameters": [0.95, 0.0, 0.0, 0.0, 0.0]}, "px away from its lens"),
    ],
)
def test_our_own_file_with_a_lens_that_can_not_be_is_told(changes: dict[str, Any], message: str) -> None:
    lens = {"family": "division", "width": 640, "height": 480, "parameters": [0.1, 0.0, 0.0, 0.0, 0.0], **changes}
    with pytest.raises(InvalidFile, match=message):
        read_calibration_file(json.dumps({"lens": lens}).encode())


def test_a_file_of_several_cameras_needs_to_be_told_which() -> None:
    data = write_cameras({"left": CAMERA, "right": ReferenceCamera(1242, 375, K, (0.0,) * 5)})
    assert read_calibration_file(data, camera="left") == CAMERA
    with pytest.raises(InvalidFile, match=r"2 cameras.*left, right"):
        read_calibration_file(data)
    with pytest.raises(InvalidFile, match="one of them called rear"):
        read_calibration_file(data, camera="rear")


def test_the_size_is_taken_from_the_images_where_the_file_has_none() -> None:
    data = json.dumps({"camera_matrix": K, "dist_coeffs": D}).encode()
    assert read_calibration_file(data, size=(640, 480)).width == 640
    with pytest.raises(InvalidFile, match="images of what size"):
        read_calibration_file(data)
    with pytest.raises(InvalidFile, match=r"images of 1242 x 375 px.*640 x 480"):
        read_calibration_file(json.dumps(ros()).encode(), size=(640, 480))


def test_a_camera_without_distortion_may_have_no_coefficients() -> None:
    data = yaml.safe_dump(ros(distortion_coefficients={"data": []}, distortion_model="")).encode()
    assert read_calibration_file(data).distortion == (0.0,) * 5


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "no calibration"),
        (b"[1, 2]", "no calibration"),
        (b"a: 1", "no camera matrix"),
        (b"\xff\xfe", "not UTF-8"),
        (b"{", "no JSON"),
        (b"a: [1, 2", "line 2, column 1: neither JSON nor YAML"),
        (b"a: &x [1]\nb: *x", "aliases are not read"),
        (b"K: !!python/object/apply:os.system [id]\nD: [0, 0, 0, 0]\nwidth: 2\nheight: 2", "'id' is no usable number"),
        (b"[" * 30 + b"]" * 30, "nested too deep"),
        (json.dumps(ros(distortion_model="equidistant")).encode(), "equidistant.*fisheye"),
        (json.dumps(ros(distortion_coefficients=[0, 0, 0])).encode(), "D is no distortion"),
        (json.dumps(ros(camera_matrix=[1, 0, 0, 0, 1, 0])).encode(), "has 6 numbers"),
        (json.dumps(ros(camera_matrix=[700, 0, 300, 0, 700, 200, 0, 0, 2])).encode(), "this is no camera matrix"),
        (json.dumps(ros(camera_matrix=[-7, 0, 300, 0, 700, 200, 0, 0, 1])).encode(), "not positive"),
        (json.dumps(ros(image_width=12.5)).encode(), "whole numbers"),
        (yaml.safe_dump(ros(image_width=float("nan"))).encode(), "no usable number"),
    ],
)
def test_what_can_not_be_used_is_told(data: bytes, message: str) -> None:
    with pytest.raises(ClearLinesError, match=message) as caught:
        read_calibration_file(data, where="ours.yaml")
    assert str(caught.value.where).startswith("ours.yaml")


def test_size_nodes_and_nesting_are_bounded() -> None:
    with pytest.raises(TooLarge, match="bytes"):
        read_calibration_file(b"#" * (2**20 + 1))
    with pytest.raises(TooLarge, match="too many parts"):
        read_calibration_file(b"a: [" + b"1," * 500_000 + b"1]")
    # deep nesting ends, and takes no stack down with it
    for opening in (b"[", b"{", b"- ", b"? ", b"a: {"):
        with pytest.raises(ClearLinesError):
            read_calibration_file(opening * (2**20 // len(opening)))


PARTS = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=9)
        | st.dictionaries(
            st.sampled_from(
                ["K", "D", "data", "width", "height", "camera_matrix", "image_size", "lens", "family", "x", "*"]
            ),
            inner,
            max_size=5,
        )
    ),
    max_leaves=20,
)


@given(PARTS, st.booleans())
@settings(max_examples=100, deadline=None)
def test_no_document_gets_past_the_error_tree(document: Any, as_json: bool) -> None:
    text = json.dumps(document) if as_json else yaml.safe_dump(document, allow_unicode=True)
    try:
        camera = read_calibration_file(text.encode(errors="replace"), size=(4, 3))
    except ClearLinesError:
        return
    assert camera.width == 4
    assert camera.matrix[0][0] > 0


@given(st.binary(max_size=60), st.integers(0, 400))
@settings(max_examples=150, deadline=None)
def test_no_damage_gets_past_the_error_tree(noise: bytes, place: int) -> None:
    whole = yaml.safe_dump(ros()).encode()
    with contextlib.suppress(ClearLinesError):
        read_calibration_file(whole[:place] + noise + whole[place + len(noise) :])


@given(
    st.sampled_from(["brown", "opencv", "division"]),
    st.lists(st.floats(-100, 100), min_size=7, max_size=7),
    st.integers(1, 3000),
)
@settings(max_examples=50, deadline=None)
def test_no_lens_of_ours_gets_past_the_error_tree(family: str, parameters: list[float], width: int) -> None:
    given = parameters if family != "division" else parameters[:5]
    document = {"lens": {"family": family, "width": width, "height": 480, "parameters": given}}
    with contextlib.suppress(ClearLinesError):
        camera = read_calibration_file(json.dumps(document).encode())
        assert np.isfinite(camera.distortion).all()
