"""The distortion estimate of a camera."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from app.errors import InvalidInput
from app.vision.brown import Brown
from app.vision.distortion import DistortionEstimate, estimate_distortion
from app.vision.field import field_error
from app.vision.segments import Segments

SIZE = 640, 480
LENS = Brown(*SIZE, (323.0, 236.0), 400.0, (0.18, 0.03, 0.0))


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_known_lens_is_recovered_from_two_thirds_bent_segments(segments_through, seed: int):
    images = [segments_through(LENS, 80, bent=2 / 3, seed=100 * seed + image) for image in range(3)]
    estimate = estimate_distortion(images, SIZE)
    assert estimate.accepted, estimate.reasons
    error = field_error(LENS, estimate.brown, *SIZE).rms
    assert error < 1.0
    assert error < 2.5 * estimate.uncertainty.pred
    assert estimate.counts["given"] == 240
    assert 40 <= estimate.counts["trusted"] <= 90


def test_trusted_segments_are_those_that_are_straight(segments_through):
    images = [segments_through(LENS, 80, bent=0.5, seed=1), Segments.empty(), segments_through(LENS, 40, seed=2)]
    estimate = estimate_distortion(images, SIZE)
    assert [len(image.segment) for image in estimate.trusted] == [80, 0, 40]
    first = estimate.trusted[0]
    bent = first.segment < 40
    assert first.probability[bent].max() < 0.2
    assert np.median(first.probability[~bent]) > 0.6
    assert np.median(first.residual[~bent]) < 0.1 < np.median(first.residual[bent])


def test_no_distortion_needs_no_correction_and_is_not_accepted_as_one(segments_through):
    estimate = estimate_distortion([segments_through(Brown.identity(*SIZE), 100)], SIZE)
    assert field_error(Brown.identity(*SIZE), estimate.brown, *SIZE).rms < 1.0


def test_the_same_input_gives_the_same_estimate_and_the_seed_moves_msac_alone(segments_through):
    images = [segments_through(LENS, 60, bent=0.5, noise=0.3)]
    first, again, other = (estimate_distortion(images, SIZE, seed=seed).as_dict() for seed in (0, 0, 1))
    assert first == again
    assert {**first, "msac": None} == {**other, "msac": None}


def test_as_dict_goes_through_json_and_back(segments_through):
    estimate = estimate_distortion([segments_through(LENS, 60)], SIZE)
    fields = json.loads(json.dumps(estimate.as_dict(), allow_nan=False))
    assert fields["model"] == "brown"
    back = DistortionEstimate.from_dict(fields)
    assert back.as_dict() == estimate.as_dict()
    points = np.array([[3.0, 4.0], [600.0, 20.0]])
    assert (back.undistort(points) == estimate.undistort(points)).all()


def _line(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    return np.linspace([x0, y0], [x1, y1], 200)


CENTER = 319.5, 239.5
DEGENERATE = {
    "no images": [],
    "no segments": [Segments.empty()],
    "one segment": [Segments.from_list([_line(10, 10, 600, 30)])],
    "through the centre": [
        Segments.from_list(
            [
                _line(CENTER[0] - dx, CENTER[1] - dy, CENTER[0] + dx, CENTER[1] + dy)
                for dx, dy in [(200, 0), (0, 200), (150, 150), (-150, 150), (100, 30), (-30, 120)]
            ]
        )
    ],
    "one segment many times": [Segments.from_list([_line(10, 200, 600, 210)] * 20)],
    "single points": [Segments.from_list([[[5, 5]], [[9, 9]]])],
    "all along the border": [Segments.from_list([_line(2, 2, 630, 2)] * 9)],
}


@pytest.mark.parametrize("case", DEGENERATE)
def test_what_tells_nothing_is_refused_with_a_reason(case: str):
    estimate = estimate_distortion(DEGENERATE[case], SIZE)
    assert not estimate.accepted
    assert all("not enough information" in reason for reason in estimate.reasons)
    assert len(estimate.trusted) == len(DEGENERATE[case])
    fields = json.loads(json.dumps(estimate.as_dict(), allow_nan=False))
    assert fields["accepted"] is False
    assert DistortionEstimate.from_dict(fields).as_dict() == fields


@pytest.mark.parametrize("size", [(1, 1), (2, 2), (1, 500), (7, 3)])
def test_tiny_images_are_refused(size: tuple[int, int]):
    estimate = estimate_distortion([Segments.from_list([_line(0, 0, 200, 90)] * 5)], size)
    assert not estimate.accepted
    json.dumps(estimate.as_dict(), allow_nan=False)


def test_only_curves_are_no_lens(segments_through):
    estimate = estimate_distortion([segments_through(Brown.identity(*SIZE), 60, bent=1.0)], SIZE)
    assert not estimate.accepted


@pytest.mark.parametrize("size", [(0, 10), (10, -1)])
def test_an_impossible_size_is_refused(size: tuple[int, int]):
    with pytest.raises(InvalidInput, match="size"):
        estimate_distortion([], size)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("model", "fisheye"),
        ("width", 0),
        ("width", 640.5),
        ("height", True),
        ("scale", 0),
        ("center", [1]),
        ("k", [0.1, 0.2, math.nan]),
        ("k", "0.1"),
        ("p", None),
        ("accepted", "yes"),
        ("division", []),
        ("uncertainty", {}),
        ("refit_error", {"rms": "small", "maximum": 1}),
    ],
)
def test_fields_that_make_no_estimate_are_refused_by_name(name: str, value: object):
    fields = estimate_distortion([], SIZE).as_dict()
    with pytest.raises(InvalidInput) as refusal:
        DistortionEstimate.from_dict({**fields, name: value})
    assert refusal.value.where is not None
    assert refusal.value.where.startswith("distortion.")


def test_what_is_no_mapping_is_refused():
    with pytest.raises(InvalidInput):
        DistortionEstimate.from_dict([1, 2])  # type: ignore[arg-type]
