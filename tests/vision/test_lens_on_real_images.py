"""The lens estimate on real images with known lenses."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.vision import Brown, Detection, DetectionParameters, detect_for_prelabel, estimate_distortion
from app.vision.conversion import OpenCVLens
from app.vision.distortion import DistortionEstimate
from app.vision.division import Division
from app.vision.field import field_error
from app.vision.lens_uncertainty import MOST_PREDICTED

DATA = Path(__file__).parents[2].parent / "shared" / "data"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not DATA.is_dir(), reason="the real images lie beside the repository, in ../shared/data"),
]


def detections(folder: Path, *, every: int = 1) -> dict[str, Detection]:
    paths = sorted(folder.glob("*"))[::every]
    assert paths
    images = {path.stem: cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) for path in paths}
    return {name: detect_for_prelabel(np.asarray(image), DetectionParameters()) for name, image in images.items()}


def joint(found: dict[str, Detection]) -> DistortionEstimate:
    first = next(iter(found.values()))
    return estimate_distortion([each.lens_segments for each in found.values()], (first.width, first.height))


def test_kitti_frames_jointly():
    reference = json.loads((DATA / "kitti" / "camera.json").read_text())
    size = reference["width"], reference["height"]
    estimate = joint(detections(DATA / "kitti" / "images", every=2))
    lens = OpenCVLens(reference["K"], reference["D"])
    assert estimate.accepted, estimate.reasons
    assert field_error(lens, Brown.identity(*size), *size).rms == pytest.approx(25.4, abs=0.5)
    assert field_error(lens, estimate.brown, *size).rms < 2.0
    assert field_error(lens, estimate.brown, *size).rms < 2 * estimate.uncertainty.pred


def test_york_photos_one_by_one():
    references = json.loads((DATA / "york" / "cameras.json").read_text())
    found = detections(DATA / "york" / "images", every=6)
    estimates = {name: estimate_distortion([each.lens_segments], (640, 480)) for name, each in found.items()}
    errors = {
        name: field_error(OpenCVLens(references[name]["K"], references[name]["D"]), estimate.brown, 640, 480).rms
        for name, estimate in estimates.items()
        if estimate.accepted
    }
    assert len(errors) >= 0.95 * len(found)
    assert np.median(list(errors.values())) < 2.0
    for name, error in errors.items():
        lens = OpenCVLens(references[name]["K"], references[name]["D"])
        assert error < field_error(lens, Brown.identity(640, 480), 640, 480).rms, name


def test_bends_of_the_road_are_not_taken_for_a_lens():
    found = detections(DATA / "carnd" / "road")
    groups = [{name} for name in found] + [set(pair) for pair in list(combinations(found, 2))[::2]] + [set(found)]
    groups += [set(three) for three in list(combinations(found, 3))[::9]]
    for names in groups:
        estimate = joint({name: found[name] for name in sorted(names)})
        assert not estimate.accepted, names
        assert "not enough information" in estimate.reasons[0]
        # far from the limit, or a small change of the detection would tip it
        assert estimate.uncertainty.pred > 1.5 * MOST_PREDICTED * estimate.uncertainty.correction, names


def test_a_mirrored_image_gives_the_mirrored_answer():
    path = sorted((DATA / "york" / "images").glob("*"))[0]
    gray = np.asarray(cv2.imread(str(path), cv2.IMREAD_GRAYSCALE))
    plain, mirrored = (
        joint({"": detect_for_prelabel(np.ascontiguousarray(image), DetectionParameters())})
        for image in (gray, gray[:, ::-1])
    )
    assert plain.accepted
    assert mirrored.accepted
    (cx, cy), k = plain.division.offset, plain.division.k
    turned = Division(plain.width, plain.height, k, (-cx, cy))
    assert field_error(turned, mirrored.division, plain.width, plain.height).rms < plain.uncertainty.pred
