"""The focal length from lines: error, honesty and the share of cameras that tell it, on drawn scenes and real images.

python benchmarks/focal_length.py [--json] [--york DIR] [--kitti DIR] [--scenes N]

"Wrong" counts estimates more than 3 sigma and 5 % from the truth. The photos of the York set were taken at 674.9 px
(published with that set); each was enlarged about its own lens's centre before it was warped, until it filled the
frame, which the truth here follows: it is good to about 1 %, so that is added to sigma there.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from shared.built_scenes import KINDS, Kind, draw_scene
from shared.lens_photos import Photo, kitti_frames
from shared.lens_reviewed import reviewed, york_labels
from shared.reporting import Target, argument_parser, finish, show_table

from app.calibration.calibrate import calibrate
from app.calibration.calibration_image import CalibrationImage
from app.calibration.focal_estimate import FocalEstimate
from app.calibration.focal_length import estimate_focal
from app.vision.field import apply_homography, best_homography
from app.vision.frame import frame_grid

YORK_FOCAL, YORK_TRUTH = 674.9, 0.01
"""px; share that the truth may be off."""
WRONG_SIGMA, WRONG_SHARE = 3.0, 0.05
TARGETS = (
    Target("square_within_95", 0.88, at_most=False),
    Target("square_observable", 0.9, at_most=False),
    Target("square_median_error", 0.01),
    Target("wrong", 0.0),
    Target("oblique_observable", 0.05),
    Target("single_observable", 0.0),
    Target("york_within_95", 0.88, at_most=False),
)


@dataclass(frozen=True)
class Told:
    """One camera's estimate beside the truth.

    Attributes:
        estimate: What was estimated.
        focal_length: The true one, px.
        slack: Share of it that it may be off itself.
        principal_point: The true one, px, where it is known.
        seconds: Of one core.
    """

    estimate: FocalEstimate
    focal_length: float
    slack: float = 0.0
    principal_point: tuple[float, float] | None = None
    seconds: float = 0.0

    @property
    def error(self) -> float:
        """Relative error."""
        return (self.estimate.focal_length or 0.0) / self.focal_length - 1

    @property
    def sigma(self) -> float:
        """Relative standard deviation as stated, with what the truth may be off."""
        return float(np.hypot((self.estimate.sigma or 0.0) / self.focal_length, self.slack))


def drawn(kind: Kind, scenes: int) -> list[Told]:
    """Estimate the focal length of drawn cameras with known lenses."""
    told: list[Told] = []
    for seed in range(scenes):
        scene = draw_scene(kind, seed)
        start = time.thread_time()
        estimate = estimate_focal(scene.images, scene.lens)
        seconds = time.thread_time() - start
        told.append(Told(estimate, scene.focal_length, 0.0, scene.principal_point, seconds))
    return told


def york(folder: Path) -> list[Told]:
    """Estimate it from the labelled lines of each photo, through the lens that the same lines give."""
    told: list[Told] = []
    for name, photo in york_labels(folder).items():
        corrected = photo.truth.undistort(frame_grid(photo.width, photo.height))
        away = np.abs(corrected - photo.truth.K[:2, 2]) / [(photo.width - 1) / 2, (photo.height - 1) / 2]
        told.append(_told({name: photo}, YORK_FOCAL * float(away.max()), YORK_TRUTH))
    return told


def _told(photos: dict[str, Photo], focal_length: float, slack: float) -> Told:
    """Estimate it with the lens; the truth is carried from the true undistorted image to the one that is estimated.

    Lines tell a lens up to a homography only, so the estimated image may be larger than the true one, and its focal
    length with it.
    """
    first = next(iter(photos.values()))
    found = calibrate(
        [CalibrationImage(name, photo.segments) for name, photo in photos.items()], (first.width, first.height)
    )
    grid = frame_grid(first.width, first.height)
    homography = best_homography(first.truth.undistort(grid), found.lens.undistort(grid))
    around = np.add(first.truth.K[:2, 2], [[-0.5, 0], [0.5, 0], [0, -0.5], [0, 0.5]])
    left, right, above, below = apply_homography(homography, around)
    scale = float(np.sqrt(abs(np.linalg.det(np.stack([right - left, below - above])))))
    return Told(FocalEstimate.from_dict(found.focal or {}), focal_length * scale, slack)


def kitti(folder: Path) -> list[Told]:
    """Estimate it jointly, and from each five frames that follow each other; the pixels there aren't quite square."""
    photos = kitti_frames(folder)
    if not photos:
        return []
    kept = reviewed(photos)
    names = list(kept)
    groups = [names, *(names[start : start + 5] for start in range(0, len(names), 5))]
    truth = float(np.sqrt(np.prod(np.diag(next(iter(photos.values())).truth.K)[:2])))
    return [_told({name: kept[name] for name in group}, truth, 0.0) for group in groups]


def show(sets: dict[str, list[Told]]) -> dict[str, float | None]:
    """Print a row for each set; return its figures."""
    figures: dict[str, float | None] = {"wrong": 0.0}
    rows: list[list[str]] = []
    for name, told in sets.items():
        clear = [each for each in told if each.estimate.observable]
        ratio = np.array([abs(each.error) / each.sigma for each in clear])
        errors, sigmas = (np.array([abs(getattr(each, part)) for each in clear]) for part in ("error", "sigma"))
        wrong = int(((ratio > WRONG_SIGMA) & (errors > WRONG_SHARE)).sum())
        figures["wrong"] = (figures["wrong"] or 0.0) + wrong
        figures |= {
            f"{name}_observable": len(clear) / len(told),
            f"{name}_median_error": float(np.median(errors)) if len(clear) else None,
            f"{name}_median_sigma": float(np.median(sigmas)) if len(clear) else None,
            f"{name}_within_95": float(np.mean(ratio < 1.96)) if len(clear) else None,
            f"{name}_seconds": float(np.max([each.seconds for each in told])),
        }
        shown = [f"{100 * np.median(values):.2f}" if len(clear) else "-" for values in (errors, sigmas)]
        inside = f"{np.mean(ratio < 1.96):.2f}" if len(clear) else "-"
        largest = f"{100 * errors.max():.1f}" if len(clear) else "-"
        rows.append([name, f"{len(clear)} / {len(told)}", *shown, largest, inside, str(wrong)])
    columns = ["images", "observable", "error %, median", "sigma %, median", "largest error %", "in 95 %", "wrong"]
    show_table("Focal length", columns, rows)
    return figures


def show_centers(told: Sequence[Told]) -> dict[str, float | None]:
    """Print how principal points are told; return the share within their interval."""
    ratios = [
        (found - true) / sigma
        for each in told
        if each.estimate.principal_point and each.estimate.principal_point_sigma and each.principal_point
        for found, true, sigma in zip(
            each.estimate.principal_point, each.principal_point, each.estimate.principal_point_sigma, strict=True
        )
    ]
    share = float(np.mean(np.abs(ratios) < 1.96)) if ratios else None
    print(f"principal point told by {len(ratios) // 2} of {len(told)} square cameras; in its 95 % interval: {share}")
    return {"principal_point_within_95": share, "principal_point_told": len(ratios) / 2 / max(len(told), 1)}


def show_reasons(sets: dict[str, list[Told]]) -> None:
    """Print why focal lengths aren't observable."""
    for name, told in sets.items():
        reasons = Counter(str(each.estimate.reason) for each in told if not each.estimate.observable)
        for reason, count in reasons.most_common(4):
            print(f"{name}, {count}: {reason}")


def main() -> None:
    parser = argument_parser(str(__doc__), "york", "kitti")
    parser.add_argument("--scenes", type=int, default=60, help="drawn cameras of each kind")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    sets: dict[str, list[Told]] = {kind: drawn(kind, options.scenes) for kind in KINDS}
    sets |= {name: told for name, told in (("york", york(options.york)), ("kitti", kitti(options.kitti))) if told}
    figures = show(sets) | show_centers(sets["square"])
    show_reasons(sets)
    finish(figures, [target for target in TARGETS if target.figure in figures], as_json=options.json)


if __name__ == "__main__":
    main()
