"""Arrangements of lines that tell less of a lens than their number suggests, named in words."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.calibration.calibration import CalibrationUncertainty, Warned
from app.calibration.left_out import LeftOut
from app.calibration.lens_solver import SolvedLens
from app.calibration.observations import LineObservations
from app.calibration.posterior import LensPosterior
from app.calibration.priors import prior_sd

Array = NDArray[np.float64]

FEW_LINES = 12
NEAR_CENTER = 0.12
"""Half diagonals; lines nearer to the centre than this hardly bend."""
BAND = 0.4
"""Share of the frame's width or height within which nine tenths of the lines lie."""
ONE_DIRECTION = 0.92
"""Length of the mean direction (of doubled angles) from which all lines run alike."""
ONE_SIDED = 0.92
"""Share of the lines on one side of the centre."""
DISAGREEING = 2.0
"""Ratio of the jackknife's error to the expected one."""
MOST_OF_ONE = 0.8
"""Share of all that the lines tell from which one image's lines tell nearly all of it."""
WEAK = 0.7
"""Share of its prior's standard deviation that is left of a coefficient that lines hardly tell."""


def warnings_of(
    observed: LineObservations, solved: SolvedLens, posterior: LensPosterior, uncertainty: CalibrationUncertainty
) -> list[Warned]:
    """Return what is wrong with how the straight lines lie; the codes are those of `Warned`."""
    straight = solved.lines.straight >= 0.5
    lines = observed.select(straight)
    found: list[Warned] = []
    if len(lines) < FEW_LINES:
        found.append(Warned("few-lines", f"only {len(lines)} straight lines; each of them decides much"))
    if not len(lines):
        return found
    if len(np.unique(lines.image)) == 1:
        found.append(Warned("one-image", "all lines are of one image: nothing can check what it says"))
    found += _placed(lines, solved)
    radial = [name for name in ("k2", "k3") if name in solved.lens.names]
    sd = np.sqrt(np.diag(posterior.second_moment))[: len(solved.lens.names)] / prior_sd(solved.lens.family)
    weak = [name for name in radial if name not in solved.released and sd[solved.lens.names.index(name)] > WEAK]
    if weak:
        found.append(
            Warned("weak-higher-terms", f"{' and '.join(weak)} can hardly be told: lines near the corners are missing")
        )
    of_image = np.bincount(observed.image, posterior.information)
    alike = of_image.max() < MOST_OF_ONE * of_image.sum()  # without the image that tells nearly all, nothing is left
    if alike and uncertainty.jackknife is not None and uncertainty.jackknife > DISAGREEING * uncertainty.pred:
        found.append(
            Warned(
                "disagreeing-images",
                f"images disagree: leaving them out in turn moves the lens by {uncertainty.jackknife:.2g} px where "
                f"{uncertainty.pred:.2g} px were expected",
            )
        )
    return found


def warnings_of_left_out(unusable: LeftOut, width: int, height: int) -> list[Warned]:
    """Return what was left out of the lines because it can't be used, or is there already."""
    found: list[Warned] = []
    if unusable.outside.any():
        found.append(Warned("outside-frame", outside_frame(unusable, width, height)))
    if copies := int(unusable.copy.sum()):
        found.append(Warned("copies", f"{_are(copies)} of the same points as others, which count once"))
    return found


def outside_frame(unusable: LeftOut, width: int, height: int) -> str:
    """Say how many lines leave the frame."""
    leaving, number = int(unusable.outside.sum()), len(unusable.outside)
    return f"{leaving} of {number} lines leave the frame, as if the images weren't of {width} x {height} px"


def warnings_of_size(uncertainty: CalibrationUncertainty) -> list[Warned]:
    """Return that a lens can't be told from none, if it can't."""
    if uncertainty.correction > uncertainty.bound95:
        return []
    return [
        Warned(
            "within-noise",
            f"the correction of {uncertainty.correction:.2g} px is within its own error, up to "
            f"{uncertainty.bound95:.2g} px: it can't be told from no distortion at all",
        )
    ]


def _are(number: int) -> str:
    return f"{number} line is" if number == 1 else f"{number} lines are"


def _placed(lines: LineObservations, solved: SolvedLens) -> list[Warned]:
    found: list[Warned] = []
    cx, cy = solved.lens.parameters[-2:]
    amount = lines.weight * lines.length[:, None]
    x, y = lines.x - cx, lines.y - cy
    middle_x, middle_y = (lines.weight * x).sum(1), (lines.weight * y).sum(1)
    distance = np.abs(middle_x * np.sin(lines.direction) - middle_y * np.cos(lines.direction))
    if _quantile(distance, lines.length, 0.9) < NEAR_CENTER:
        found.append(Warned("near-center", "nearly all lines pass near the centre, where no lens bends them"))
    half_width, half_height = _half_sides(solved)
    for name, values, half in (("vertical", x, half_width), ("horizontal", y, half_height)):
        low, high = (_quantile(values.ravel(), amount.ravel(), share) for share in (0.05, 0.95))
        if high - low < BAND * 2 * half:
            found.append(
                Warned(
                    "one-band", f"nearly all lines lie in one {name} band, {(high - low) / (2 * half):.0%} of the frame"
                )
            )
            break
    mean = np.abs(np.average(np.exp(2j * lines.direction), weights=lines.length))
    if mean > ONE_DIRECTION:
        turned = float(np.angle(np.average(np.exp(2j * lines.direction), weights=lines.length)))
        degrees = round(np.degrees(turned) / 2) % 180
        found.append(Warned("one-direction", f"nearly all lines run in one direction, about {degrees} degrees"))
    for axis, values in (("left", x), ("top", y)):
        share = float((amount * (values < 0)).sum() / amount.sum())
        if max(share, 1 - share) > ONE_SIDED:
            side = axis if share > 0.5 else {"left": "right", "top": "bottom"}[axis]
            found.append(Warned("one-sided", f"nearly all lines lie on the {side} side of the centre"))
            break
    return found


def _half_sides(solved: SolvedLens) -> tuple[float, float]:
    return solved.lens.width / 2 / solved.lens.scale, solved.lens.height / 2 / solved.lens.scale


def _quantile(values: Array, weight: Array, share: float) -> float:
    order = np.argsort(values)
    total = np.cumsum(weight[order])
    return float(values[order][min(int(np.searchsorted(total, share * total[-1])), len(values) - 1)])
