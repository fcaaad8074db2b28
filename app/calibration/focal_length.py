"""The focal length and the principal point of a camera, from the lines of its images.

Straight lines alone leave both open; directions at right angles don't. Vanishing points of each image propose, images
vote (`app.calibration.focal_votes`), and what they agree on is adjusted over all lines
(`app.calibration.frame_adjustment`). Where the images can't tell, or one pair of directions would have to be taken on
trust, the answer says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from app.calibration.corrected_lines import CorrectedLines, ImageLines, LensUncertainty, correct_lines
from app.calibration.focal_estimate import FocalEstimate, FoundDirection
from app.calibration.focal_votes import FOCAL_LENGTHS, PRINCIPAL_POINT_SIGMA, Votes, votes_of
from app.calibration.frame_adjustment import Adjustment, adjust
from app.calibration.lens import CameraLens
from app.calibration.vanishing_points import VanishingPoint, vanishing_points
from app.vision.frame import center_of

Array = NDArray[np.float64]

NEAR = 0.25
"""Focal lengths that differ by less than this share say the same."""
SURE = 0.95
"""Probability that the focal length lies near the likeliest one, from which that is believed."""
MOST_SIGMA = 0.04
"""Largest standard deviation, as a share of the focal length, that is stated: beyond it the error's law is skew."""
LEAST_AGREEING, LEAST_CONFIRMED = 0.7, 0.34
"""Share of the images with two directions or more that must agree; the latter where three directions in one image
confirm each other. Walls that meet at one and the same wrong angle agree in fewer."""
FEWEST_TO_COMPARE, MOST_ODD = 4, 3.5
"""Images from which one may be left out as contradicting the others, and standard deviations by which it must."""
ASKED_AGAIN: Mapping[str, float] = {"k1": 0.02, "k2": 0.05}
"""Standard deviations by which these parameters of the lens may be off beyond what straightness says: labels drawn from
end to end are straight under any lens, and vanishing points tell these parameters as well."""
FEWEST_FRAMES, MOST_CENTER_SIGMA = 3, 0.5
"""Images with three directions, and standard deviation as a share of that before, for a principal point to be given."""


def estimate_focal(
    images: Sequence[ImageLines], lens: CameraLens, *, uncertain: LensUncertainty | None = None, seed: int = 0
) -> FocalEstimate:
    """Estimate the focal length, and the principal point where it can be seen, of the undistorted image.

    Args:
        images: Lines of the images of one camera; each with a probability of being straight, or kept by a person.
        lens: The camera's lens.
        uncertain: What isn't known of the lens; `ASKED_AGAIN` in any case.
        seed: Of the choice of pairs of lines, where there are too many to try all.
    """
    uncertain = _asked_again(uncertain or LensUncertainty((), np.zeros((0, 0))))
    lines = correct_lines(images, lens, uncertain)
    points = [vanishing_points(each, seed=seed) for each in lines]
    votes = [votes_of(each) for each in points]
    if not any(vote.explanations for vote in votes):
        return FocalEstimate(False, reason=_too_few(points))
    evidence = np.sum([np.log(vote.evidence()) for vote in votes], axis=0)
    likely = np.exp(evidence - evidence.max())
    likely /= likely.sum()
    index = int(np.argmax(likely))
    near = np.abs(np.log(FOCAL_LENGTHS / FOCAL_LENGTHS[index])) < NEAR
    if likely[near].sum() < SURE:
        return FocalEstimate(False, reason=_undecided(votes, likely, index))
    return _adjusted(images, lines, points, votes, index, lens, uncertain)


def _asked_again(uncertain: LensUncertainty) -> LensUncertainty:
    """Return the uncertainty with that of `ASKED_AGAIN` added."""
    names = (*uncertain.released, *(name for name in ASKED_AGAIN if name not in uncertain.released))
    covariance = np.zeros((len(names), len(names)))
    known = len(uncertain.released)
    covariance[:known, :known] = uncertain.covariance
    covariance += np.diag([ASKED_AGAIN.get(name, 0.0) ** 2 for name in names])
    return LensUncertainty(names, covariance)


def _adjusted(
    images: Sequence[ImageLines],
    lines: Sequence[CorrectedLines],
    points: Sequence[Sequence[VanishingPoint]],
    votes: Sequence[Votes],
    index: int,
    lens: CameraLens,
    uncertain: LensUncertainty,
) -> FocalEstimate:
    chosen = {row: some for row, vote in enumerate(votes) if (some := vote.best(index)) is not None}
    asked = sum(bool(vote.explanations) for vote in votes)
    confirmed = any(len(some) == 3 for some in chosen.values())
    if not chosen or len(chosen) < (LEAST_CONFIRMED if confirmed else LEAST_AGREEING) * asked:
        return FocalEstimate(False, reason=_disagreeing(len(chosen), asked))
    rows = list(chosen)
    while True:
        found = adjust(
            [lines[row] for row in rows],
            [np.array([points[row][each].vector for each in chosen[row]]) for row in rows],
            float(FOCAL_LENGTHS[index]),
            PRINCIPAL_POINT_SIGMA,
            uncertain.covariance,
        )
        odd = _odd_one_out(found)
        if odd is None:
            break
        del rows[odd]
    if len(rows) < (LEAST_CONFIRMED if confirmed else LEAST_AGREEING) * asked:
        return FocalEstimate(False, reason=_disagreeing(len(rows), asked))
    return _stated(found, [images[row].name for row in rows], float(FOCAL_LENGTHS[index]), lens)


def _stated(found: Adjustment, names: Sequence[str], voted: float, lens: CameraLens) -> FocalEstimate:
    """Return the estimate as it is said, or why none is."""
    covariance = _with_jackknife(found)
    sigma = float(np.sqrt(covariance[0, 0]))
    share = found.information[:, 0, 0] / max(found.information[:, 0, 0].sum(), 1e-12)
    told = int((share > 0.02).sum())
    if not sigma < MOST_SIGMA or abs(np.log(found.pinhole.focal / voted)) > NEAR:
        open_by = max(sigma, abs(float(np.log(found.pinhole.focal / voted))))
        reason = (
            "the directions at right angles lie near the viewing axis or along the image plane, "
            f"which leaves the focal length open by about {100 * min(open_by, 9.99):.0f} %"
        )
        return FocalEstimate(False, reason=reason, images=told)
    focal = found.pinhole.focal * lens.scale
    sigmas = np.sqrt(np.diag(covariance)[1:3])
    triples = sum(frame.directions == 3 for frame in found.frames)
    known = bool((sigmas < MOST_CENTER_SIGMA * PRINCIPAL_POINT_SIGMA).all()) and triples >= FEWEST_FRAMES
    xc, yc = center_of(lens.width, lens.height)
    x, y = found.pinhole.center * lens.scale
    return FocalEstimate(
        observable=True,
        focal_length=focal,
        sigma=focal * sigma,
        principal_point=(xc + float(x), yc + float(y)) if known else None,
        principal_point_sigma=(float(sigmas[0] * lens.scale), float(sigmas[1] * lens.scale)) if known else None,
        images=told,
        vanishing_points=_directions(names, found),
    )


def _odd_one_out(found: Adjustment) -> int | None:
    """Return the image that contradicts the others most, if it does so beyond chance and enough others are left."""
    number = len(found.left_out)
    if number < FEWEST_TO_COMPARE:
        return None
    total = np.linalg.inv(found.covariance)
    without = np.array([np.linalg.inv(total - some)[0, 0] for some in found.information])
    expected = np.sqrt(np.maximum(without - found.covariance[0, 0], 1e-12))
    oddness = np.abs(found.left_out[:, 0]) / expected
    worst = int(np.argmax(oddness))
    return worst if oddness[worst] > MOST_ODD else None


def _with_jackknife(found: Adjustment) -> Array:
    """Return the covariance, made as wide as the images disagree (leave one image out; Tukey 1958)."""
    number = len(found.left_out)
    if number < 3:
        return found.covariance
    away = found.left_out - found.left_out.mean(0)
    spread = (number - 1) / number * (away**2).sum(0)
    wider = np.sqrt(np.maximum(1.0, spread / np.diag(found.covariance)))
    return found.covariance * np.outer(wider, wider)


def _directions(names: Sequence[str], found: Adjustment) -> tuple[FoundDirection, ...]:
    directions: list[FoundDirection] = []
    for name, frame, members in zip(names, found.frames, found.members, strict=True):
        for axis, row in enumerate(frame.rays):
            count = int((members == axis).sum())
            x, y, z = (float(value) for value in (row if row[2] >= 0 else -row))
            if count >= 2:
                directions.append(FoundDirection(name, (x, y, z), count))
    return tuple(directions)


def _too_few(points: Sequence[Sequence[VanishingPoint]]) -> str:
    if not any(points):
        return "in no image do three lines or more meet in one vanishing point"
    return "every image shows one vanishing point only; two directions at right angles are needed"


def _undecided(votes: Sequence[Votes], likely: Array, index: int) -> str:
    agreeing = sum(vote.best(index) is not None for vote in votes)
    if agreeing <= 1:
        return "the focal length would hang on one pair of directions in one image, which nothing confirms"
    mean = np.average(np.log(FOCAL_LENGTHS), weights=likely)
    spread = float(np.exp(2 * np.sqrt(np.average((np.log(FOCAL_LENGTHS) - mean) ** 2, weights=likely))))
    return f"the images agree on no focal length; likely ones differ by a factor of {spread:.1f}"


def _disagreeing(agreeing: int, asked: int) -> str:
    return f"only {agreeing} of {asked} images agree on a focal length, which may be chance"
