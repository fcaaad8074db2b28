"""Probability that a candidate is a straight line of the scene, seen through the camera's lens.

A segment passes (0.5 and more) if the distances of its points from its straight line, in the measured image and under
the estimated lens, are at most max(3 sigma, 0.5 px) RMS and 1.5 px at most; sigma is the noise of the image's edge
points. The lens is itself uncertain, and a segment is not to blame for that: of its residuals, the part is forgiven
that a change of k1 within its standard deviation would take away. Where the estimate was refused the lens may be
any plausible one, and each segment is forgiven what the most favourable one would explain.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.vision.distortion import DistortionEstimate
from app.vision.division import Division
from app.vision.lens_evidence import SCAN
from app.vision.lens_uncertainty import field_sensitivity
from app.vision.sampson import sampson_residuals
from app.vision.segments import Segments

Array = NDArray[np.float64]

RMS_LIMIT = 0.5
MAXIMUM_LIMIT = 1.5
"""px; residuals at which a segment is as likely straight as not."""
SHARPNESS = 4.0
"""Power of the residual's ratio to its limit; at half the limit the probability is 0.94, at twice 0.06."""
MOST_SIGMA = 0.3
"""px; more noise than this isn't believed, or a scene of nothing but foliage would forgive everything."""
STEP = 0.02
"""Change of k1 over which the effect on residuals is taken."""


def judge_straightness(segments: Segments, estimate: DistortionEstimate) -> NDArray[np.float32]:
    """Return each segment's probability of being straight under the camera's lens.

    Args:
        segments: Candidates of one image, in px.
        estimate: The camera's lens, accepted or not.

    Returns:
        float32 ``(S,)`` in [0, 1], falling with the residuals; 0.5 and more passes the straightness filter.
    """
    if not len(segments):
        return np.zeros(0, np.float32)
    rms, maximum = _forgiven_residuals(segments, estimate)
    limit = max(RMS_LIMIT, 3 * min(edge_noise(segments), MOST_SIGMA))
    ratio = np.maximum(rms / limit, maximum / MAXIMUM_LIMIT)
    return (1 / (1 + np.minimum(ratio, 1e6) ** SHARPNESS)).astype(np.float32)


def edge_noise(segments: Segments) -> float:
    """Return the standard deviation in px of an image's edge points across their edge.

    Taken from second differences over three points' distance (nearer ones share the image's blur), which curves far too
    gentle to be straight don't disturb: the median over segments of each one's median absolute value.
    """
    levels = []
    for points in segments:
        if len(points) >= 12:
            chord = points[-1].astype(np.float64) - points[0]
            length = float(np.hypot(*chord))
            if length > 0:
                across = (points - points[0]) @ np.array([-chord[1], chord[0]]) / length
                levels.append(float(np.median(np.abs(across[6:] - 2 * across[3:-3] + across[:-6]))))
    # the median absolute value of a normal law is 0.6745 sd; a second difference has sqrt(1 + 4 + 1) times the noise
    return float(np.median(levels)) / (0.6745 * np.sqrt(6)) if levels else 0.0


def _forgiven_residuals(segments: Segments, estimate: DistortionEstimate) -> tuple[Array, Array]:
    """Return RMS and largest residual in px, float64 ``(S,)`` each, after what the lens's uncertainty explains."""
    width, height = estimate.width, estimate.height
    parameters = estimate.division.parameters if estimate.accepted else np.zeros(5)
    low, high = _plausible_change(parameters, estimate)
    of_point, number = segments.segment_of_point, len(segments)

    def residuals(change: float) -> Array:
        lens = Division.from_parameters(width, height, parameters + np.array([change, 0, 0, 0, 0]))
        return sampson_residuals(segments, lens)

    middle = residuals(0.0)
    slope = (residuals(STEP) - residuals(-STEP)) / (2 * STEP)
    power = np.bincount(of_point, slope**2, number)
    best = -np.bincount(of_point, slope * middle, number) / np.where(power > 0, power, 1.0)
    left = middle + np.clip(best, low, high)[of_point] * slope
    rms = np.sqrt(np.bincount(of_point, left**2, number) / segments.counts)
    maximum = np.maximum.reduceat(np.abs(left), segments.offsets[:-1])
    return rms, maximum


def _plausible_change(parameters: Array, estimate: DistortionEstimate) -> tuple[float, float]:
    """Return by how much k1 may be lower and higher than the parameters say."""
    if not estimate.accepted:
        return float(SCAN[0]), float(SCAN[-1])
    per_unit = np.sqrt(field_sensitivity(parameters, estimate.width, estimate.height)[0, 0])
    change = estimate.uncertainty.pred / max(float(per_unit), 1e-9)
    return -change, change
