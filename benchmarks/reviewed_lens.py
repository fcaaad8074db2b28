"""The lens from reviewed lines: field error against peers and bounds, honesty of the stated uncertainty, time.

python benchmarks/reviewed_lens.py [--json] [--york DIR] [--kitti DIR] [--carnd DIR] [--cameras N] [--bounded N]

Field errors are px RMS over the frame, after the best homography. Reviewed are, of KITTI, York and the road frames,
those candidates of the pipeline that are straight under the true lens; of the chessboards, rows and columns. York is
judged twice: by candidates, which have the photos' own lens of about 1.3 px in them, and by labels, which were computed
through the lens and have no noise.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from shared.discorpy_peer import discorpy_lenses
from shared.lens_chessboards import Board, bootstrap_calibrations, calibrate_boards, read_boards
from shared.lens_compared import Compared, compare, error, inner_grid
from shared.lens_photos import Photo, carnd_frames, kitti_frames, york_photos
from shared.lens_reviewed import reviewed, york_labels
from shared.peers import PeersUnavailable
from shared.reporting import Target, argument_parser, finish, show_table
from shared.reviewed_lines import ReviewConditions, draw_reviewed_camera, draw_reviewed_lines, draw_true_lens

from app.calibration.calibrate import CalibrationImage, calibrate
from app.calibration.cramer_rao import least_field_error
from app.calibration.lens import FAMILIES, FAMILY_NAMES, CameraLens, Family
from app.vision.field import Lens
from app.vision.frame import frame_grid

TARGETS = (
    Target("boards_inner_over_allowed", 1.0),
    Target("bounded_ratio_largest", 1.3),
    Target("synthetic_within_bound", 0.90, at_most=False),
    Target("synthetic_within_bound", 0.99),
    Target("kitti_jointly_median", 1.5),
    Target("seconds_of_15_images", 2.0),
)
BOOTSTRAPS = 30
MODELS = (("k1",), ("k1", "k2"), ("k1", "k2", "cx", "cy"))
SIZE = 1280, 720


def groups(photos: dict[str, Photo], *, jointly: bool = False) -> list[Compared]:
    """Compare a set of photos, one by one or as images of one camera."""
    parts = [list(photos.values())] if jointly else [[photo] for photo in photos.values()]
    return [compare([photo.segments for photo in part], part[0].truth, part[0].width, part[0].height) for part in parts]


def real(york: Path, kitti: Path, carnd: Path) -> dict[str, list[Compared]]:
    """Compare every set of real images that is there."""
    sets: dict[str, list[Compared]] = {}
    if frames := kitti_frames(kitti):
        kept = reviewed(frames)
        sets |= {"kitti_jointly": groups(kept, jointly=True), "kitti_singles": groups(kept)}
    if photos := york_photos(york):
        sets["york_singles"] = groups({name: reviewed({name: photo})[name] for name, photo in photos.items()})
        sets["york_labels"] = groups(york_labels(york))
    if frames := carnd_frames(carnd):
        sets["carnd_road_jointly"] = groups(reviewed(frames), jointly=True)
    return sets


def synthetic(cameras: int) -> list[Compared]:
    """Compare drawn cameras whose lenses are of many kinds."""
    found: list[Compared] = []
    for seed in range(cameras):
        camera = draw_reviewed_camera(seed)
        found.append(compare(camera.segments, camera.lens, camera.lens.width, camera.lens.height))
    return found


def boards(folder: Path) -> dict[str, float | None]:
    """Print and return how far our lens of a chessboard's lines is from the board's own calibration."""
    seen = [board for board in read_boards(folder / "chessboards") if board.size == SIZE]
    if not seen:
        return {}
    reference, grid = calibrate_boards(seen, SIZE), inner_grid(*SIZE)
    spread = [error(reference, lens, grid) for lens in bootstrap_calibrations(seen, SIZE, BOOTSTRAPS, seed=0)]
    found = compare([board.lines for board in seen], reference, *SIZE)
    allowed = 0.5 + float(np.sqrt(np.mean(np.square(spread))))
    peer = _discorpy_inner(seen, reference, grid)
    columns = ["CarND chessboards", "identity", "plumb line", "ours", "inner 80 %", "discorpy", "bootstrap", "bound"]
    figures = [found.identity, found.plumb_line, found.ours, found.inner, peer, allowed - 0.5, found.bound]
    show_table("Against cv2.calibrateCamera", columns, [[f"{len(seen)} photos", *(f"{each:.2f}" for each in figures)]])
    return {
        "boards_inner": found.inner,
        "boards_bootstrap": allowed - 0.5,
        "boards_inner_over_allowed": found.inner / allowed,
    }


def _discorpy_inner(seen: Sequence[Board], reference: Lens, grid: NDArray[np.float64]) -> float:
    """Return discorpy's median error in the inner 80 %, over the photos that it makes something of."""
    try:
        lenses = discorpy_lenses([board.corners for board in seen])
    except PeersUnavailable as reason:
        print(f"discorpy isn't available: {reason}")
        return float("nan")
    errors = [error(reference, lens, grid) for lens in lenses if lens is not None]
    print(f"discorpy found a lens in {len(errors)} of {len(seen)} photos, each by itself")
    return _median(errors)


def bounded(cameras: int) -> dict[str, float | None]:
    """Print and return errors over the bound of Cramer and Rao: 40 lines of 100 to 400 px with 0.1 px of noise."""
    figures: dict[str, float | None] = {}
    rows: list[list[str]] = []
    for family in FAMILY_NAMES:
        for model in MODELS:
            errors, bounds = np.array([_against_bound(family, model, seed) for seed in range(cameras)]).T
            ratio = float(np.sqrt(np.mean(errors**2) / np.mean(bounds**2)))
            figures[f"bounded_{family}_{'_'.join(model)}"] = ratio
            sizes = (float(np.sqrt(np.mean(each**2))) for each in (errors, bounds))
            rows.append([f"{family}: {', '.join(model)}", *(f"{each:.3f}" for each in sizes), f"{ratio:.2f}"])
    show_table(f"RMS error over {cameras} cameras", ["true lens", "ours", "bound of the model used", "ratio"], rows)
    return figures | {"bounded_ratio_largest": max(ratio for ratio in figures.values() if ratio is not None)}


def _against_bound(family: Family, model: Sequence[str], seed: int) -> tuple[float, float]:
    """Return the error and the bound of the parameters that were released, px RMS."""
    rng = np.random.default_rng([seed, len(model), FAMILY_NAMES.index(family)])
    sign, strongest = (-1.0, 0.12) if family == "opencv" else (1.0, 0.25)
    drawn = {
        "k1": sign * rng.uniform(0.05, strongest),
        "k2": -sign * rng.uniform(0.01, 0.03),
        "cx": rng.normal(0, 0.02),
        "cy": rng.normal(0, 0.02),
    }
    values = tuple(float(drawn[name]) if name in model else 0.0 for name in FAMILIES[family].names)
    lens = CameraLens(family, *SIZE, values)
    segments, _ = draw_reviewed_lines(rng, lens, ReviewConditions(4, 40, 0.0, 0.1, 0.0, (100.0, 400.0)))
    found = calibrate([CalibrationImage(str(i), each) for i, each in enumerate(segments)], SIZE, family=family)
    return error(lens, found.lens, frame_grid(*SIZE)), least_field_error(lens, found.released, segments, 0.1)


def timed() -> dict[str, float | None]:
    """Return the processor time for 15 images with 100 lines each, ladder of all families and leave-one-out."""
    rng = np.random.default_rng(5)
    lens = draw_true_lens(rng, "opencv", *SIZE)
    segments, _ = draw_reviewed_lines(rng, lens, ReviewConditions(15, 1500, 0.02, 0.1, 1.5))
    images = [CalibrationImage(str(i), each) for i, each in enumerate(segments)]
    moments: list[tuple[str, float]] = [("start", time.thread_time())]

    def watch(stage: str, done: int, total: int) -> None:
        del done, total
        moments.append((stage, time.thread_time()))

    calibrate(images, SIZE, watch=watch)
    start, focal = moments[0][1], next(moment for stage, moment in moments if stage == "focal length")
    print(f"15 images of 100 lines: {focal - start:.2f} s of one core, then focal length and free model")
    return {"seconds_of_15_images": focal - start}


def show(sets: dict[str, list[Compared]]) -> dict[str, float | None]:
    """Print errors and honesty by set; return them as figures."""
    figures: dict[str, float | None] = {}
    rows: list[list[str]] = []
    for name, compared in sets.items():
        ours = np.array([each.ours for each in compared])
        found = {
            "identity": _median(each.identity for each in compared),
            "msac": _median(each.msac for each in compared),
            "plumb_line": _median(each.plumb_line for each in compared),
            "median": float(np.median(ours)),
            "p90": float(np.quantile(ours, 0.9)),
            "largest": float(ours.max()),
            "accepted_share": float(np.mean([each.accepted for each in compared])),
            "within_bound": float(np.mean([each.ours <= each.bound for each in compared])),
            "cells_within_bound": float(np.mean([each.cells for each in compared])),
            "median_over_pred": _median(each.ours / max(each.pred, 1e-9) for each in compared),
        }
        figures |= {f"{name}_{key}": value for key, value in found.items()}
        rows.append([name.replace("_", " "), *(f"{value:.2f}" for value in found.values())])
    columns = ["", "identity", "MSAC", "plumb line", "ours", "p90", "max", "accepted", "<= bound", "cells", "/ pred"]
    show_table("Field error, px RMS: medians; shares", columns, rows)
    return figures


def _median(values: Iterable[float]) -> float:
    finite = [value for value in values if np.isfinite(value)]
    return float(np.median(finite)) if finite else float("nan")


def main() -> None:
    parser = argument_parser(str(__doc__), "york", "kitti", "carnd")
    parser.add_argument("--cameras", type=int, default=100, help="synthetic cameras to draw")
    parser.add_argument("--bounded", type=int, default=25, help="cameras per model for the bound of Cramer and Rao")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    sets = real(options.york, options.kitti, options.carnd)
    sets["synthetic"] = synthetic(options.cameras)
    figures = show(sets) | boards(options.carnd) | bounded(options.bounded) | timed()
    figures = {name: None if value is None or not np.isfinite(value) else value for name, value in figures.items()}
    finish(figures, [target for target in TARGETS if target.figure in figures], as_json=options.json)


if __name__ == "__main__":
    main()
