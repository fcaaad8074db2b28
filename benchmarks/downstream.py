"""What a better lens is worth to whoever comes after: the epipolar geometry of two views, with and without it.

python benchmarks/downstream.py [--json] [--kitti DIR] [--pairs N] [--plot FILE.svg]

Features of two images are matched once, as measured; each lens moves the matched points, a fundamental matrix is fitted
by OpenCV, and the distance of all matches from their epipolar lines is stated in px of the measured images. Intervals
are paired: over the same pairs of images, drawn anew 2,000 times.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from shared.bootstrap import interval
from shared.epipolar import CLOSE, EpipolarErrors, Lens, Matches, PoseError, epipolar_errors, match, pose_error
from shared.lens_photos import Photo, kitti_frames
from shared.lens_reviewed import reviewed
from shared.reporting import Target, argument_parser, finish, show_table
from shared.street_pairs import LENSES, StreetPair, lens_named, street_pairs
from shared.svg_chart import Curve, write_chart

from app.calibration.calibrate import calibrate
from app.calibration.calibration_image import CalibrationImage
from app.images import decode_gray
from app.vision import DetectionParameters, detect_for_prelabel, estimate_distortion
from app.vision.brown import Brown
from app.vision.conversion import OpenCVLens
from app.vision.frame import center_of, half_diagonal
from app.vision.intensity import to_eight_bit

NAMES = ("none", "candidates", "reviewed", "reference")
FEWEST_MATCHES = 100
TURNED = 60.0
"""px; median way of the matches from which a pair of frames counts as taken in a turn."""
BANDS, FEWEST_IN_BAND = 6, 20
"""Of the distance from the image centre, in the chart; matches from which a share is drawn."""
TARGETS = (
    Target("kitti_turning_reviewed_gain_low", 0.0, at_most=False),
    Target("synthetic_reviewed_gain_low", 0.0, at_most=False),
    Target("synthetic_reviewed_against_reference", 1.15),
)


@dataclass(frozen=True, eq=False)
class Pair:
    """Two views with what each lens makes of them.

    Attributes:
        matches: Of the two images.
        errors: By lens.
        poses: By lens; empty where the true pose isn't known.
    """

    matches: Matches
    errors: Mapping[str, EpipolarErrors]
    poses: Mapping[str, PoseError]

    @property
    def moved(self) -> float:
        """Median way of the matches between the images, px."""
        return float(np.median(np.hypot(*(self.matches.first - self.matches.second).T)))


def lenses_of(photos: Mapping[str, Photo]) -> dict[str, Lens]:
    """Estimate the lens that photos share, from all candidates and from those that a reviewer would keep."""
    first = next(iter(photos.values()))
    width, height = first.width, first.height
    candidates = estimate_distortion([photo.segments for photo in photos.values()], (width, height)).brown
    images = [CalibrationImage(name, photo.segments) for name, photo in reviewed(photos).items()]
    return {
        "none": Brown.identity(width, height),
        "candidates": candidates,
        "reviewed": calibrate(images, (width, height)).lens,
        "reference": first.truth,
    }


def kitti_pairs(folder: Path) -> list[Pair]:
    """Measure each two frames of the sequence that follow each other or are two apart, if they show the same."""
    photos = kitti_frames(folder)
    if not photos:
        return []
    lenses = lenses_of(photos)
    grey = [to_eight_bit(decode_gray((folder / "images" / f"{name}.png").read_bytes())) for name in photos]
    return [
        Pair(matches, {name: epipolar_errors(matches, lens) for name, lens in lenses.items()}, {})
        for apart in (1, 2)
        for first, second in zip(grey, grey[apart:], strict=False)
        if len(matches := match(first, second)) >= FEWEST_MATCHES
    ]


def synthetic_pairs(name: str, count: int) -> Iterator[Pair]:
    """Measure pairs of views through one of the known lenses, estimated from the first view of each pair."""
    lens = lens_named(name)
    truth = OpenCVLens(lens.matrix, lens.coefficients)
    pairs: list[StreetPair] = list(street_pairs(lens, count, 1000))
    photos = {
        f"{index:03}": Photo(
            detect_for_prelabel(pair.first, DetectionParameters()).lens_segments, truth, lens.width, lens.height
        )
        for index, pair in enumerate(pairs)
    }
    lenses = lenses_of(photos)
    for pair in pairs:
        matches = match(pair.first, pair.second)
        if len(matches) >= FEWEST_MATCHES:
            yield Pair(
                matches,
                {key: epipolar_errors(matches, each) for key, each in lenses.items()},
                {key: pose_error(matches, each, lens.matrix, pair.rotation, pair.way) for key, each in lenses.items()},
            )


def show_epipolar(title: str, pairs: Sequence[Pair], prefix: str) -> dict[str, float | None]:
    """Print error and inliers by lens with what each gains over no correction; return them as figures."""
    if not pairs:
        return {}
    figures: dict[str, float | None] = {f"{prefix}_pairs": float(len(pairs))}
    rows: list[list[str]] = []
    plain = np.array([pair.errors["none"].median for pair in pairs])
    for name in NAMES:
        errors = np.array([pair.errors[name].median for pair in pairs])
        inliers = np.array([pair.errors[name].inliers for pair in pairs])
        low, high = interval(_weighted_median(plain - errors), len(pairs), resamples=2000)
        median = float(np.median(errors))
        figures |= {
            f"{prefix}_{name}_median": median,
            f"{prefix}_{name}_inliers": float(np.mean(inliers)),
            f"{prefix}_{name}_gain_low": low,
        }
        gain = "" if name == "none" else f"{np.median(plain - errors):+.3f} ({low:+.3f} to {high:+.3f})"
        rows.append([name, f"{median:.3f}", f"{np.mean(inliers):.3f}", gain])
    columns = ["lens", "median error, px", "inliers at 1 px", "gained over none, px (95 %)"]
    show_table(f"{title}: {len(pairs)} pairs", columns, rows)
    return figures


def show_poses(pairs: Sequence[Pair]) -> dict[str, float | None]:
    """Print errors of the relative pose by lens; return them as figures."""
    figures: dict[str, float | None] = {}
    rows: list[list[str]] = []
    plain = np.array([pair.poses["none"] for pair in pairs])
    for name in NAMES:
        errors = np.array([pair.poses[name] for pair in pairs])
        row = [name]
        for column, part in enumerate(PoseError._fields):
            median = float(np.median(errors[:, column]))
            figures[f"synthetic_{name}_{part}"] = median
            low, high = interval(_weighted_median(plain[:, column] - errors[:, column]), len(pairs), resamples=2000)
            row += [f"{median:.3f}", "" if name == "none" else f"{low:+.3f} to {high:+.3f}"]
        rows.append(row)
    columns = ["lens", "rotation, deg", "gained (95 %)", "direction, deg", "gained (95 %)"]
    show_table(f"Relative pose of synthetic views, medians of {len(pairs)} pairs", columns, rows)
    return figures


def draw(path: Path, pairs: Sequence[Pair], width: int, height: int) -> None:
    """Draw the share of matches away from their epipolar lines against the distance from the image centre."""
    distance = np.concatenate([np.hypot(*(pair.matches.first - center_of(width, height)).T) for pair in pairs])
    band = np.minimum((distance / half_diagonal(width, height) * BANDS).astype(np.int64), BANDS - 1)
    enough = [number for number in range(BANDS) if (band == number).sum() >= FEWEST_IN_BAND]
    curves: list[Curve] = []
    for name in NAMES:
        away = np.concatenate([pair.errors[name].errors >= CLOSE for pair in pairs])
        shares = np.array([np.mean(away[band == number]) for number in enough], np.float64)
        curves.append(Curve(name, (np.array(enough, np.float64) + 0.5) / BANDS, shares))
    axes = ("distance from the image centre, half diagonals", f"share of matches beyond {CLOSE:.0f} px")
    write_chart(path, "Matches away from their epipolar lines, frames taken in a turn", axes, curves, [], 1.2)


def _weighted_median(values: NDArray[np.float64]) -> Callable[[NDArray[np.int64]], float]:
    """Return a statistic for `interval`: the median of values drawn so and so often."""
    return lambda weights: float(np.median(np.repeat(values, weights)))


def main() -> None:
    parser = argument_parser(str(__doc__), "kitti")
    parser.add_argument("--pairs", type=int, default=8, help="synthetic pairs of each lens")
    parser.add_argument("--plot", type=Path, help="where to draw the error by place, as SVG")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    kitti = kitti_pairs(options.kitti)
    turning = [pair for pair in kitti if pair.moved >= TURNED]
    figures = show_epipolar("KITTI, all", kitti, "kitti")
    figures |= show_epipolar("KITTI, in a turn", turning, "kitti_turning")
    everything: list[Pair] = []
    for name in LENSES:
        pairs = list(synthetic_pairs(name, options.pairs))
        figures |= show_epipolar(f"Synthetic, {name} lens", pairs, f"synthetic_{name}")
        everything += pairs
    figures |= show_epipolar("Synthetic, all", everything, "synthetic") | show_poses(everything)
    ratio = [pair.errors["reviewed"].median / pair.errors["reference"].median for pair in everything]
    figures["synthetic_reviewed_against_reference"] = float(np.median(ratio))
    if options.plot and turning:
        draw(options.plot, turning, 1300, 398)
    finish(figures, [target for target in TARGETS if target.figure in figures], as_json=options.json)


if __name__ == "__main__":
    main()
