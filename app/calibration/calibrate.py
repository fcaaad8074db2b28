"""A camera's lens from reviewed lines of all its images, or from candidates with probabilities."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from app.calibration.calibration import Calibration, CalibrationUncertainty
from app.calibration.calibration_image import CalibrationImage
from app.calibration.corrected_lines import LensUncertainty
from app.calibration.degeneracies import outside_frame, warnings_of, warnings_of_left_out, warnings_of_size
from app.calibration.displacement_map import COVERED, displacement_map, error_draws, field_errors
from app.calibration.focal_length import estimate_focal
from app.calibration.free_model import fit_free_model
from app.calibration.held_out import folds_of
from app.calibration.jackknife import jackknife_error, left_out_changes, shifts
from app.calibration.ladder import Climbed, climb
from app.calibration.left_out import left_out
from app.calibration.lens import FAMILY_NAMES, CameraLens, Family
from app.calibration.lens_solver import start_lens
from app.calibration.line_noise import believed_roughness
from app.calibration.line_results import STRAIGHT, image_fits, line_residuals, weighed
from app.calibration.observations import LineObservations, observe_distinct
from app.calibration.posterior import LensPosterior, field_sensitivity, lens_posterior
from app.errors import InvalidInput
from app.vision.conversion import refit_brown
from app.vision.field import field_error
from app.vision.frame import half_diagonal

__all__ = ["CalibrationImage", "calibrate"]

Watch = Callable[[str, int, int], None]

FEWEST_LINES = 3
LONGEST_SHAPE = 50
"""Longer over shorter side; a map with square cells over a stripe would have millions."""
MOST_PREDICTED = 0.42
"""Largest expected error to accept, as a share of the correction: what isn't 2.4 times its own error could well be
worse than no correction."""
GOOD_ENOUGH = 0.0007
"""Expected error, as a share of the half diagonal, that is accepted however small the correction is: half a pixel of an
image of 1280 x 720."""

DIVISION_ADVANTAGE = 2.0
"""Nats. One coefficient of the division model follows wide lenses three times as closely as one of the others."""


def calibrate(
    images: Sequence[CalibrationImage],
    size: tuple[int, int],
    *,
    family: Family | None = None,
    seed: int = 0,
    watch: Watch | None = None,
) -> Calibration:
    """Estimate the lens that all images share.

    Too little information is no error: such a calibration isn't accepted, and says why.

    Args:
        images: Of one camera, at least one.
        size: Width and height of the images in px.
        family: Lens family; ``None`` for the one that explains the lines best.
        seed: Of the draws of the uncertainty; the lens doesn't depend on it.
        watch: Told of the stages, and how much of each is done; may raise to cancel.

    Raises:
        InvalidInput: If the size is no image's, the family unknown, or there is no image.
    """
    width, height = (int(side) for side in size)
    if min(width, height) < 2:
        raise InvalidInput(f"image size {width} x {height}", where="size", expected="width and height of 2 px and more")
    if max(width, height) > LONGEST_SHAPE * min(width, height):
        raise InvalidInput(
            f"{width} x {height} px is no camera's image",
            where="size",
            expected=f"sides of a ratio of at most {LONGEST_SHAPE}",
        )
    if family is not None and family not in FAMILY_NAMES:
        raise InvalidInput(f"unknown model {family!r:.40}", where="family", expected=", ".join(FAMILY_NAMES))
    if not images:
        raise InvalidInput("no image", where="images", expected="at least one")
    told = watch or _unwatched
    told("fitting", 0, 1)
    observed = observe_distinct(images, width, height)
    told("fitting", 1, 1)
    climbed = _best_family(observed, family, (width, height), told)
    solved = climbed.solved
    posterior = lens_posterior(observed, solved)
    told("leaving images out", 0, len(images))
    present = np.bincount(observed.image, minlength=len(images)) > 0
    changes = left_out_changes(observed, solved, len(images))
    told("leaving images out", len(images), len(images))
    believed = [weighed(observed, solved, image, number) for number, image in enumerate(images)]
    told("focal length", 0, 1)
    known = LensUncertainty(solved.names, posterior.released)
    focal = estimate_focal(believed, solved.lens, uncertain=known, seed=seed)
    told("free model", 0, 1)
    free = fit_free_model(believed, solved.lens, seed=seed)
    told("free model", 1, 1)

    draws = error_draws(posterior, seed)
    several = int(present.sum()) > 1
    jackknife = jackknife_error(changes, solved, present) if several else None
    uncertainty = _uncertainty(solved.lens, posterior, draws, jackknife)
    lines = tuple(line_residuals(observed, solved, image, number) for number, image in enumerate(images))
    straight = solved.lines.straight >= STRAIGHT
    unusable = left_out(images, width, height)
    reasons = _reasons(uncertainty, int(straight.sum()), len(observed), half_diagonal(width, height))
    if 2 * unusable.outside.sum() > len(unusable.outside):
        reasons.append(outside_frame(unusable, width, height))
    return Calibration(
        lens=solved.lens,
        released=solved.names,
        covariance=posterior.released,
        accepted=not reasons,
        reasons=tuple(reasons),
        warnings=(
            *warnings_of(observed, solved, posterior, uncertainty),
            *warnings_of_left_out(unusable, width, height),
            *([] if reasons else warnings_of_size(uncertainty)),
        ),
        ladder=climbed.rungs,
        uncertainty=uncertainty,
        map=displacement_map(solved.lens, observed, draws),
        counts={
            "images": len(images),
            "segments": sum(len(image.segments) for image in images),
            "used": len(observed),
            "inliers": int(straight.sum()),
            "points": int(observed.points.sum()),
        },
        noise=float(np.median(believed_roughness(observed))) if len(observed) else 0.0,
        brown=refit_brown(solved.lens, width, height, solved.lens.center),
        images=image_fits(images, lines, shifts(changes, solved), several),
        focal=focal.as_dict(),
        free=free.as_dict(),
        seed=seed,
        lines=lines,
    )


def _best_family(observed: LineObservations, family: Family | None, size: tuple[int, int], watch: Watch) -> Climbed:
    families = FAMILY_NAMES if family is None else (family,)
    folds, start = folds_of(observed), start_lens(observed, *size)
    climbed: list[Climbed] = []
    for number, name in enumerate(families):
        watch("ladder", number, len(families))
        climbed.append(climb(observed, name, start, folds, lambda n=number: watch("ladder", n, len(families))))
    watch("ladder", len(families), len(families))
    best = min(climbed, key=lambda each: _cost(each, len(observed)))
    others = tuple(rung for each in climbed if each is not best for rung in each.rungs)
    return Climbed(best.solved, best.rungs + others, best.held_out)


def _cost(climbed: Climbed, lines: int) -> float:
    """Return what families are compared by: in nats, the mean of what the lines say seen and unseen."""
    cost = climbed.solved.penalised
    if climbed.held_out is not None:
        cost = 0.5 * (cost + climbed.held_out * lines)
    return cost - (DIVISION_ADVANTAGE if climbed.solved.lens.family == "division" else 0.0)


def _uncertainty(
    lens: CameraLens, posterior: LensPosterior, draws: NDArray[np.float64], jackknife: float | None
) -> CalibrationUncertainty:
    errors = field_errors(draws, field_sensitivity(lens))
    unchanged = CameraLens.identity(lens.family, lens.width, lens.height)
    return CalibrationUncertainty(
        pred=float(np.sqrt(np.mean(errors**2))),
        bound95=float(np.quantile(errors, COVERED)),
        correction=field_error(unchanged, lens, lens.width, lens.height).rms,
        jackknife=jackknife,
        effective_lines=_effective(posterior),
    )


def _effective(posterior: LensPosterior) -> float:
    """Return Kish's effective number of lines by what each tells."""
    told = posterior.information
    return float(told.sum() ** 2 / max((told**2).sum(), 1e-300)) if told.size else 0.0


def _reasons(uncertainty: CalibrationUncertainty, straight: int, used: int, scale: float) -> list[str]:
    if straight < FEWEST_LINES:
        return [f"not enough information: {straight} usable lines, at least {FEWEST_LINES} are needed"]
    if uncertainty.pred <= max(MOST_PREDICTED * uncertainty.correction, GOOD_ENOUGH * scale):
        return []
    if uncertainty.pred > scale:
        return [f"no lens of this model follows the lines: {straight} of {used} are straight under the best one"]
    return [
        f"not enough information: the expected error is {uncertainty.pred:.1f} px where the correction would be "
        f"{uncertainty.correction:.1f} px ({straight} lines)"
    ]


def _unwatched(stage: str, done: int, total: int) -> None:
    del stage, done, total
