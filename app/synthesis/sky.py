"""What lies behind the street: the sky with its clouds, and hills and trees in the haze."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.light import Light, rgb
from app.synthesis.noise import Pixels, layered_noise, smooth_noise
from app.synthesis.projection import View

_COARSE = 4
_BEARINGS = 2048
_RIDGES = ((0.035, 0.010, 0.75), (0.018, 0.006, 0.5))  # height and roughness in rad, and how much haze hides


@dataclass(frozen=True, eq=False)
class Sky:
    """What is uneven about a sky, made once for a street.

    Attributes:
        clouds: float32 ``(512, 1024)``: how thick they are, mean 0 and sd 1.
        ridges: Heights of wooded hills by bearing, rad, float32 ``(2048,)`` each, the farther first.
    """

    clouds: Pixels
    ridges: tuple[Pixels, ...]


def make_sky(seed: int) -> Sky:
    """Draw a sky from a seed."""
    rng = np.random.default_rng(seed)
    clouds = layered_noise(rng, 512, 1024, 90, 5)
    ridges = [
        base
        + smooth_noise(rng, 1, _BEARINGS, 60)[0] * rough
        + smooth_noise(rng, 1, _BEARINGS, 8)[0] * rough * np.float32(0.25)
        for base, rough, _ in _RIDGES
    ]
    return Sky(clouds, tuple(np.asarray(ridge, np.float32) for ridge in ridges))


def paint_sky(view: View, light: Light, sky: Sky) -> NDArray[np.float32]:
    """Paint the background of a view, float32 ``(3, H, W)``: red, green, blue; it is the same sky from anywhere."""
    rows, columns = -(-view.height // _COARSE), -(-view.width // _COARSE)
    # each stands for a square of pixels, about its middle
    pixels = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1) * _COARSE + (_COARSE - 1) / 2
    turned = np.linalg.inv(view.matrix).T @ view.pose.rotation
    rays = (pixels @ turned[:2] + turned[2]).astype(np.float32)
    x, y, z = np.moveaxis(rays, 2, 0) / np.sqrt(np.einsum("ijk,ijk->ij", rays, rays))
    up = np.clip(-y, 0, 1)
    colours = light.horizon + (light.zenith - light.horizon) * (np.clip(up * 1.7, 0, 1) ** 0.62)[..., None]
    sun = light.to_sun.astype(np.float32)
    towards_sun = np.clip(x * sun[0] + y * sun[1] + z * sun[2], 0, 1)
    colours += 255 * light.sun * (0.10 * towards_sun**6 + 0.25 * towards_sun**60)[..., None]

    over = 1 / np.maximum(0.16 - y, 0.05)
    cloud = cv2.remap(
        sky.clouds, 512 + 90 * x * over, 256 + 90 * (z * over - 3), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT
    )
    cover = np.clip((cloud + np.float32(1.6 * light.clouds - 1.0)) * 0.8, 0, 1) * np.clip(up * 9, 0, 1)
    white = np.clip(light.horizon * 0.55 + (light.sky_light + light.sun) * 105, 0, 255)
    shade = (0.92 + 0.08 * np.clip(cloud, -1, 1))[..., None]
    colours += (0.85 * cover)[..., None] * (white * shade - colours)
    _add_hills(colours, x, y, z, light, sky)
    size = (columns * _COARSE, rows * _COARSE)
    fine = cv2.resize(np.clip(colours, 0, 255), size, interpolation=cv2.INTER_LINEAR)
    return np.stack(cv2.split(fine[: view.height, : view.width]))


def _add_hills(colours: Pixels, x: Pixels, y: Pixels, z: Pixels, light: Light, sky: Sky) -> None:
    """Two wooded ridges along the horizon, the farther the paler."""
    bearing = (np.arctan2(x, z) + np.float32(np.pi)) / np.float32(2 * np.pi)
    place = np.clip(bearing * (_BEARINGS - 1), 0, _BEARINGS - 1).astype(np.int64)
    rise = np.arctan2(-y, np.hypot(x, z))
    green = light.shade(rgb(92, 112, 92), (0, -0.7, -0.7))
    for ridge, (_, _, fade) in zip(sky.ridges, _RIDGES, strict=True):
        cover = np.clip((ridge[place] - rise) * 260 + 0.5, 0, 1)[..., None]
        colours += cover * (green + np.float32(fade) * (light.horizon - green) - colours)
