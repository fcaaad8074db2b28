"""What the image shows along a candidate: contrast, polarity, the two sides, and what goes on beyond its ends."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from app.review.strands import SAMPLES, Strands
from app.vision.image_reading import read_image

Array = NDArray[np.float64]

OFFSETS = (-9.0, -6.0, -4.0, -2.5, -1.5, -0.75, 0.75, 1.5, 2.5, 4.0, 6.0, 9.0)
"""px across a candidate at which the image is read."""
BEYOND = np.array([4.0, 7.0, 10.0, 14.0, 18.0])
"""px past an end at which the image is read."""
TEXTURE_SIGMA = 8.0
"""px, radius of the neighbourhood whose gradients are compared."""

APPEARANCE = (
    "contrast",
    "contrast evenness",
    "weakest contrast",
    "polarity",
    "wide contrast",
    "edge sharpness",
    "side texture",
    "rougher side",
    "side difference",
    "brightness",
    "bar",
    "goes on beyond start",
    "goes on beyond end",
    "local gradient",
    "local coherence",
    "local alignment",
    "near gradient share",
)


def appearance(strands: Strands, gray: NDArray[np.uint8] | None) -> Array:
    """Return the columns of `APPEARANCE`, float64 ``(S, 17)``; NaN throughout without an image."""
    if gray is None or not len(strands):
        return np.full((len(strands), len(APPEARANCE)), np.nan)
    smooth = _blurred(gray.astype(np.float32), 0.7)
    profiles, tangent = _profiles(strands, smooth)
    inner = profiles[:, :, OFFSETS.index(1.5)] - profiles[:, :, OFFSETS.index(-1.5)]
    middle = profiles[:, :, OFFSETS.index(2.5)] - profiles[:, :, OFFSETS.index(-2.5)]
    tight = profiles[:, :, OFFSETS.index(0.75)] - profiles[:, :, OFFSETS.index(-0.75)]
    wide = profiles[:, :, OFFSETS.index(6.0)] - profiles[:, :, OFFSETS.index(-6.0)]
    typical = np.median(middle, axis=1)
    sign = np.where(typical < 0, -1.0, 1.0)[:, None]
    left, right = profiles[:, :, :4], profiles[:, :, -4:]
    textures = np.stack([left.std(axis=1).mean(axis=1), right.std(axis=1).mean(axis=1)])
    contrast = np.abs(typical)
    columns = [
        np.log1p(contrast),
        np.median(np.abs(middle - typical[:, None]), axis=1) / (contrast + 3),
        np.percentile(middle * sign, 15, axis=1) / (contrast + 3),
        (middle * sign > 0).mean(axis=1),
        np.median(wide * sign, axis=1) / (contrast + 3),
        np.median(tight * sign, axis=1) / (contrast + 3),
        np.log1p(textures.min(axis=0)),
        np.log1p(textures.max(axis=0)),
        np.abs(left.mean(axis=(1, 2)) - right.mean(axis=(1, 2))) / 32,
        profiles.mean(axis=(1, 2)) / 255,
        np.abs(np.median(inner, axis=1)) / (np.abs(np.median(wide, axis=1)) + 3),
        *_beyond(strands, smooth, tangent, typical),
        *_texture(strands, smooth),
    ]
    return np.stack(columns, axis=1).astype(np.float64)


def _blurred(image: NDArray[Any], sigma: float) -> NDArray[np.float32]:
    return np.asarray(cv2.GaussianBlur(image, (0, 0), sigma), np.float32)


def _read(image: NDArray[np.float32], points: Array) -> Array:
    """Return the image at points ``(..., 2)`` in px."""
    return read_image(image, points).astype(np.float64)


def _profiles(strands: Strands, smooth: NDArray[np.float32]) -> tuple[Array, Array]:
    """Return grey values ``(S, SAMPLES, offsets)`` across the candidates and tangents ``(S, SAMPLES, 2)``."""
    reach = 3
    ahead = np.minimum(np.arange(SAMPLES) + reach, SAMPLES - 1)
    behind = np.maximum(np.arange(SAMPLES) - reach, 0)
    tangent = strands.samples[:, ahead] - strands.samples[:, behind]
    norm = np.hypot(tangent[..., 0], tangent[..., 1])[..., None]
    tangent = np.where(norm > 0, tangent / np.where(norm > 0, norm, 1.0), strands.direction[:, None])
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], -1)
    places = strands.samples[:, :, None] + normal[:, :, None] * np.array(OFFSETS)[:, None]
    return _read(smooth, places), tangent


def _beyond(strands: Strands, smooth: NDArray[np.float32], tangent: Array, typical: Array) -> list[Array]:
    """Return the contrast past either end over that within, the stronger end last."""
    shares = []
    for sample, sign in ((0, -1.0), (SAMPLES - 1, 1.0)):
        along = tangent[:, sample]
        normal = np.stack([-along[:, 1], along[:, 0]], -1)
        places = strands.samples[:, sample, None] + sign * BEYOND[:, None] * along[:, None]
        step = 2.5 * normal[:, None]
        contrast = _read(smooth, places + step) - _read(smooth, places - step)
        outside = ((places < 0) | (places > [strands.width - 1, strands.height - 1])).any(axis=(1, 2))
        share = np.median(contrast, axis=1) * np.where(typical < 0, -1, 1) / (np.abs(typical) + 3)
        shares.append(np.where(outside, 0.0, np.clip(share, -1.5, 1.5)))
    both = np.sort(np.stack(shares), axis=0)
    return [both[0], both[1]]


def _texture(strands: Strands, smooth: NDArray[np.float32]) -> list[Array]:
    """Return energy of the gradients around, how much they agree with one another, and with the candidate."""
    half = 0.5
    height, width = smooth.shape
    small = cv2.resize(smooth, (-(-width // 2), -(-height // 2)), interpolation=cv2.INTER_AREA)
    gx, gy = cv2.Sobel(small, cv2.CV_32F, 1, 0, scale=0.125), cv2.Sobel(small, cv2.CV_32F, 0, 1, scale=0.125)
    places = (strands.samples[:, ::2] + 0.5) * half - 0.5
    products = (gx * gx, gx * gy, gy * gy)
    tensors = [
        [_read(_blurred(product, sigma * half), places).mean(axis=1) for product in products]
        for sigma in (TEXTURE_SIGMA, 2.5 * TEXTURE_SIGMA)
    ]
    (xx, xy, yy), (wide_xx, _, wide_yy) = tensors
    energy = xx + yy
    coherence = np.hypot(xx - yy, 2 * xy) / (energy + 1e-3)
    dx, dy = strands.direction.T
    across = dy * dy * xx - 2 * dx * dy * xy + dx * dx * yy
    return [
        np.log1p(energy),
        coherence,
        across / (energy + 1e-3),
        energy / (wide_xx + wide_yy + energy + 1e-3),
    ]
