"""Run by `discorpy_peer` in an environment that has discorpy: lenses of chessboards, each from one photo.

python discorpy_worker.py BOARDS.npy: float64 (N, rows, columns, 2) in px. Prints a JSON list, by photo, of
[xc, yc, factors] or null.
"""

from __future__ import annotations

import json
import sys
import warnings

import numpy as np
from discorpy.proc import processing  # pyright: ignore[reportMissingImports]

FACTORS = 3


def main() -> None:
    warnings.simplefilter("ignore")
    found: list[list[object] | None] = []
    for corners in np.load(sys.argv[1]):
        # discorpy's points are (y, x)
        lying, upright = ([line[:, ::-1] for line in lines] for lines in (corners, np.swapaxes(corners, 0, 1)))
        try:
            xc, yc = processing.find_cod_coarse(lying, upright)
            lying, upright = processing.correct_perspective_effect(lying, upright, xc, yc)
            factors = processing.calc_coef_backward(lying, upright, xc, yc, FACTORS)
            found.append([float(xc), float(yc), [float(factor) for factor in factors]])
        except (np.linalg.LinAlgError, ValueError, IndexError):
            found.append(None)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
