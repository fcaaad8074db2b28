"""From the ideal picture to the photo: through the lens, then blur, vignetting, noise, sharpening and JPEG."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.synthesis.camera import Pose
from app.synthesis.lens import Lens
from app.synthesis.projection import View

_FINER = 2  # samples per pixel and axis before averaging
_STEP = 8  # the lens is inverted at each 8th sample and is a straight line to 0.002 px in between
_MOST_PIXELS = 4e6
_LEAST_MOTION = 0.2  # px; less isn't seen


@dataclass(frozen=True)
class Sensor:
    """What the camera adds, from the light to the file.

    Attributes:
        blur: Standard deviation of the point spread, px.
        motion: Way that the image moves while the shutter is open, px to the right and down; its middle is labelled.
        vignetting: Share of the light that is lost in the corners.
        noise: Standard deviation of the noise in a dark pixel, grey levels.
        photon_noise: Growth of the noise's variance per grey level.
        sharpening: Strength of the camera's unsharp mask, as cameras for people have it.
        jpeg_quality: 1 to 100 for an image that was a JPEG file; 0 for none.
    """

    blur: float = 0.5
    motion: tuple[float, float] = (0.0, 0.0)
    vignetting: float = 0.22
    noise: float = 1.4
    photon_noise: float = 0.012
    sharpening: float = 0.0
    jpeg_quality: int = 0

    def __post_init__(self) -> None:
        if not 0 <= self.jpeg_quality <= 100 or min(self.blur, self.noise, self.photon_noise, self.sharpening) < 0:
            raise InvalidInput("no such sensor", where="sensor", expected="nothing below 0, a JPEG quality up to 100")


IDEAL_SENSOR = Sensor(vignetting=0.0, noise=0.0, photon_noise=0.0)


def draw_sensor(rng: np.random.Generator) -> Sensor:
    """Draw a camera: from raw frames of a machine's to the sharpened JPEG files of a pocket camera."""
    return Sensor(
        blur=float(rng.uniform(0.3, 0.7)),
        vignetting=float(rng.uniform(0.05, 0.35)),
        noise=float(np.exp(rng.uniform(np.log(0.8), np.log(3.5)))),
        photon_noise=float(rng.uniform(0.006, 0.04)),
        sharpening=float(rng.uniform(0.3, 1.3)) if rng.random() < 0.7 else 0.0,
        jpeg_quality=int(rng.integers(70, 97)) if rng.random() < 0.8 else 0,
    )


def draw_motion(rng: np.random.Generator) -> tuple[float, float]:
    """Draw the way the image moves during an exposure, px: mostly little, sideways rather than up."""
    return float(rng.normal(0, 0.7)), float(rng.normal(0, 0.3))


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
    if max(abs(step) for step in sensor.motion) > _LEAST_MOTION:
        photo = _moved(np.asarray(photo, np.float32), sensor.motion)
    if sensor.vignetting > 0:
        x = np.linspace(-1, 1, lens.width, dtype=np.float32)
        y = np.linspace(-1, 1, lens.height, dtype=np.float32)
        r2 = (x[None] ** 2 + y[:, None] ** 2) / 2
        photo *= (1 - sensor.vignetting * r2 * r2)[..., None]
    return photo.clip(0, 255)


def _moved(photo: NDArray[np.float32], motion: tuple[float, float]) -> NDArray[np.float32]:
    """The mean of the photo over a straight way: symmetric, so that edges stay where they are."""
    reach = int(np.ceil(max(abs(step) for step in motion) / 2)) + 1
    kernel = np.zeros((2 * reach + 1, 2 * reach + 1), np.float32)
    for share in np.linspace(-0.5, 0.5, 33):
        x, y = reach + share * motion[0], reach + share * motion[1]
        left, top = int(np.floor(x)), int(np.floor(y))
        weights = np.outer([top + 1 - y, y - top], [left + 1 - x, x - left])
        kernel[top : top + 2, left : left + 2] += weights.astype(np.float32)
    return np.asarray(cv2.filter2D(photo, -1, kernel / kernel.sum()), np.float32)


def read_out(photo: NDArray[np.float32], sensor: Sensor, rng: np.random.Generator) -> NDArray[np.uint8]:
    """Add the noise of electrons and photons, sharpen, and write 8 bits: blue, green, red as OpenCV orders them.

    Noise comes before the sharpening, which makes it stronger as in a camera.
    """
    if sensor.noise > 0 or sensor.photon_noise > 0:
        spread = np.sqrt(sensor.noise**2 + sensor.photon_noise * photo)
        photo = photo + spread * rng.standard_normal(photo.shape, dtype=np.float32)
    if sensor.sharpening > 0:
        soft = np.asarray(cv2.GaussianBlur(photo, (0, 0), 1.0), np.float32)
        photo = np.asarray(photo + sensor.sharpening * (photo - soft), np.float32)
    image = np.ascontiguousarray(np.rint(photo).clip(0, 255).astype(np.uint8)[..., ::-1])
    if sensor.jpeg_quality > 0:
        written = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, sensor.jpeg_quality])[1]
        image = np.asarray(cv2.imdecode(written, cv2.IMREAD_COLOR), np.uint8)
    return image
