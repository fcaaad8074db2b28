from __future__ import annotations

import cv2
import numpy as np
import pytest

from app.synthesis import draw_lens
from app.synthesis.camera import Pose, describe_camera
from app.synthesis.lens import LensKind


def undistort_brown(model: dict, pixels: np.ndarray) -> np.ndarray:
    """The undistort direction written out once more, as the consumers of `as_brown` read it."""
    centre, scale, (k1, k2, k3), (p1, p2) = np.array(model["center"]), model["scale"], model["k"], model["p"]
    x, y = ((pixels - centre) / scale).T
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return centre + scale * np.stack([u, v], axis=1)


@pytest.mark.parametrize(("kind", "most"), [("plain", 0.1), ("mild", 0.5), ("wide", 2.5)])
@pytest.mark.parametrize("seed", [0, 5])
def test_both_forms_of_the_lens_undistort_alike(seed: int, kind: LensKind, most: float) -> None:
    camera = describe_camera(draw_lens(np.random.default_rng(seed), 1280, 720, kind))
    reference = camera.as_reference()
    columns, rows = np.meshgrid(np.linspace(0, 1279, 40), np.linspace(0, 719, 24))
    pixels = np.stack([columns.ravel(), rows.ravel()], axis=1)
    matrix, coefficients = np.array(reference["K"]), np.array(reference["D"])
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 300, 1e-13)
    expected = cv2.undistortPoints(pixels[:, None], matrix, coefficients, None, None, matrix, stop).reshape(-1, 2)
    error = np.linalg.norm(undistort_brown(camera.as_brown(), pixels) - expected, axis=1)
    rms, worst = camera.brown_error
    assert np.sqrt(np.mean(error**2)) == pytest.approx(rms, rel=0.2, abs=1e-3)
    assert error.max() <= worst * 1.3 + 1e-3
    assert rms < most


def test_barrel_has_opposite_signs_in_the_two_directions() -> None:
    lens = draw_lens(np.random.default_rng(2), 1280, 720, "wide")
    assert lens.coefficients[0] < 0 < describe_camera(lens).brown_k[0]


def test_a_pose_turns_as_it_says() -> None:
    ahead = np.array([0.0, 0.0, 10.0])
    assert Pose(np.zeros(3), yaw=0.1).to_camera(ahead)[0] < 0  # looking right, what is ahead lies to the left
    assert Pose(np.zeros(3), pitch=0.1).to_camera(ahead)[1] > 0  # looking up, it lies below
    assert Pose(np.zeros(3), roll=0.1).to_camera(np.array([0.0, -1, 10]))[0] < 0  # tilted right, the top leans left
    rotation = Pose(np.zeros(3), 0.3, -0.2, 0.1).rotation
    assert np.allclose(rotation @ rotation.T, np.eye(3))
    assert np.linalg.det(rotation) == pytest.approx(1)


def test_a_pose_is_where_it_stands() -> None:
    pose = Pose(np.array([1.0, -1.6, 5.0]), 0.2)
    assert np.allclose(pose.to_camera(pose.position), 0)
