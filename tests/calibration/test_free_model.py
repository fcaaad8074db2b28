"""What a lens's model misses, on lenses of which that is known."""

from __future__ import annotations

import json

import numpy as np
import pytest

from app.calibration.bspline import grid_for
from app.calibration.calibration_image import CalibrationImage
from app.calibration.free_model import FreeModel, fit_free_model
from app.calibration.lens import CameraLens
from app.calibration.line_bends import line_bends
from app.errors import InvalidInput
from app.vision.field import homography_fields
from app.vision.frame import center_of
from app.vision.segments import Segments

WIDTH, HEIGHT = 1280, 720
LENS = CameraLens("division", WIDTH, HEIGHT, (0.12, 0.02, 0.0, 0.01, -0.01))


def ripple(size):
    """A smooth field that no radial lens has."""

    def field(points):
        x, y = ((points - center_of(WIDTH, HEIGHT)) / 640).T
        return size * np.stack([np.sin(3 * y + x) + x**3, np.cos(3 * x) * y], -1)

    return field


def images(number, each, seed, field=None, noise=0.1, inside=((0, 0), (WIDTH, HEIGHT))):
    """Straight lines of 80 to 400 px as the lens with the field shows them."""
    rng = np.random.default_rng(seed)
    found = []
    for index in range(number):
        lines = []
        while len(lines) < each:
            angle, half = rng.uniform(0, np.pi), rng.uniform(40, 200)
            along = np.array([np.cos(angle), np.sin(angle)])
            straight = LENS.undistort(rng.uniform(*inside)[None]) + np.arange(-half, half)[:, None] * along
            seen = LENS.distort(straight)
            for _ in range(6 if field else 0):
                seen = LENS.distort(straight - (field(seen) if field else 0.0))
            kept = np.isfinite(seen).all(1) & ((seen >= inside[0]) & (seen < inside[1])).all(1)
            if kept.sum() >= 60:
                lines.append(seen[kept] + rng.normal(0, noise, kept.sum())[:, None] * [-along[1], along[0]])
        found.append(CalibrationImage(str(index), Segments.from_list(lines)))
    return found


def without_homography(field, model):
    """The field at the model's grid, ``(2 N,)``, as far as lines can tell it."""
    places = np.stack(np.meshgrid(model.x, model.y), -1).reshape(-1, 2)
    corrected = (LENS.undistort(places) - center_of(WIDTH, HEIGHT)) / LENS.scale
    basis, _ = np.linalg.qr(homography_fields(corrected))
    truth = field(places).T.ravel()
    return truth - basis @ (basis.T @ truth)


def rms(field):
    return float(np.sqrt(2 * np.mean(field**2)))


def test_a_field_that_is_there_is_found_within_its_error():
    model = fit_free_model(images(10, 40, 1, ripple(1.0)), LENS)
    truth = without_homography(ripple(1.0), model)
    away = np.concatenate([np.ravel(model.dx), np.ravel(model.dy)]) - truth
    assert model.used
    assert model.reason is None
    assert rms(truth) > 0.35
    assert rms(away) < 0.4 * rms(truth)
    assert model.sigma is not None
    assert rms(away) < 1.5 * model.sigma
    length = np.hypot(*np.split(away, 2)).reshape(np.shape(model.sigmas))
    assert np.mean(length < 2 * np.array(model.sigmas)) > 0.9


@pytest.mark.parametrize("seed", range(3))
def test_a_lens_of_the_model_leaves_nothing_to_find(seed):
    model = fit_free_model(images(6, 30, seed), LENS)
    assert not model.used
    assert "no field" in str(model.reason)
    assert model.rms < 0.06


def test_few_lines_are_not_enough_and_it_says_how_many_are():
    few = fit_free_model(images(1, 24, 4, ripple(0.3)), LENS)
    assert not few.used
    assert few.lines == 24
    assert 24 < few.needed < 1000
    assert str(few.needed) in str(few.reason)


def test_half_as_many_lines_need_as_many_in_all():
    many, half = (fit_free_model(images(number, 40, 5), LENS) for number in (10, 5))
    assert half.needed == pytest.approx(many.needed, rel=0.4)


def test_where_no_lines_are_the_error_is_larger():
    left = fit_free_model(images(5, 40, 6, ripple(1.0), inside=((0, 0), (WIDTH / 2, HEIGHT))), LENS)
    whole = fit_free_model(images(5, 40, 6, ripple(1.0)), LENS)
    sigmas = np.array(left.sigmas)
    assert np.mean(sigmas[:, 14:]) > 1.2 * np.mean(sigmas[:, :10])
    assert left.needed > 1.5 * whole.needed
    truth = without_homography(ripple(1.0), left)
    length = np.hypot(*np.split(np.concatenate([np.ravel(left.dx), np.ravel(left.dy)]) - truth, 2))
    assert np.mean(length < 2 * sigmas.ravel()) > 0.9


def test_without_lines_there_is_no_field():
    for given in ([], [CalibrationImage("empty", Segments.empty())]):
        model = fit_free_model(given, LENS)
        assert not model.used
        assert model.lines == 0
        assert model.dx == ()
        assert model.sigma is None


def test_improbable_lines_are_left_out():
    given = images(2, 20, 7)
    odds = np.r_[np.full(15, 0.9), np.full(5, 0.2)]
    assert fit_free_model([CalibrationImage(each.name, each.segments, odds) for each in given], LENS).lines == 30


def test_bends_follow_a_field_as_their_slopes_say():
    grid = grid_for(WIDTH, HEIGHT)
    coefficients = np.random.default_rng(8).normal(0, 1, 2 * grid.size)

    def field(points):
        return grid.basis(points) @ coefficients.reshape(2, -1).T

    bends = line_bends(images(1, 30, 9, field, noise=0), LENS, grid)
    assert np.abs(bends.bend).max() > 0.05
    assert np.abs(bends.bend + bends.slopes @ coefficients).max() < 2e-3


def test_no_homography_bends_a_line():
    grid = grid_for(WIDTH, HEIGHT)
    bends = line_bends(images(1, 30, 10), LENS, grid)
    places = np.stack(np.meshgrid(np.linspace(0, WIDTH - 1, 60), np.linspace(0, HEIGHT - 1, 40)), -1).reshape(-1, 2)
    corrected = (LENS.undistort(places) - center_of(WIDTH, HEIGHT)) / LENS.scale
    basis = np.kron(np.eye(2), grid.basis(places))
    coefficients, *_ = np.linalg.lstsq(basis, homography_fields(corrected), rcond=None)
    # what is left is how well a spline follows the lens
    assert np.abs(bends.slopes @ coefficients).max() < 0.01 * np.abs(coefficients).max()


def test_fields_are_read_back():
    for given in (images(2, 20, 11), []):
        model = fit_free_model(given, LENS)
        assert FreeModel.from_dict(json.loads(json.dumps(model.as_dict()))) == model
    with pytest.raises(InvalidInput, match="free model"):
        FreeModel.from_dict({"used": True})


def test_lines_that_bend_by_themselves_tell_no_field():
    """As kerbs and wires do: mostly the same way, each by an amount of its own, far more than its noise."""
    rng = np.random.default_rng(4)
    bent = []
    for image in images(10, 40, 6):
        lines = []
        for points in image.segments:
            along = np.linspace(-1, 1, len(points))[:, None]
            chord = points[-1] - points[0]
            across = np.array([-chord[1], chord[0]]) / np.hypot(*chord) * np.sign(chord[0])
            lines.append(points + rng.exponential(1.0) * (along**2 - 1 / 3) * across)
        bent.append(CalibrationImage(image.name, Segments.from_list(lines)))
    model = fit_free_model(bent, LENS)
    assert not model.used
    assert "straight themselves" in str(model.reason)
