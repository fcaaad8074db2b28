"""What the report says in words: the verdict, what to do about a warning, what a parameter is, numbers as texts."""

from __future__ import annotations

import math
from collections.abc import Mapping

from app.calibration.calibration import Calibration

ADVICE: Mapping[str, str] = {
    "near-center": "Keep lines far from the centre: edges of facades, poles and kerbs near the border of the image.",
    "one-image": "Label more images of this camera; from three on they can check one another.",
    "few-lines": "Keep more long lines; some 40 lines of 100 px and more tell a lens to a fraction of a pixel.",
    "one-band": "Look for lines where the coverage map is empty, above all towards the corners.",
    "one-direction": "Keep lines that run across the others: poles and window frames beside kerbs and eaves.",
    "one-sided": "Look for lines on the other side of the image; images of another turn or street may have them.",
    "weak-higher-terms": "Until lines reach the corners, trust the correction there no further than the map of "
    "uncertainty.",
    "disagreeing-images": "Look at the images with the largest residual: a line that is bent in the scene, or an image "
    "of another camera or zoom, is the usual cause.",
    "outside-frame": "See whether the lines belong to these images, and whether the images' size is right.",
    "copies": "Label images that show other things; copies of an image tell nothing new.",
    "within-noise": "The images can be taken as they are.",
}
"""What a person can do, by the warning's code."""

MEANINGS: Mapping[str, str] = {
    "k1": "radial, r²",
    "k2": "radial, r⁴",
    "k3": "radial, r⁶",
    "p1": "tangential",
    "p2": "tangential",
    "cx": "centre, to the right of the image centre",
    "cy": "centre, below the image centre",
}

FAMILY_TITLES: Mapping[str, str] = {
    "brown": "Brown-Conrady, measured to corrected",
    "opencv": "Brown-Conrady, corrected to measured (OpenCV's direction)",
    "division": "division model",
}

FAMILY_NAMES: Mapping[str, str] = {"brown": "Brown", "opencv": "OpenCV", "division": "division"}


def pixels(value: float | None) -> str:
    """Return a length in px with about two telling digits."""
    if value is None or not math.isfinite(value):
        return "unknown"
    decimals = 0 if value >= 100 else 1 if value >= 10 else 2 if value >= 0.1 else 3
    return f"{value:.{decimals}f} px"


def tiny_pixels(value: float) -> str:
    """Return the error of a conversion, which may be next to nothing."""
    return "< 0.0001 px" if value < 0.0001 else f"{value:.4f} px" if value < 10 else f"{value:.1f} px"


def figure(value: float, digits: int = 6) -> str:
    """Return a signed number with its sign as typographers set it; what rounds to nothing is 0."""
    text = f"{value:+.{digits}f}".replace("-", "−")
    return text if text.strip("+−0.") else "0"


def with_sigma(value: float, sigma: float) -> tuple[str, str]:
    """Return a number and its standard deviation, both to the decimals that the deviation's two digits need."""
    if not (math.isfinite(sigma) and sigma > 0):
        return figure(value), "-"
    decimals = min(max(1 - math.floor(math.log10(sigma)), 0), 9)
    return figure(value, decimals), f"{sigma:.{decimals}f}"


def verdict(calibration: Calibration) -> tuple[str, str]:
    """Return the verdict as a headline, and what it means as sentences."""
    known = calibration.uncertainty
    if not calibration.accepted:
        return (
            "Not to be used",
            f"The lines don't tell this lens well enough: {'; '.join(calibration.reasons) or 'no reason is given'}. "
            "What follows shows what is known, and where lines are missing.",
        )
    return (
        "Can be used",
        f"The correction moves points by {pixels(known.correction)} (RMS over the frame, as far as lines can tell). "
        f"It is expected to be wrong by {pixels(known.pred)}, and with 95 % confidence by less than "
        f"{pixels(known.bound95)}, over the whole frame and after the best homography, which straight lines can't fix.",
    )
