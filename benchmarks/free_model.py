"""The free model: what it finds of fields that are there, how honest it is, and how many lines it takes.

python benchmarks/free_model.py [--json] [--draws N]

Straight lines of 80 to 400 px with 0.1 px of noise, seen through a lens with a drawn smooth field on top, or none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shared.reporting import Target, argument_parser, finish, show_table

from app.calibration.bspline import SplineGrid
from app.calibration.calibration_image import CalibrationImage
from app.calibration.free_model import FreeModel, fit_free_model
from app.calibration.lens import CameraLens
from app.vision.field import homography_fields
from app.vision.frame import center_of, frame_grid
from app.vision.segments import Segments

Array = NDArray[np.float64]

WIDTH, HEIGHT, NOISE, IMAGES = 1280, 720, 0.1, 8
LENS = CameraLens("division", WIDTH, HEIGHT, (0.12, 0.02, 0.0, 0.01, -0.01))
COARSE = SplineGrid(WIDTH, HEIGHT, 7, 5)
"""Knots of the drawn fields, other ones than those of the fit."""
SIZES, LINES = (0.0, 0.25, 0.5, 1.0), (40, 80, 160, 400, 1000)
TARGETS = (
    Target("used_without_field", 0.02),
    Target("within_sigma", 0.6, at_most=False),
    Target("within_two_sigma", 0.9, at_most=False),
    Target("used_of_1px_at_400", 0.9, at_most=False),
)


@dataclass(frozen=True, eq=False)
class Trial:
    """One fit: the field's size, the lines, the answer, and the error where the field is known; px RMS."""

    size: float
    lines: int
    model: FreeModel
    error: float


def draw_field(size: float, rng: np.random.Generator) -> Array:
    """Return coefficients ``(C, 2)`` of a field of `size` px RMS of what no homography can do."""
    coefficients = rng.normal(0, 1, (COARSE.size, 2))
    field = observable(COARSE.basis(frame_grid(WIDTH, HEIGHT)) @ coefficients, frame_grid(WIDTH, HEIGHT))
    return size * coefficients / float(np.sqrt((field**2).sum(1).mean()))


def observable(field: Array, places: Array) -> Array:
    """Take out of a field ``(N, 2)`` at places what a homography can do."""
    corrected = (LENS.undistort(places) - center_of(WIDTH, HEIGHT)) / LENS.scale
    basis, _ = np.linalg.qr(homography_fields(corrected))
    flat = field.T.ravel()
    return (flat - basis @ (basis.T @ flat)).reshape(2, -1).T


def draw_line(coefficients: Array, rng: np.random.Generator) -> Array | None:
    """Return a straight line's points as the lens with its field shows them, ``None`` where too few are seen."""
    angle, half = rng.uniform(0, np.pi), rng.uniform(40, 200)
    along = np.array([np.cos(angle), np.sin(angle)])
    middle = LENS.undistort(rng.uniform(0, 1, (1, 2)) * [WIDTH - 1, HEIGHT - 1])
    straight = middle + np.arange(-half, half)[:, None] * along
    seen = LENS.distort(straight)
    for _ in range(4):
        seen = LENS.distort(straight - COARSE.basis(np.nan_to_num(seen)) @ coefficients)
    kept = np.isfinite(seen).all(1) & ((seen >= 0) & (seen < [WIDTH, HEIGHT])).all(1)
    if kept.sum() < 60:
        return None
    return seen[kept] + rng.normal(0, NOISE, int(kept.sum()))[:, None] * [-along[1], along[0]]


def run(size: float, lines: int, seed: int) -> Trial:
    """Draw a field and lines, fit, and compare."""
    rng = np.random.default_rng([seed, lines, round(100 * size)])
    coefficients = draw_field(size, rng)
    images: list[CalibrationImage] = []
    for index in range(IMAGES):
        drawn: list[Array] = []
        while len(drawn) < lines // IMAGES:
            line = draw_line(coefficients, rng)
            if line is not None:
                drawn.append(line)
        images.append(CalibrationImage(str(index), Segments.from_list(drawn)))
    model = fit_free_model(images, LENS)
    places = np.stack(np.meshgrid(model.x, model.y), -1).reshape(-1, 2)
    found = np.stack([np.ravel(model.dx), np.ravel(model.dy)], -1)
    away = found - observable(COARSE.basis(places) @ coefficients, places)
    return Trial(size, lines, model, float(np.sqrt((away**2).sum(1).mean())))


def main() -> None:
    parser = argument_parser(str(__doc__))
    parser.add_argument("--draws", type=int, default=6, help="fields of each size and number of lines")
    options = parser.parse_args()
    trials = [run(size, lines, seed) for size in SIZES for lines in LINES for seed in range(options.draws)]
    rows: list[list[str]] = []
    figures: dict[str, float | None] = {}
    for size in SIZES:
        for lines in LINES:
            some = [trial for trial in trials if (trial.size, trial.lines) == (size, lines)]
            error, sigma, needed = (
                float(np.median(values))
                for values in zip(*((t.error, t.model.sigma or np.inf, t.model.needed) for t in some), strict=True)
            )
            used = float(np.mean([trial.model.used for trial in some]))
            figures[f"used_of_{size:g}px_at_{lines}"] = used
            rows.append([f"{size:g}", str(lines), f"{error:.3f}", f"{sigma:.3f}", f"{needed:.0f}", f"{used:.2f}"])
    columns = ["field, px", "lines", "error, px", "stated sigma, px", "needed", "used"]
    show_table(f"Free model, medians of {options.draws} draws", columns, rows)
    ratios = np.array([trial.error / (trial.model.sigma or np.inf) for trial in trials if trial.size > 0])
    figures |= {
        "used_without_field": float(np.mean([trial.model.used for trial in trials if trial.size == 0])),
        "within_sigma": float(np.mean(ratios < 1)),
        "within_two_sigma": float(np.mean(ratios < 2)),
    }
    finish(figures, TARGETS, as_json=options.json)


if __name__ == "__main__":
    main()
