"""What a tool makes of a file is what our lens says, within the error that the file states."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, reject, settings
from hypothesis import strategies as st

from app.calibration.exports import FORMATS, choose_intrinsics, export_lens
from app.calibration.lens import CameraLens, Family
from app.errors import CannotExport

NAMES = ("plain", "barrel", "wide", "pincushion", "decentred", "barrel as OpenCV writes it")
ROUNDING = {"lensfun": 0.01, "stmap": 1e-3, "remap": 1e-3}
"""px; Lensfun counts along a row in single precision, maps hold single precision."""
OTHER_POINTS = 1.25
"""The stated error is that of one grid, a tool is asked at other points."""
PIXEL_MAPS = ("stmap", "remap", "lensfun")

Consumers = Mapping[str, Callable[..., Any]]


def agreement(exported: Any, lens: CameraLens, consumer: Callable[..., Any]) -> tuple[float, float]:
    """Distance in px, rms and greatest, of where a tool and our lens see the points that lie in the frame."""
    corrected, seen = consumer(exported, lens)
    expected = lens.distort(corrected)
    size = np.array([lens.width - 1, lens.height - 1])
    inside = np.isfinite(expected).all(axis=1) & ((expected >= -1e-6) & (expected <= size + 1e-6)).all(axis=1)
    # a polynomial has values beyond its fold, too
    inside &= np.hypot(*(lens.undistort(expected) - corrected).T) < 1e-6
    assert inside.sum() > 0.3 * len(corrected)
    distance = np.hypot(*(seen - expected)[inside].T)
    return float(np.sqrt(np.mean(distance**2))), float(distance.max())


def test_there_is_a_tool_for_each_format(consumers: Consumers) -> None:
    assert set(consumers) == set(FORMATS)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("format_name", list(FORMATS))
def test_a_tool_sees_what_the_lens_says_within_the_stated_error(
    format_name: str, name: str, lenses: Mapping[str, CameraLens], consumers: Consumers
) -> None:
    lens = lenses[name]
    intrinsics = choose_intrinsics(lens, focal_length=0.8 * lens.width)
    exported = export_lens(lens, format_name, camera_name="front", intrinsics=intrinsics, limit=5)
    rms, maximum = agreement(exported, lens, consumers[format_name])
    extra = ROUNDING.get(format_name, 1e-6)
    assert rms <= OTHER_POINTS * exported.error.rms + extra
    assert maximum <= OTHER_POINTS * exported.error.maximum + 2 * extra


@pytest.mark.parametrize("format_name", [name for name in FORMATS if name not in PIXEL_MAPS])
def test_the_stated_error_is_no_excuse(
    format_name: str, lenses: Mapping[str, CameraLens], consumers: Consumers
) -> None:
    """An error that the file states is really there: nothing is stated to be safe."""
    lens = lenses["wide"]
    exported = export_lens(
        lens, format_name, camera_name="front", intrinsics=choose_intrinsics(lens, focal_length=300), limit=5
    )
    rms, _ = agreement(exported, lens, consumers[format_name])
    assert rms >= 0.7 * exported.error.rms - 1e-6


@st.composite
def some_lens(draw: st.DrawFn) -> CameraLens:
    family: Family = draw(st.sampled_from(["brown", "opencv", "division"]))
    width, height = draw(st.sampled_from([(320, 240), (621, 188), (188, 310)]))
    sign = -1 if family == "opencv" else 1
    k1 = sign * draw(st.floats(-0.1, 0.25))
    k2 = draw(st.floats(-0.04, 0.04))
    tangential = () if family == "division" else (draw(st.floats(-0.002, 0.002)), draw(st.floats(-0.002, 0.002)))
    center = draw(st.floats(-0.02, 0.02)), draw(st.floats(-0.02, 0.02))
    lens = CameraLens(family, width, height, (k1, k2, draw(st.floats(-0.02, 0.02)), *tangential, *center))
    assume(lens.is_invertible())
    return lens


@settings(max_examples=40, deadline=None)
@given(
    lens=some_lens(),
    format_name=st.sampled_from([name for name in FORMATS if name not in PIXEL_MAPS]),
    focal_length=st.floats(0.4, 3.0),
    shift=st.floats(-0.02, 0.02),
)
def test_any_lens_comes_back_from_each_format_that_takes_it(
    lens: CameraLens, format_name: str, focal_length: float, shift: float, consumers: Consumers
) -> None:
    x, y = lens.center
    intrinsics = choose_intrinsics(
        lens, focal_length=focal_length * lens.scale, principal_point=(x + shift * lens.scale, y)
    )
    try:
        exported = export_lens(lens, format_name, camera_name="any", intrinsics=intrinsics)
    except CannotExport:
        reject()
    rms, maximum = agreement(exported, lens, consumers[format_name])
    assert rms <= OTHER_POINTS * exported.error.rms + 1e-6
    assert maximum <= OTHER_POINTS * exported.error.maximum + 1e-5
