"""Plots say what they were given: places, classes, bands; and are whole SVG whatever they are given."""

from __future__ import annotations

import itertools
import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.calibration.lens import CameraLens
from app.calibration.plots.bars import BINS, histogram, image_bars
from app.calibration.plots.correlation import correlation_matrix
from app.calibration.plots.distortion_curve import distortion_curve, radial_shift
from app.calibration.plots.maps import map_plot
from app.calibration.plots.scales import COLORS, ColorScale, label, nice_ticks
from app.calibration.plots.straight_grid import straight_grid

SVG = "{http://www.w3.org/2000/svg}"
LENS = CameraLens("brown", 640, 480, (0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


def tree(svg: str) -> ElementTree.Element:
    return ElementTree.fromstring(svg)


def texts(svg: str) -> list[str]:
    return [element.text or "" for element in tree(svg).iter(f"{SVG}text")]


def luminance(color: str) -> float:
    """Relative luminance after WCAG 2."""
    channels = [int(color[first : first + 2], 16) / 255 for first in (1, 3, 5)]
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in channels]
    return float(np.dot(linear, [0.2126, 0.7152, 0.0722]))


def test_the_colours_keep_their_order_in_grey_print() -> None:
    steps = [luminance(color) for color in COLORS]
    contrasts = [(light + 0.05) / (dark + 0.05) for light, dark in itertools.pairwise(steps)]
    assert min(contrasts) > 1.25
    assert (steps[0] + 0.05) / (steps[-1] + 0.05) > 12


@given(st.floats(-1e5, 1e5), st.floats(1e-4, 1e5), st.integers(2, 8))
def test_ticks_are_even_and_cover_the_range(low: float, width: float, count: int) -> None:
    ticks = nice_ticks(low, low + width, count)
    slack = 1e-6 * width + 1e-9 * abs(low)
    assert ticks[0] <= low + slack
    assert ticks[-1] >= low + width - slack
    assert len(ticks) <= 2 * count + 3
    steps = np.diff(ticks)
    np.testing.assert_allclose(steps, steps[0], rtol=1e-6)


@pytest.mark.parametrize(
    ("value", "step", "expected"), [(2.5, 2.5, "2.5"), (40, 20, "40"), (-0.125, 0.025, "−0.125"), (0.2, 0.1, "0.2")]
)
def test_a_tick_has_the_decimals_it_needs(value: float, step: float, expected: str) -> None:
    assert label(value, step) == expected


def test_classes_hold_the_largest_value_and_the_middle_one_is_seen() -> None:
    even = ColorScale.up_to([0.2, 0.5, 0.9])
    assert even.bounds == pytest.approx((0, 0.2, 0.4, 0.6, 0.8, 1.0))
    assert even.color(0.1) == COLORS[0]
    assert even.color(0.9) == even.color(5.0) == COLORS[-1]
    uneven = ColorScale.up_to([1.0, 1.1, 1.2, 90.0])
    assert uneven.bounds[-1] == 100
    assert uneven.color(1.1) != uneven.color(4.0) != uneven.color(90.0)
    assert uneven.labels == ("0", "1", "2", "5", "10", "20", "50", "100")


def test_a_cell_lies_where_its_numbers_are_and_what_is_unknown_is_crossed() -> None:
    svg = map_plot([0, 50, 99], [0, 49], [[1, 2, None], [3, 4, 0]], (100, 50), title="t", empty="no line")
    cells = [cell.attrib for cell in tree(svg).find(f"{SVG}g") or []]
    scale = ColorScale.up_to([1, 2, 3, 4, 0])
    assert [cell["fill"] for cell in cells] == [scale.color(value) for value in (1, 2, 3, 4)]
    frame = next(cell.attrib for cell in tree(svg).iter(f"{SVG}rect") if cell.attrib.get("stroke") == "#1f2937")
    left, width = float(frame["x"]), float(frame["width"])
    assert float(cells[0]["x"]) == left
    assert float(cells[1]["x"]) == pytest.approx(left + width * 25.5 / 100, abs=0.02)
    crossed = next(element.attrib["d"] for element in tree(svg).iter(f"{SVG}path"))
    assert crossed.count("M") == 2
    assert {"px", "no line"} <= set(texts(svg))


def test_arrows_are_enlarged_by_a_round_factor_that_is_said() -> None:
    x, y = list(range(5, 120, 10)), [5, 15]
    field = [[0.4] * 12, [0.4] * 12]
    svg = map_plot(x, y, field, (120, 20), title="t", arrows=(field, [[0.0] * 12] * 2))
    assert "× 20" in texts(svg)  # the gap is 10 px, the longest displacement 0.4 px


def test_the_curve_is_the_polynomial_and_its_band_the_covariance() -> None:
    sigma = 0.01
    radius, shift, half = radial_shift(LENS, [[sigma**2]], ["k1"])
    unit = radius / LENS.scale
    np.testing.assert_allclose(shift, LENS.scale * 0.1 * unit**3, atol=1e-9)
    np.testing.assert_allclose(half, 1.96 * sigma * LENS.scale * unit**3, atol=1e-9)
    assert radius[-1] == pytest.approx(math.hypot(319.5, 239.5))


@pytest.mark.parametrize("family", ["brown", "opencv", "division"])
def test_a_curve_is_drawn_of_every_family_even_without_parameters(family: str) -> None:
    lens = CameraLens.identity(family, 640, 480)  # type: ignore[arg-type]
    assert "nan" not in distortion_curve(lens, np.zeros((0, 0)), [])
    folded = CameraLens("opencv", 640, 480, (-0.4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert "nan" not in distortion_curve(folded, np.diag([1e-4]), ["k1"])


def points_of(svg: str, stroke: str) -> list[np.ndarray]:
    found = [element.attrib for element in tree(svg).iter(f"{SVG}path") if element.attrib.get("stroke") == stroke]
    lines = [line for attributes in found for line in attributes["d"].split("M") if line]
    return [np.array([list(map(float, point.split())) for point in line.strip("Z").split("L")]) for line in lines]


def bend(points: np.ndarray) -> float:
    centered = points - points.mean(axis=0)
    return float(np.abs(centered @ np.linalg.svd(centered)[2][-1]).max())


def test_the_grid_bends_before_and_is_straight_after_the_correction() -> None:
    lines = [line for line in points_of(straight_grid(LENS), "#1b5fa8") if len(line) > 10]
    before = [bend(line) for line in lines if line[:, 0].max() < 328]
    after = [bend(line) for line in lines if line[:, 0].min() > 352]
    assert len(before) == len(after) >= 20
    assert max(before) > 2
    assert max(after) < 0.02  # two decimals are written


def test_no_lens_leaves_the_grid_straight() -> None:
    lines = points_of(straight_grid(CameraLens.identity("opencv", 640, 480)), "#1b5fa8")
    assert max(bend(line) for line in lines) < 0.02


def test_the_bars_count_and_the_last_one_has_the_rest() -> None:
    svg = histogram([0.1] * 90 + [0.5] * 110 + [99.0], title="RMS", what="lines", mark=0.2, mark_label="noise")
    bars = [bar.attrib for bar in tree(svg).iter(f"{SVG}rect")]
    heights = sorted(float(bar["height"]) for bar in bars)
    assert heights[1] / heights[0] == pytest.approx(111 / 90, abs=0.01)
    assert len(bars) == 2 < BINS
    assert "noise" in texts(svg)
    assert texts(histogram([], title="RMS", what="lines"))


def test_names_are_text_and_long_ones_keep_their_end() -> None:
    name = "<script>alert(1)</script>" + "x" * 60 + "/end"
    svg = image_bars([(name, 0.3, 3, 4), ("b", None, 0, 2)], noise=0.2)
    assert "<script" not in svg
    assert any(text.startswith("…") and text.endswith("/end") for text in texts(svg))
    assert {"no line counts", "3 of 4", "0 of 2"} <= set(texts(svg))
    assert "&lt;k1&gt;" in correlation_matrix(["<k1>", "b"], [[1, -0.5], [-0.5, 1]])
    assert "−0.00" not in correlation_matrix(["a", "b"], [[1, -0.001], [-0.001, 1]])


NUMBERS = st.none() | st.floats(0, 1e6) | st.just(float("nan"))


@given(st.lists(st.lists(NUMBERS, min_size=4, max_size=4), min_size=3, max_size=3), st.integers(1, 3000), st.text())
@settings(max_examples=60)
def test_a_map_is_whole_whatever_it_is_given(rows: list[list[float | None]], height: int, title: str) -> None:
    printable = "".join(character for character in title if character.isprintable())
    x = [0, 400, 800, 1199]
    y = [0.0, height / 2, float(height)]
    svg = map_plot(x, y, rows, (1200, height), title=printable, arrows=(rows, rows))
    assert not re.search(r'="[^"]*(nan|inf)', svg)
    assert tree(svg).findtext(f"{SVG}title") == printable
