"""The chart and the mosaics of the benchmarks."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import parse

import numpy as np
import pytest

from benchmarks.shared.mosaic import mirrored
from benchmarks.shared.svg_chart import BOTTOM, HEIGHT, LEFT, RIGHT, TOP, WIDTH, Curve, Mark, write_chart

SVG = "{http://www.w3.org/2000/svg}"


def test_a_chart_puts_the_ends_of_its_axes_at_the_ends_of_its_frame(tmp_path: Path) -> None:
    curve = Curve("a <b> & c", np.array([0.0, 1.0]), np.array([0.0, 0.5]))
    marks = [Mark("one", 0.5, 0.25), Mark("two", 0.5, 0.25)]
    write_chart(tmp_path / "chart.svg", "title", ("x", "y"), [curve], marks, highest=0.5)
    root = parse(tmp_path / "chart.svg").getroot()
    line = root.find(f"{SVG}polyline")
    assert line is not None
    assert line.get("points") == f"{LEFT}.0,{HEIGHT - BOTTOM}.0 {WIDTH - RIGHT}.0,{TOP}.0"
    words = {text.text: (text.get("x"), text.get("y")) for text in root.iter(f"{SVG}text")}
    assert "a <b> & c" in words
    assert words["one"] != words["two"], "names stand on one another"


def test_a_mosaic_has_no_seam() -> None:
    photo = np.tile(np.arange(0, 120, 10, dtype=np.uint8), (9, 1))
    mosaic = mirrored(photo, 40, 30)
    assert mosaic.shape == (30, 40)
    assert (mosaic[:9, :12] == photo).all()
    assert np.abs(np.diff(mosaic.astype(int), axis=1)).max() == 10
    assert not np.diff(mosaic.astype(int), axis=0).any()


def test_a_mosaic_smaller_than_its_photo_is_refused() -> None:
    with pytest.raises(ValueError, match="doesn't hold"):
        mirrored(np.zeros((9, 12), np.uint8), 11, 30)
