"""What lies behind the street: the sky with its clouds, and hills and trees in the haze."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from app.synthesis.light import Light, rgb
from app.synthesis.noise import layered_noise, smooth_noise
from app.synthesis.projection import View

_COARSE = 4


def paint_sky(view: View, light: Light, seed: int) -> NDArray[np.float32]:
    """Paint the background of a view, float32 ``(H, W, 3)``; the same seed is the same sky from anywhere."""
    rng = np.random.default_rng(seed)
    rows, columns = view.height // _COARSE + 2, view.width // _COARSE + 2
    pixels = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1) * float(_COARSE)
    rays = np.concatenate([pixels, np.ones((rows, columns, 1))], axis=-1) @ np.linalg.inv(view.matrix).T
    rays = rays @ view.pose.rotation
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    up = np.clip(-rays[..., 1], 0, 1).astype(np.float32)
    sky = light.horizon + (light.zenith - light.horizon) * (np.clip(up * 1.7, 0, 1) ** 0.62)[..., None]
    towards_sun = np.clip(rays @ light.to_sun, 0, 1).astype(np.float32)[..., None]
    sky = sky + 255 * light.sun * (0.10 * towards_sun**6 + 0.25 * towards_sun**60)

    noise = layered_noise(rng, 512, 1024, 90, 5)
    over = 1 / np.maximum(-rays[..., 1] + 0.16, 0.05)
    at_x = (512 + 90 * rays[..., 0] * over).astype(np.float32)
    at_y = (256 + 90 * (rays[..., 2] * over - 3)).astype(np.float32)
    cloud = cv2.remap(noise, at_x, at_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
    cover = np.clip((cloud + 1.6 * light.clouds - 1.0) * 0.8, 0, 1) * np.clip(up * 9, 0, 1)
    white = np.clip(light.horizon * 0.55 + (light.sky_light + light.sun) * 105, 0, 255)
    shade = (0.92 + 0.08 * np.clip(cloud, -1, 1))[..., None]
    sky = sky + (0.85 * cover)[..., None] * (white * shade - sky)
    _add_hills(sky, rays, light, rng)
    scale = np.array([[1 / _COARSE, 0, 0], [0, 1 / _COARSE, 0]])
    fine = cv2.warpAffine(
        np.ascontiguousarray(sky, np.float32).clip(0, 255),
        scale,
        (view.width, view.height),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return np.asarray(fine, np.float32)


def _add_hills(sky: NDArray[np.float32], rays: NDArray[np.float64], light: Light, rng: np.random.Generator) -> None:
    """Two wooded ridges along the horizon, the farther the paler."""
    bearing = np.arctan2(rays[..., 0], rays[..., 2])
    rise = np.arctan2(-rays[..., 1], np.hypot(rays[..., 0], rays[..., 2]))
    green = light.shade(rgb(92, 112, 92), (0, -0.7, -0.7))
    for base, rough, fade in ((0.035, 0.010, 0.75), (0.018, 0.006, 0.5)):
        ridge = smooth_noise(rng, 1, 2048, 60)[0] * rough + smooth_noise(rng, 1, 2048, 8)[0] * rough * 0.25
        top = base + ridge[np.clip((bearing + np.pi) / (2 * np.pi) * 2047, 0, 2047).astype(int)]
        cover = np.clip((top - rise) * 260 + 0.5, 0, 1)[..., None]
        tone = green + fade * (light.horizon - green)
        sky += (cover * (tone - sky)).astype(np.float32)
