"""``clearlines calibrate``: from labels, from segments, from images; whole files, or none and the reason."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import yaml

from app.calibration.calibrate import CalibrationImage
from app.calibration.exports.catalog import FORMATS
from app.calibration.lens import CameraLens
from app.commands import calibrate as command
from app.commands.calibrate import CalibrateChoice, calibrate_cameras
from app.commands.calibrate_outputs import write_exports
from app.commands.calibrate_sources import CameraLines, GatheredLines, gather_lines
from app.errors import InvalidInput, NotFound
from app.formats.json_writer import write_json
from app.formats.label_npy import write_label_npy
from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz
from app.formats.reference_camera import ReferenceCamera
from app.vision.field import field_error
from app.vision.segments import Segments

SIZE = (640, 480)
TRUE = CameraLens("opencv", *SIZE, (-0.2, 0.04, 0.0, 0.0, 0.0, 0.0, 0.0))


def straight_lines(seed: int, count: int = 10, lens: CameraLens = TRUE) -> Segments:
    """Lines that are straight under the lens, as it shows them."""
    rng = np.random.default_rng(seed)
    lines: list[np.ndarray] = []
    while len(lines) < count:
        angle, middle = rng.uniform(0, np.pi), rng.uniform([0, 0], SIZE)
        along = np.arange(-130.0, 131.0)[:, None] * [np.cos(angle), np.sin(angle)]
        points = lens.distort(lens.undistort(middle[None]) + along)
        inside = (points >= 0).all(axis=1) & (points <= [SIZE[0] - 1, SIZE[1] - 1]).all(axis=1)
        if inside.sum() > 100:
            lines.append(points[inside] + rng.normal(0, 0.1, (int(inside.sum()), 2)))
    return Segments.from_list(lines)


def write_dataset(root: Path, names: Sequence[str], *, empty: bool = False) -> Path:
    for seed, name in enumerate(names):
        image, label = root / "images" / f"{name}.png", root / "labels" / f"{name}_edge_segments_filtered.npy"
        for path in (image, label):
            path.parent.mkdir(parents=True, exist_ok=True)
        cv2.imwrite(str(image), np.full((SIZE[1], SIZE[0]), 128, np.uint8))
        label.write_bytes(write_label_npy(Segments.empty() if empty else straight_lines(seed)))
    return root


@pytest.fixture
def dataset(tmp_path: Path) -> Path:
    return write_dataset(tmp_path / "town", ["one", "two", "three"])


def test_labels_of_a_dataset_give_a_lens_in_every_form(clearlines: Any, dataset: Path, tmp_path: Path) -> None:
    reference = {
        "width": 640,
        "height": 480,
        "K": [[400, 0, 319.5], [0, 400, 239.5], [0, 0, 1]],
        "D": [-0.2, 0.04, 0, 0],
    }
    (tmp_path / "known.json").write_text(json.dumps(reference))
    done = clearlines(
        "calibrate", dataset, "--family", "opencv",
        "--export", "ros", "--export", "opencv", "--export", "opencv-yaml", "--output", "out",
        "--focal-length", 400, "--reference", "known.json", "--report", "out/town.html", "--json", "-",
    )  # fmt: skip
    (camera,) = json.loads(done.stdout)["cameras"]
    calibration = camera["calibration"]
    assert (camera["camera"], camera["source"], calibration["accepted"]) == ("640x480", "labels", True)
    assert calibration["counts"]["images"] == 3
    assert camera["difference"]["rms"] == pytest.approx(field_error_of(calibration), abs=0.01)
    ros = yaml.safe_load((tmp_path / "out" / "640x480_camera_info.yaml").read_text())
    assert ros["image_width"] == 640
    np.testing.assert_allclose(ros["distortion_coefficients"]["data"][0], -0.2, atol=0.02)
    storage = cv2.FileStorage(str(tmp_path / "out" / "640x480_opencv.yaml"), cv2.FILE_STORAGE_READ)
    np.testing.assert_allclose(storage.getNode("camera_matrix").mat()[0, 0], 400, rtol=0.05)
    assert "Can be used" in (tmp_path / "out" / "town.html").read_text()
    for part in (
        "3 images",
        "30 of 30 kept lines straight",
        "accepted: expected error",
        "k1",
        "difference to known.json",
        "plumb_bob",
        "written: out/town.html",
    ):
        assert part in done.stderr
    assert not [path for path in (tmp_path / "out").iterdir() if path.name.startswith(".")]


def field_error_of(calibration: dict[str, Any]) -> float:
    """The distance from the truth, where the reference has the same polynomial with the focal length 400 px."""
    true = CameraLens("opencv", *SIZE, (-0.2, 0.04, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert true.scale == 400
    return field_error(true, CameraLens.from_dict(calibration["lens"]), *SIZE).rms


def test_ambiguous_labels_and_rejected_segments_count_for_nothing(dataset: Path) -> None:
    ambiguous = dataset / "labels" / "one_edge_segments_ambiguous.npy"
    ambiguous.write_bytes(write_label_npy(straight_lines(99)))
    labelled = LabelledSegments(straight_lines(5, 4), verdicts=("keep", "reject", "ambiguous", None))
    (dataset / "labels" / "two_edge_segments_filtered.npy").unlink()
    (dataset / "labels" / "two.json").write_bytes(write_json(labelled))
    (camera,) = gather_lines([dataset]).cameras
    assert {image.name: len(image.segments) for image in camera.images} == {"one": 10, "two": 1, "three": 10}
    assert all(image.probability is None for image in camera.images)


def test_segments_alone_need_the_size_and_keep_their_straightness(clearlines: Any, tmp_path: Path) -> None:
    folder = tmp_path / "lines"
    folder.mkdir()
    for seed in range(2):
        segments = straight_lines(seed)
        straightness = np.linspace(0.2, 1, len(segments), dtype=np.float32)
        (folder / f"{seed}.npz").write_bytes(write_npz(LabelledSegments(segments, straightness)))
    done = clearlines("calibrate", folder, status=2)
    assert "--size WIDTHxHEIGHT" in done.stderr
    (camera,) = gather_lines([folder], size=SIZE).cameras
    assert (camera.name, camera.source) == ("lines", "candidates")
    assert camera.images[0].probability == pytest.approx(np.linspace(0.2, 1, 10), abs=1e-6)
    (one,) = gather_lines([folder / "0.npz"], size=SIZE).cameras
    assert [image.name for image in one.images] == ["0"]
    done = clearlines("calibrate", folder, "--size", "640 by 480", status=2)
    assert "1242x375" in done.stderr


def test_images_without_labels_are_looked_at(clearlines: Any, street: Path, tmp_path: Path) -> None:
    (street / "a" / "text.png").write_bytes(b"hello")
    done = clearlines(
        "calibrate",
        street,
        "--workers",
        1,
        "--json",
        "all.json",
        "--report",
        "r.html",
        "--family",
        "division",
        status=1,
    )
    assert "failed: a/text" in done.stderr
    assert "no image could be read" in clearlines("calibrate", street / "a" / "text.png", status=2).stderr
    (camera,) = json.loads((tmp_path / "all.json").read_text())["cameras"]
    assert camera["source"] == "candidates"
    assert [image["name"] for image in camera["calibration"]["images"]] == ["a/one", "a/two"]
    assert camera["calibration"]["counts"]["segments"] >= 6
    assert (tmp_path / "r.html").read_text().count("data:image/jpeg") == 2


def test_too_little_is_said_and_nothing_is_exported(clearlines: Any, tmp_path: Path) -> None:
    folder = tmp_path / "lines"
    folder.mkdir()
    (folder / "a.npz").write_bytes(write_npz(LabelledSegments(straight_lines(1, 2))))
    arguments = ("--size", "640x480", "--export", "ros", "--family", "brown", "--json", "-")
    done = clearlines("calibrate", folder, *arguments, status=1)
    exports = json.loads(done.stdout)["cameras"][0]["exports"]
    assert [each["format"] for each in exports if each["allowed"]] == ["clearlines"]
    assert "not accepted: not enough information: 2 usable lines" in done.stderr
    assert "not exported: ros" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["lines"]
    empty = write_dataset(tmp_path / "empty", ["one"], empty=True)
    assert "no line to calibrate from" in clearlines("calibrate", empty, status=2).stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere"], "no such file"),
        (["town", "--family", "fisheye"], "brown, opencv, division"),
        (["town", "--export", "xml"], "opencv-yaml"),
        (["town", "--reference", "nowhere"], "no such file"),
        (["town", "--reference", "town/images.csv"], "no calibration in it"),
        (["town", "--camera", "rear"], "there is no camera 'rear'"),
        (["town", "--labels", "void"], "no label file is for any"),
        (["town", "--focal-length", "0"], "focal length"),
        (["town", "--report", "town"], "a folder is where a file"),
        (["town", "--output", "town/images.csv/x"], "a file is where a folder"),
        (["town", "--export", "ros", "--export", "mrcal", "--output", "all.yaml"], "2 files can't be written into one"),
        (["town", "--export", "ros", "--export", "mrcal", "--output", "town/images.csv"], "2 files can't be written"),
        (["void"], "neither an image nor a file of segments"),
    ],
)
def test_a_mistake_is_told_and_nothing_is_written(
    clearlines: Any, dataset: Path, tmp_path: Path, arguments: list[str], message: str
) -> None:
    (tmp_path / "void").mkdir()
    (dataset / "images.csv").write_text("name\n")
    before = sorted(tmp_path.rglob("*"))
    done = clearlines("calibrate", *arguments, status=2)
    assert message in done.stderr
    assert sorted(tmp_path.rglob("*")) == before


def test_each_camera_of_a_folder_has_files_of_its_own(tmp_path: Path) -> None:
    images = tuple(CalibrationImage(str(seed), straight_lines(seed, 8)) for seed in (1, 2))
    lines = CameraLines("left/cam", SIZE, "labels", images)
    choice = CalibrateChoice("opencv", exports=("clearlines", "ros"))
    stages: list[str] = []
    (left,) = calibrate_cameras(GatheredLines((lines,), {}), choice, watch=lambda name: watching(name, stages))
    results = [left, replace(left, lines=replace(lines, name="left cam"))]
    with pytest.raises(InvalidInput, match="4 files can't be written into one"):
        write_exports(results, tmp_path / "all.yaml")
    assert [path.name for path in write_exports(results, tmp_path / "out")] == [
        "left_cam_clearlines.json",
        "left_cam_camera_info.yaml",
        "left_cam_2_clearlines.json",
        "left_cam_2_camera_info.yaml",
    ]
    assert {"left/cam fitting", "left/cam focal length", "left/cam free model"} <= set(stages)


def watching(name: str, stages: list[str]) -> command.Watch:
    return lambda stage, done, total: stages.append(f"{name} {stage}")


def test_whoever_watches_can_stop_it(dataset: Path) -> None:
    def stop(stage: str, done: int, total: int) -> None:
        if stage == "ladder":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        calibrate_cameras(gather_lines([dataset]), CalibrateChoice("opencv"), watch=lambda name: stop)


def test_a_camera_has_images_of_one_size(dataset: Path) -> None:
    cv2.imwrite(str(dataset / "images" / "two.png"), np.zeros((100, 100), np.uint8))
    (dataset / "images.csv").write_text("name,camera\none,front\ntwo,front\nthree,front\n")
    with pytest.raises(InvalidInput, match="2 sizes: 100 x 100, 640 x 480"):
        gather_lines([dataset])
    with pytest.raises(NotFound, match="front"):
        gather_lines([dataset], camera="rear")


def test_every_option_is_documented(clearlines: Any) -> None:
    words = re.findall(r"--[a-z-]+", clearlines("calibrate", "--help").stdout)
    page = (Path(__file__).parents[2] / "docs" / "commands.md").read_text()
    section = page.split("## calibrate")[1].split("\n## ")[0]
    assert {word for word in words if word not in ("--help", "--workers")} <= set(re.findall(r"--[a-z-]+", section))
    assert all(f"`{name}`" in section for name in FORMATS)


def test_the_reference_of_a_dataset_is_taken_where_it_is_for_the_camera(dataset: Path) -> None:
    known = {"width": 640, "height": 480, "K": [[400, 0, 319.5], [0, 400, 239.5], [0, 0, 1]], "D": [-0.2, 0.04, 0, 0]}
    for fields, taken in (
        ({"640x480": known}, True),
        (known, True),
        ({"x": known}, False),
        ({**known, "width": 9}, False),
    ):
        (dataset / "cameras.json").write_text(json.dumps(fields))
        (camera,) = gather_lines([dataset]).cameras
        assert (camera.reference is not None) == taken


def test_a_dataset_s_own_reference_that_can_not_be_compared_does_no_harm() -> None:
    folding = ReferenceCamera(640, 480, ((400, 0, 319.5), (0, 400, 239.5), (0, 0, 1)), (-9.0, 0, 0, 0))
    assert command.difference_to(folding, TRUE, asked=False) is None
    with pytest.raises(InvalidInput, match="can't be undone"):
        command.difference_to(folding, TRUE, asked=True)
