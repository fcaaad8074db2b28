from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from app.formats.inert_npy import read_label_arrays

YORK = Path(__file__).parents[2].parent / "shared" / "data" / "york"


@pytest.fixture(scope="session")
def york_lines() -> dict[str, list[NDArray[np.float64]]]:
    """Hand-drawn labels of 51 photos, by name, in the precision of their files."""
    files = sorted(YORK.glob("labels/*_edge_segments_filtered.npy"))
    if not files:
        pytest.skip("the York Urban labels aren't there")
    return {
        file.name.split("_")[0]: [line.reshape(-1, 2).astype(float) for line in read_label_arrays(file.read_bytes())]
        for file in files
    }


def line(length: float, angle: float = 0.0, center: tuple[float, float] = (500.0, 500.0)) -> NDArray[np.float64]:
    """A straight line of points 1 px apart; angle in degrees."""
    along = np.linspace(-length / 2, length / 2, round(length) + 1)
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    return np.array(center) + along[:, None] * direction


@pytest.fixture(name="line", scope="session")
def line_fixture():
    return line
