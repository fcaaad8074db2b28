"""Light and colour: times of day, and how much of it a surface sends to the camera."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

Colour = NDArray[np.float32]
TimeOfDay = Literal["morning", "noon", "overcast", "evening", "dusk"]
TIMES_OF_DAY: tuple[TimeOfDay, ...] = ("noon", "evening", "overcast", "morning", "dusk")


def rgb(red: float, green: float, blue: float) -> Colour:
    """A colour, float32 ``(3,)``, in 0..255."""
    return np.array([red, green, blue], np.float32)


@dataclass(frozen=True, eq=False)
class Light:
    """The light of one moment. Colours are float32 ``(3,)``.

    Attributes:
        name: Time of day.
        to_sun: Unit vector towards the sun, ``(3,)``.
        sun: Factor of a surface that faces the sun; zero where the sky is overcast or it's dusk.
        sky_light: Factor of a surface that faces up.
        shadow: Colour factor of ground that the sun doesn't reach; `None` without shadows.
        zenith: Sky above, 0..255.
        horizon: Sky at the horizon, and the colour that distance fades into.
        haze: Distance in m over which things fade into the horizon's colour (to 1 / e).
        clouds: Share of white in the sky, 0..1.
        lamps: Whether windows and lamps are lit.
    """

    name: TimeOfDay
    to_sun: NDArray[np.float64]
    sun: Colour
    sky_light: Colour
    shadow: Colour | None
    zenith: Colour
    horizon: Colour
    haze: float
    clouds: float
    lamps: bool

    def shade(self, colour: ArrayLike, normal: ArrayLike, sunlit: bool = True) -> Colour:
        """What a matt surface of a colour ``(..., 3)`` and a normal ``(..., 3)`` sends out: Lambert plus sky light."""
        normal = np.asarray(normal, np.float64)
        above = 0.74 - 0.26 * normal[..., 1:2]  # y points down: upward normals see the whole sky
        received = above * self.sky_light
        if sunlit:
            received = received + np.maximum(normal @ self.to_sun, 0.0)[..., None] * self.sun
        return (np.asarray(colour, np.float32) * received).astype(np.float32)


def draw_light(rng: np.random.Generator, time: TimeOfDay) -> Light:
    """Draw the light of a time of day; the sun's side and height vary, its shadows reach the road but not across it."""
    side = float(rng.choice([-1.0, 1.0]))
    height = {"noon": 1.02, "morning": 0.78, "evening": 0.72, "overcast": 1.2, "dusk": 1.0}[time]
    elevation = height + float(rng.uniform(-0.06, 0.08))
    azimuth = side * float(rng.uniform(0.7, 1.25)) + (np.pi if rng.random() < 0.35 else 0.0)
    to_sun = np.array(
        [np.sin(azimuth) * np.cos(elevation), -np.sin(elevation), -abs(np.cos(azimuth)) * np.cos(elevation)]
    )
    if rng.random() < 0.3:
        to_sun[2] *= -1
    looks: dict[TimeOfDay, tuple[Colour, Colour, Colour | None, Colour, Colour, float, float]] = {
        "noon": (
            rgb(0.62, 0.60, 0.55), rgb(0.62, 0.66, 0.72), rgb(0.56, 0.60, 0.68),
            rgb(74, 136, 208), rgb(196, 218, 236), 420.0, 0.45,
        ),
        "morning": (
            rgb(0.66, 0.57, 0.45), rgb(0.58, 0.63, 0.72), rgb(0.55, 0.60, 0.72),
            rgb(98, 152, 212), rgb(244, 226, 204), 260.0, 0.35,
        ),
        "evening": (
            rgb(0.82, 0.56, 0.32), rgb(0.54, 0.53, 0.62), rgb(0.57, 0.57, 0.65),
            rgb(86, 116, 178), rgb(250, 204, 158), 300.0, 0.55,
        ),
        "overcast": (
            rgb(0.06, 0.06, 0.06), rgb(0.84, 0.86, 0.89), None,
            rgb(164, 176, 190), rgb(222, 226, 230), 170.0, 0.9,
        ),
        "dusk": (
            rgb(0.0, 0.0, 0.0), rgb(0.36, 0.38, 0.52), None,
            rgb(34, 46, 92), rgb(206, 132, 112), 320.0, 0.5,
        ),
    }  # fmt: skip
    sun, sky_light, shadow, zenith, horizon, haze, clouds = looks[time]
    return Light(
        name=time,
        to_sun=to_sun / np.linalg.norm(to_sun),
        sun=sun,
        sky_light=sky_light,
        shadow=shadow,
        zenith=zenith,
        horizon=horizon,
        haze=haze * float(rng.uniform(0.85, 1.2)),
        clouds=clouds * float(rng.uniform(0.6, 1.3)),
        lamps=time == "dusk",
    )
