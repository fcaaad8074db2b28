"""From the ideal picture to the photo: through the lens, then blur, vignetting, noise and rounding."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.camera import Pose
from app.synthesis.lens import Lens
from app.synthesis.projection import View

_FINER = 2  # samples per pixel and axis before averaging
_STEP = 8  # the lens is inverted at each 8th sample and is a straight line to 0.002 px in between
_MOST_PIXELS = 4e6


@dataclass(frozen=True)
class Sensor:
    """What the camera adds.

    Attributes:
        blur: Standard deviation of the point spread, px.
        vignetting: Share of the light that is lost in the corners.
        noise: Standard deviation of the noise in a dark pixel, grey levels.
        photon_noise: Growth of the noise's variance per grey level.
    """

    blur: float = 0.5
    vignetting: float = 0.22
    noise: float = 1.4
    photon_noise: float = 0.012


IDEAL_SENSOR = Sensor(vignetting=0.0, noise=0.0, photon_noise=0.0)


@dataclass(frozen=True, eq=False)
class LensMap:
    """A lens with the ideal picture it looks into, worked out once for all images of a camera.

    Attributes:
        lens: The lens.
        matrix: Pinhole matrix of the ideal picture, float64 ``(3, 3)``.
        width: Width of the ideal picture in px.
        height: Height of the ideal picture in px.
        lookup_x: float32 ``(2 H, 2 W)``: where in the ideal picture each sample of the photo looks.
        lookup_y: Likewise.
    """

    lens: Lens
    matrix: NDArray[np.float64]
    width: int
    height: int
    lookup_x: NDArray[np.float32]
    lookup_y: NDArray[np.float32]

    def view(self, pose: Pose) -> View:
        """The ideal picture as seen from a pose."""
        return View(pose, self.matrix, self.width, self.height)


def map_lens(lens: Lens) -> LensMap:
    """Lay an ideal picture behind a lens: wide enough for the corners, and finer than the photo."""
    count_x = (lens.width * _FINER) // _STEP + 3
    count_y = (lens.height * _FINER) // _STEP + 3
    # the middle of each step of samples, one step beyond the frame on each side, in px of the photo
    coarse_x = ((np.arange(count_x) - 1) * _STEP + _STEP / 2) / _FINER - 0.5
    coarse_y = ((np.arange(count_y) - 1) * _STEP + _STEP / 2) / _FINER - 0.5
    pixels = np.stack(np.meshgrid(coarse_x, coarse_y), axis=-1)
    rim = np.array([0.02 * lens.width, 0.02 * lens.height])
    rays = lens.to_rays(pixels.clip(-rim, np.array([lens.width, lens.height]) + rim))
    low, high = rays.reshape(-1, 2).min(axis=0), rays.reshape(-1, 2).max(axis=0)

    focal = float(lens.matrix[[0, 1], [0, 1]].max()) * 1.3
    focal *= min(1.0, float(np.sqrt(_MOST_PIXELS / np.prod((high - low) * focal))))
    size = np.ceil((high - low) * focal).astype(int) + 8
    matrix = np.array([[focal, 0, 4 - low[0] * focal], [0, focal, 4 - low[1] * focal], [0, 0, 1]])
    at = (rays * focal + matrix[:2, 2]).astype(np.float32)
    inner = np.s_[_STEP : _STEP + lens.height * _FINER, _STEP : _STEP + lens.width * _FINER]
    lookups = [
        np.asarray(cv2.resize(at[..., i], None, fx=_STEP, fy=_STEP, interpolation=cv2.INTER_LINEAR), np.float32)[inner]
        for i in range(2)
    ]
    return LensMap(lens, matrix, int(size[0]), int(size[1]), lookups[0].copy(), lookups[1].copy())


def expose(picture: NDArray[np.float32], lens_map: LensMap, sensor: Sensor) -> NDArray[np.float32]:
    """Look at an ideal picture ``(H, W, 3)`` through the lens; returns the photo before noise, float32 in 0..255."""
    lens = lens_map.lens
    samples = cv2.remap(
        picture, lens_map.lookup_x, lens_map.lookup_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    photo = cv2.resize(samples, (lens.width, lens.height), interpolation=cv2.INTER_AREA)
    if sensor.blur > 0:
        photo = cv2.GaussianBlur(photo, (0, 0), sensor.blur)
    if sensor.vignetting > 0:
        x = np.linspace(-1, 1, lens.width, dtype=np.float32)
        y = np.linspace(-1, 1, lens.height, dtype=np.float32)
        r2 = (x[None] ** 2 + y[:, None] ** 2) / 2
        photo *= (1 - sensor.vignetting * r2 * r2)[..., None]
    return photo.clip(0, 255)


def read_out(photo: NDArray[np.float32], sensor: Sensor, rng: np.random.Generator) -> NDArray[np.uint8]:
    """Add the noise of electrons and photons and round to 8 bits; returns blue, green, red as OpenCV orders them."""
    if sensor.noise > 0 or sensor.photon_noise > 0:
        spread = np.sqrt(sensor.noise**2 + sensor.photon_noise * photo)
        photo = photo + spread * rng.standard_normal(photo.shape, dtype=np.float32)
    return np.ascontiguousarray(np.rint(photo).clip(0, 255).astype(np.uint8)[..., ::-1])
