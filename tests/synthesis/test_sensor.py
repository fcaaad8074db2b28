from __future__ import annotations

import numpy as np
import pytest

from app.errors import InvalidInput
from app.synthesis import IDEAL_SENSOR, Sensor, make_lens
from app.synthesis.sensor import draw_sensor, expose, map_lens, read_out

LENS_MAP = map_lens(make_lens(80, 64, 80.0, np.zeros(5)))


def picture_of_an_edge() -> np.ndarray:
    """Dark on the left, bright on the right; the edge is x = 0 of the rays."""
    columns = np.arange(LENS_MAP.width)
    cover = np.clip(columns - LENS_MAP.matrix[0, 2] + 0.5, 0, 1).astype(np.float32)
    return np.broadcast_to((60 + 120 * cover)[None, :, None], (LENS_MAP.height, LENS_MAP.width, 3)).copy()


def edge_place(image: np.ndarray) -> float:
    slope = np.diff(image[32, 20:60, 0].astype(np.float64))
    return float((slope * (np.arange(20, 59) + 0.5)).sum() / slope.sum())


@pytest.mark.parametrize(
    "sensor",
    [
        IDEAL_SENSOR,
        Sensor(motion=(3.3, 1.0), vignetting=0, noise=0, photon_noise=0),
        Sensor(sharpening=1.2, vignetting=0, noise=0, photon_noise=0),
        Sensor(jpeg_quality=85, vignetting=0, noise=0, photon_noise=0),
    ],
)
def test_nothing_that_a_camera_adds_moves_an_edge(sensor: Sensor) -> None:
    image = read_out(expose(picture_of_an_edge(), LENS_MAP, sensor), sensor, np.random.default_rng(0))
    assert edge_place(image) == pytest.approx(39.5, abs=0.05)


def test_motion_spreads_along_its_way() -> None:
    def width(motion: tuple[float, float]) -> int:
        sensor = Sensor(motion=motion, vignetting=0)
        row = expose(picture_of_an_edge(), LENS_MAP, sensor)[32, :, 0]
        return int(((row > 62) & (row < 178)).sum())

    assert width((0.0, 6.0)) == width((0.0, 0.0)) < width((6.0, 0.0)) - 3


def test_sharpening_overshoots_and_jpeg_leaves_traces() -> None:
    def seen(sensor: Sensor) -> np.ndarray:
        return read_out(expose(picture_of_an_edge(), LENS_MAP, sensor), sensor, np.random.default_rng(0)).astype(int)

    plain = seen(IDEAL_SENSOR)
    sharp = seen(Sensor(sharpening=1.0, vignetting=0, noise=0, photon_noise=0))
    assert sharp.max() > plain.max() + 5
    assert sharp.min() < plain.min() - 5
    squeezed = seen(Sensor(jpeg_quality=60, vignetting=0, noise=0, photon_noise=0))
    assert 0 < np.abs(squeezed - plain).max() < 40


def test_drawn_cameras_differ() -> None:
    drawn = [draw_sensor(np.random.default_rng(seed)) for seed in range(30)]
    assert {sensor.jpeg_quality > 0 for sensor in drawn} == {sensor.sharpening > 0 for sensor in drawn} == {True, False}


@pytest.mark.parametrize("fields", [{"jpeg_quality": 101}, {"noise": -1.0}, {"sharpening": -0.1}])
def test_a_sensor_that_can_not_be_is_refused(fields: dict) -> None:
    with pytest.raises(InvalidInput):
        Sensor(**fields)
