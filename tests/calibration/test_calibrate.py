"""Lenses from reviewed lines."""

from __future__ import annotations

import json

import numpy as np
import pytest

from app.calibration.advice import advice, image_gain
from app.calibration.calibrate import CalibrationImage, calibrate
from app.calibration.calibration import Calibration
from app.calibration.lens import CameraLens, Family
from app.errors import Cancelled, InvalidInput
from app.vision.field import field_error
from app.vision.segments import Segments

SIZE = 800, 600
DIVISION = CameraLens("division", *SIZE, (0.2, 0.0, 0.0, 0.01, -0.02))


@pytest.mark.parametrize(
    ("lens", "family"),
    [
        (CameraLens("opencv", *SIZE, (-0.12, 0.03, 0.0, 0.0, 0.0, 0.03, 0.01)), None),
        (DIVISION, "division"),
        (CameraLens("brown", *SIZE, (-0.08, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)), "opencv"),
    ],
)
def test_error_lies_below_what_is_stated(lines_through, lens: CameraLens, family: Family | None):
    found = calibrate(lines_through(lens, 60, bent=2), SIZE, family=family)
    error = field_error(lens, found.lens, *SIZE).rms
    assert error < found.uncertainty.bound95 < 1.0 < found.uncertainty.correction
    assert found.accepted
    assert found.counts["used"] == 60
    bent = [line for image, line in zip(found.lines, range(3), strict=True) for line in image.probability[:1]][:2]
    assert max(bent) < 0.1
    assert found.counts["inliers"] == 58
    assert found.noise == pytest.approx(0.1, rel=0.1)


def test_releases_no_more_than_the_lines_tell(lines_through):
    plain = CameraLens("brown", *SIZE, (0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert calibrate(lines_through(plain, 30, noise=0.2), SIZE, family="brown").released == ("k1",)
    bulged = CameraLens("brown", *SIZE, (0.02, 0.15, 0.0, 0.0, 0.0, 0.0, 0.0))
    found = calibrate(lines_through(bulged, 60), SIZE, family="brown")
    assert {rung.family for rung in found.ladder} == {"brown"}
    assert {"k1", "k2"} <= set(found.released)
    assert "p1" not in found.released
    accepted = [rung for rung in found.ladder if rung.accepted]
    assert [rung.penalised for rung in accepted] == sorted((rung.penalised for rung in accepted), reverse=True)


def test_candidates_with_probabilities(lines_through):
    kept = lines_through(DIVISION, 40, images=1)[0]
    curved = lines_through(DIVISION, 40, images=1, bent=40, seed=1)[0]
    both = Segments.from_list([*kept.segments, *curved.segments])
    probability = np.repeat([0.8, 0.3], 40)
    found = calibrate([CalibrationImage("only", both, probability)], SIZE, family="division")
    assert field_error(DIVISION, found.lens, *SIZE).rms < found.uncertainty.bound95
    assert found.counts["inliers"] == pytest.approx(40, abs=2)


def test_same_lines_give_the_same_result(lines_through):
    images = lines_through(DIVISION, 20)
    assert calibrate(images, SIZE, family="division").as_dict() == calibrate(images, SIZE, family="division").as_dict()


def test_json_form_comes_back(lines_through):
    found = calibrate(lines_through(DIVISION, 20), SIZE, family="division").as_dict()
    text = json.dumps(found, allow_nan=False)
    assert Calibration.from_dict(json.loads(text)).as_dict() == found
    assert len(found["correlation"]) == len(found["released"]) == len(found["sigma"])
    assert np.shape(found["map"]["sigma"]) == (found["map"]["rows"], found["map"]["columns"])
    with pytest.raises(InvalidInput, match="not a calibration"):
        Calibration.from_dict({**found, "version": 99})
    with pytest.raises(InvalidInput):
        Calibration.from_dict({"version": 1})


@pytest.mark.parametrize("number", [0, 2])
def test_too_few_lines_are_refused_not_an_error(lines_through, number: int):
    images = lines_through(DIVISION, number, images=2)
    found = calibrate(images, SIZE, family="opencv")
    assert not found.accepted
    assert "at least 3" in found.reasons[0]
    json.dumps(found.as_dict(), allow_nan=False)
    assert len(found.images) == 2


def test_no_distortion_is_a_result_too(lines_through):
    plain = CameraLens.identity("brown", *SIZE)
    found = calibrate(lines_through(plain, 60), SIZE, family="brown")
    assert found.accepted
    assert field_error(plain, found.lens, *SIZE).rms < found.uncertainty.bound95 < 0.5


def test_refuses_what_cannot_be(lines_through):
    images = lines_through(DIVISION, 3)
    with pytest.raises(InvalidInput, match="image size"):
        calibrate(images, (0, 600))
    with pytest.raises(InvalidInput, match="no image"):
        calibrate([], SIZE)
    with pytest.raises(InvalidInput, match="unknown model"):
        calibrate(images, SIZE, family="fisheye")  # type: ignore[arg-type]
    with pytest.raises(InvalidInput, match="2 probabilities for 1"):
        CalibrationImage("a", images[0].segments, np.ones(2))


def test_can_be_watched_and_called_off(lines_through):
    stages: list[str] = []

    def watch(stage: str, done: int, total: int) -> None:
        assert 0 <= done <= total
        stages.append(stage)
        if stage == "leaving images out":
            raise Cancelled("enough")

    with pytest.raises(Cancelled):
        calibrate(lines_through(DIVISION, 20), SIZE, family="division", watch=watch)
    assert list(dict.fromkeys(stages)) == ["fitting", "ladder", "leaving images out"]


def test_an_image_that_disagrees_is_told(lines_through):
    images = [
        *lines_through(DIVISION, 60, images=4),
        *lines_through(CameraLens("division", *SIZE, (0.17, 0.0, 0.0, 0.01, -0.02)), 15, images=1, seed=9),
    ]
    found = calibrate(images, SIZE, family="division")
    moved = [image.left_out_shift or 0.0 for image in found.images]
    assert int(np.argmax(moved)) == 4


def test_advice_points_to_where_lines_are_missing(lines_through):
    images = lines_through(DIVISION, 25, left=0.1, right=0.5)
    found = calibrate(images, SIZE, family="division")
    cells = advice(found, images)
    assert 1 <= len(cells) <= 5
    assert cells[0]["sigma_now"] > np.quantile(found.map.sigma, 0.9)
    for cell in cells:
        assert 0 < cell["sigma_with"] < cell["sigma_now"]
        assert cell["halves"] == (cell["sigma_with"] <= 0.5 * cell["sigma_now"])
    missing = lines_through(DIVISION, 20, images=1, left=0.5, seed=5)[0].segments
    gain = image_gain(found, missing)
    assert gain > image_gain(found, missing, np.full(20, 0.2)) > 0
    assert gain < found.uncertainty.pred
    assert image_gain(found, Segments.empty()) == 0
