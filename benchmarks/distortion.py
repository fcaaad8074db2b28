"""The lens from raw candidates: field error, verdict and honesty, on real images and on synthetic cameras.

python benchmarks/distortion.py [--json] [--york DIR] [--kitti DIR] [--carnd DIR] [--cameras N]

Field errors are px RMS over the frame, after the best homography. "Identity" is no correction, "MSAC" the estimate as
in the paper; both are over all cameras, ours over the accepted ones. A photo of the York set carries about 1.3 px of
barrel distortion of its own beneath the lens that it is compared with. Lenses from reviewed lines, and other tools
beside them, are measured by reviewed_lens.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations

import cv2
from shared.lens_measure import Measured, honesty, measure, summary
from shared.lens_photos import Photo, carnd_frames, kitti_frames, york_photos
from shared.reporting import Target, argument_parser, finish, show_table

from app.synthesis.candidates import draw_camera
from app.vision.conversion import OpenCVLens

TARGETS = (
    Target("kitti_jointly_median", 1.5),
    Target("kitti_jointly_accepted_share", 1.0, at_most=False),
    Target("kitti_jointly_seconds_largest", 0.6),
    Target("kitti_singles_median", 2.5),
    Target("kitti_singles_p90", 5.0),
    Target("kitti_singles_accepted_share", 0.75, at_most=False),
    Target("york_singles_median", 1.8),
    Target("york_singles_p90", 3.6),
    Target("york_singles_accepted_share", 0.95, at_most=False),
    Target("york_singles_seconds_median", 0.1),
    Target("carnd_accepted", 0.0),
    Target("accepted_worse_than_identity", 0.0),
    Target("synthetic_within_two_pred", 0.85, at_most=False),
    Target("synthetic_within_pred", 0.85),
    Target("synthetic_within_pred", 0.50, at_most=False),
    Target("synthetic_median_ratio", 1.2),
    Target("synthetic_median_ratio", 0.4, at_most=False),
)


def measure_groups(photos: dict[str, Photo], groups: Iterable[Sequence[str]]) -> list[Measured]:
    """Estimate a lens from each group of images of one camera."""
    measured: list[Measured] = []
    for names in groups:
        first = photos[names[0]]
        segments = [photos[name].segments for name in names]
        measured.append(measure(segments, first.truth, first.width, first.height))
    return measured


def measure_synthetic(cameras: int) -> list[Measured]:
    """Estimate the lens of each of so many drawn cameras."""
    measured: list[Measured] = []
    for seed in range(cameras):
        camera = draw_camera(seed)
        truth = OpenCVLens(camera.lens.matrix, camera.lens.coefficients)
        measured.append(measure(camera.segments, truth, camera.lens.width, camera.lens.height))
    return measured


def measure_real(york: dict[str, Photo], kitti: dict[str, Photo], carnd: dict[str, Photo]) -> dict[str, list[Measured]]:
    """Measure every set of images that is there."""
    sets: dict[str, list[Measured]] = {}
    if kitti:
        sets["kitti_jointly"] = measure_groups(kitti, [list(kitti)])
        sets["kitti_singles"] = measure_groups(kitti, [[name] for name in kitti])
    if york:
        sets["york_singles"] = measure_groups(york, [[name] for name in york])
    if carnd:
        sets["carnd_singles"] = measure_groups(carnd, [[name] for name in carnd])
        sets["carnd_pairs"] = measure_groups(carnd, combinations(carnd, 2))
        sets["carnd_jointly"] = measure_groups(carnd, [list(carnd)])
    return sets


def show_errors(sets: dict[str, list[Measured]]) -> dict[str, float | None]:
    """Print errors, verdicts and times by set; return them as figures."""
    figures: dict[str, float | None] = {}
    rows: list[list[str]] = []
    for name, measured in sets.items():
        found = summary(measured)
        figures |= {f"{name}_{key}": value for key, value in found.items()}
        ours = [text(found[key]) for key in ("median", "p90", "largest")]
        rows.append(
            [
                name.replace("_", " "),
                text(found["identity_median"]),
                f"{text(found['msac_median'])} / {text(found['msac_p90'])}",
                " / ".join(ours),
                f"{sum(each.accepted for each in measured)} / {len(measured)}",
                text(found["accepted_worse_than_identity"], 0),
                f"{text(found['seconds_median'])} / {text(found['seconds_largest'])}",
            ]
        )
    columns = [
        "images",
        "identity",
        "MSAC: median / p90",
        "ours: median / p90 / max",
        "accepted",
        "worse",
        "s: med / max",
    ]
    show_table("Field error, px RMS, and time of fit and verdict", columns, rows)
    return figures


def show_honesty(sets: dict[str, list[Measured]]) -> dict[str, float | None]:
    """Print how errors compare with what was predicted of them; return it as figures."""
    figures: dict[str, float | None] = {}
    rows: list[list[str]] = []
    for name, measured in sets.items():
        row = [name.replace("_", " ")]
        for refused in (False, True):
            found = honesty(measured, refused_at_identity=refused)
            ending = "_with_refused" if refused else ""
            figures |= {f"{name}_{key}{ending}": value for key, value in found.items()}
            row += [
                text(found["number"], 0),
                *(text(found[key]) for key in ("within_pred", "within_two_pred", "median_ratio")),
            ]
        rows.append(row)
    columns = ["error / pred", "accepted", "<= 1", "<= 2", "median", "with refused", "<= 1", "<= 2", "median"]
    show_table("Honesty: share of errors within 1 and 2 pred; refused ones as no correction", columns, rows)
    return figures


def text(value: float | None, digits: int = 2) -> str:
    """Return a figure for the table."""
    return "-" if value is None else f"{value:.{digits}f}"


def main() -> None:
    parser = argument_parser(str(__doc__), "york", "kitti", "carnd")
    parser.add_argument("--cameras", type=int, default=200, help="synthetic cameras to draw")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    sets = measure_real(york_photos(options.york), kitti_frames(options.kitti), carnd_frames(options.carnd))
    sets["synthetic"] = measure_synthetic(options.cameras)
    figures = show_errors(sets) | show_honesty({name: found for name, found in sets.items() if "carnd" not in name})
    everything = [each for measured in sets.values() for each in measured]
    figures["accepted_worse_than_identity"] = summary(everything)["accepted_worse_than_identity"]
    road = [each for name, measured in sets.items() if "carnd" in name for each in measured]
    figures["carnd_accepted"] = float(sum(each.accepted for each in road))
    finish(figures, [target for target in TARGETS if target.figure in figures], as_json=options.json)


if __name__ == "__main__":
    main()
