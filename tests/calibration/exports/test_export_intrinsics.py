"""Which focal length and principal point a file states."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from app.calibration.exports import Intrinsics, choose_intrinsics, export_lens, nominal_intrinsics
from app.calibration.lens import CameraLens
from app.errors import InvalidInput

LENS = CameraLens("brown", 300, 400, (0.02, 0.0, 0.0, 0.0, 0.0, 0.01, -0.02))


@dataclass(frozen=True)
class Estimate:
    focal_length: float | None


def test_what_a_person_gave_comes_before_what_was_estimated_and_that_before_the_nominal_one() -> None:
    given = choose_intrinsics(LENS, focal_length=300, estimate=Estimate(400))
    assert (given.focal_length, given.source) == (300, "given")
    estimated = choose_intrinsics(LENS, estimate=Estimate(400))
    assert (estimated.focal_length, estimated.source) == (400, "estimated")
    nominal = choose_intrinsics(LENS, estimate=Estimate(None))
    assert (nominal.focal_length, nominal.source) == (250, "nominal")


def test_the_principal_point_is_the_distortion_centre_unless_given() -> None:
    assert choose_intrinsics(LENS).principal_point == LENS.center
    assert choose_intrinsics(LENS, principal_point=(140, 190)).principal_point == (140, 190)


def test_the_nominal_focal_length_is_half_the_diagonal() -> None:
    assert nominal_intrinsics(300, 400) == Intrinsics(250, (149.5, 199.5), "nominal")


@pytest.mark.parametrize("focal_length", [0.0, -1.0, float("nan"), float("inf")])
def test_a_focal_length_is_positive(focal_length: float) -> None:
    with pytest.raises(InvalidInput, match="focal length"):
        choose_intrinsics(LENS, focal_length=focal_length)


@pytest.mark.parametrize(("focal_length", "point"), [(1e-3, (1, 1)), (1e9, (1, 1)), (100, (1e7, 0))])
def test_numbers_of_no_camera_are_refused(focal_length: float, point: tuple[float, float]) -> None:
    with pytest.raises(InvalidInput, match=r"focal length|principal point"):
        export_lens(LENS, "ros", camera_name="a", intrinsics=Intrinsics(focal_length, point, "given"))


def test_a_principal_point_is_a_point() -> None:
    with pytest.raises(InvalidInput, match="principal point"):
        Intrinsics(100, (float("nan"), 0), "given")
