"""docs/exports.md: its programs run, its figures are true, and it leaves no format out."""

from __future__ import annotations

import ast
import importlib
import io
import json
import re
import zipfile
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import scipy.io
import yaml

from app.calibration.exports import FORMATS, choose_intrinsics, export_lens, overview
from app.calibration.lens import CameraLens

PAGE = Path(__file__).resolve().parents[3] / "docs" / "exports.md"
TEXT = PAGE.read_text()
PROGRAMS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
LENS = CameraLens("division", 320, 240, (0.08, 0.01, 0.0, 0.01, -0.01))
KITTI_LIKE = CameraLens("division", 1392, 512, (0.238, -0.0475, 0.0468, 0.0053, -0.0181))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("exports")
    (path / "model").mkdir()
    for name in FORMATS:
        exported = export_lens(LENS, name, camera_name="front", intrinsics=choose_intrinsics(LENS, focal_length=250))
        (path / exported.file_name).write_bytes(exported.content)
    (path / "model" / "cameras.txt").write_bytes((path / "front_cameras.txt").read_bytes())
    for name in ("images.txt", "points3D.txt"):
        (path / "model" / name).touch()
    with zipfile.ZipFile(path / "front_stmap.zip") as archive:
        archive.extractall(path)
    return path


def run(program: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {
        "ast": ast,
        "cv2": cv2,
        "json": json,
        "np": np,
        "scipy": scipy,
        "yaml": yaml,
        "lensfunpy": importlib.import_module("lensfunpy"),
        "pycolmap": importlib.import_module("pycolmap"),
        "CameraLens": CameraLens,
        "open": opened,
        "image": picture(),
        "pixels": np.array([[20.0, 30.0], [160.0, 120.0], [300.0, 200.0]]),
        "width": LENS.width,
        "height": LENS.height,
    }
    exec(program, names)
    return names


def opened(path: str) -> io.StringIO:
    """A file that no short program need close."""
    return io.StringIO(Path(path).read_text())


def picture() -> np.ndarray:
    """A straight line of the scene, seen through the lens."""
    corners = LENS.undistort(np.array([[15.0, 25.0], [305.0, 25.0]]))
    bow = LENS.distort(np.linspace(corners[0], corners[1], 100))
    image = np.zeros((LENS.height, LENS.width), np.uint8)
    cv2.polylines(image, [np.round(bow * 16).astype(np.int32)], False, 255, 2, cv2.LINE_AA, 4)
    return image


def bow_of(image: np.ndarray) -> float:
    """By how much the bright line bends, px."""
    weight = image.astype(float)
    columns = np.flatnonzero(weight.sum(axis=0) > 300)[8:-8]
    rows = (weight * np.arange(len(image))[:, None]).sum(axis=0)[columns] / weight.sum(axis=0)[columns]
    return float(np.ptp(rows - np.polyval(np.polyfit(columns, rows, 1), columns)))


@pytest.mark.parametrize("program", PROGRAMS, ids=[program.split("\n", 1)[0][:40] for program in PROGRAMS])
def test_a_program_of_the_page_does_what_it_says(program: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run(program, folder, monkeypatch)
    assert bow_of(picture()) > 2
    if "undistorted" in names:
        assert bow_of(names["undistorted"]) < 0.5
    elif "pixels_again" in names:
        np.testing.assert_allclose(names["pixels_again"], names["pixels"], atol=1e-6)
        expected = (LENS.undistort(names["pixels"]) - LENS.center) / 250
        np.testing.assert_allclose(names["rays"], expected, atol=1e-3)
    elif "undistorted_points" in names:
        np.testing.assert_array_equal(names["undistorted_points"], LENS.undistort(names["pixels"]))
    else:
        matrix = names.get("K")
        if matrix is None:
            matrix = np.array([[names["fx"], 0, names["cx"]], [0, names["fy"], names["cy"]], [0, 0, 1]])
        assert bow_of(cv2.undistort(picture(), matrix, np.array(names["D"]))) < 0.5


def test_there_is_a_program_and_a_line_of_the_table_for_each_format() -> None:
    assert len(PROGRAMS) == len(FORMATS) - 1  # YAML and JSON of OpenCV share one
    for name in FORMATS:
        assert re.search(rf"^\| .*`{name}`.* \|", TEXT, re.MULTILINE)


def test_files_are_called_as_the_table_says() -> None:
    for each in FORMATS.values():
        assert f"`{each.file_name('NAME')}`" in TEXT


def test_the_figures_of_the_page_are_true() -> None:
    section = TEXT.split("corners moved by")[1].split("## ")[0]
    rows = [line.strip("| ").split(" | ") for line in section.splitlines() if line.startswith("| `")]
    stated = {name: (row[2], row[3]) for row in rows for name in re.findall(r"`([\w-]+)`", row[0])}
    options = overview(KITTI_LIKE, choose_intrinsics(KITTI_LIKE))
    assert set(stated) == {option.format for option in options} - {"clearlines"}
    for option in options:
        if option.format == "clearlines":
            continue
        assert option.error is not None
        rms, maximum = stated[option.format]
        assert float(rms.removesuffix(", refused")) == pytest.approx(option.error.rms, abs=6e-4)
        assert float(maximum) == pytest.approx(option.error.maximum, abs=6e-3)
        assert rms.endswith("refused") != option.allowed
    corner = np.array([[0.0, 0.0], [1391, 0], [0, 511], [1391, 511]])
    moved = np.hypot(*(KITTI_LIKE.undistort(corner) - corner).T).max()
    assert float(re.findall(r"corners moved by (\d+) px", TEXT)[0]) == pytest.approx(moved, abs=1)


def test_a_moderate_lens_is_exact_in_all_formats() -> None:
    lens = CameraLens("brown", 640, 480, (0.03, 0.0, 0.0, 0.0, 0.0, 0.004, -0.006))
    assert "none is further off than 0.01 px rms" in TEXT
    assert max(option.error.rms for option in overview(lens, choose_intrinsics(lens)) if option.error) <= 0.01
