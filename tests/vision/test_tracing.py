"""Walking along arcs: tracing, extension, de-duplication and quality share a scene of measured points."""

import numpy as np
import pytest

from app.vision.arcs import Arcs, fit_arcs
from app.vision.circle import moment_sums
from app.vision.duplicates import uncovered
from app.vision.extension import extend
from app.vision.filtering import qualities, scores
from app.vision.subpixel import EdgePoints
from app.vision.tracing import trace

SHAPE = (60, 160)


def passes(columns: np.ndarray, rows: np.ndarray, slope: float = 0.0) -> tuple[EdgePoints, EdgePoints]:
    """Measured points of an edge along x, and none along y."""
    index = np.full(SHAPE, -1, np.int32)
    index[np.rint(rows).astype(int), columns] = np.arange(len(columns))
    count = len(columns)
    ones = np.ones(count, np.int8)
    along_x = EdgePoints(0, columns, rows, np.full(count, slope), ones, np.full(count, 90, np.float32), index)
    none = np.zeros(0)
    along_y = EdgePoints(
        1,
        none.astype(np.int64),
        none,
        none,
        none.astype(np.int8),
        none.astype(np.float32),
        np.full(SHAPE, -1, np.int32),
    )
    return along_x, along_y


def lines(*rows_and_ends: tuple[float, float, float]) -> Arcs:
    """Arcs along rows: ``(y, x0, x1)``."""
    points = [np.stack([np.linspace(a, b, 40), np.full(40, y)], axis=1) for y, a, b in rows_and_ends]
    offsets = 40 * np.arange(len(points) + 1)
    origin, sums = moment_sums(np.concatenate(points), offsets)
    start, end = np.array([p[0] for p in points]), np.array([p[-1] for p in points])
    return fit_arcs(origin, sums, np.ones((len(points), 3)), start, end)


def walk(arcs: Arcs, points: tuple[EdgePoints, EdgePoints]):
    return trace(arcs, np.arange(len(arcs)), arcs.low, arcs.high, points)


def test_every_column_gives_the_point_measured_there() -> None:
    columns = np.arange(20, 61)
    rows = 30 + 0.3 * np.sin(columns)
    samples = walk(lines((30, 20, 60)), passes(columns, rows))
    assert samples.cells[:, 0].tolist() == columns.tolist()
    assert samples.points == pytest.approx(np.stack([columns, rows], axis=1))
    assert samples.distance == pytest.approx(rows - 30)
    assert samples.hit.all()
    assert samples.close.all()
    assert (samples.norm == 90).all()


def test_the_samples_follow_the_arcs_direction() -> None:
    columns = np.arange(20, 61)
    samples = walk(lines((30, 60, 20)), passes(columns, np.full(41, 30.0)))
    assert samples.cells[:, 0].tolist() == columns[::-1].tolist()
    assert (np.diff(samples.u) > 0).all()


def test_points_off_the_arc_or_in_another_direction_are_no_support() -> None:
    columns = np.arange(20, 61)
    assert not walk(lines((30, 20, 60)), passes(columns, np.full(41, 31.2))).hit.any()
    assert not walk(lines((30, 20, 60)), passes(columns, np.full(41, 30.0), slope=0.5)).hit.any()
    far = walk(lines((30, 20, 60)), passes(columns, np.full(41, 30.7)))
    assert far.hit.all()
    assert not far.close.any()


def test_beyond_the_image_there_is_nothing() -> None:
    samples = walk(lines((30, -20, 200)), passes(np.arange(160), np.full(160, 30.0)))
    assert samples.hit.sum() == 160


def test_an_arc_is_extended_over_small_gaps_and_stops_at_large_ones() -> None:
    columns = np.array([*range(20, 80), *range(83, 95), *range(100, 110)])
    arcs = extend(lines((30, 30, 60)), passes(columns, np.full(len(columns), 30.0)))
    x = [arcs.positions(slice(None), u)[0, 0] for u in (arcs.low, arcs.high)]
    # 30 px at most on either side; 80 to 82 are missing, 95 to 99 are too many
    assert x == pytest.approx([20, 90])
    longer = extend(lines((30, 30, 79)), passes(columns, np.full(len(columns), 30.0)))
    assert longer.positions(slice(None), longer.high)[0, 0] == pytest.approx(94)


def test_an_extension_needs_points_on_most_steps() -> None:
    columns = np.array([*range(30, 61), *range(64, 160, 4)])
    arcs = extend(lines((30, 30, 60)), passes(columns, np.full(len(columns), 30.0)))
    assert arcs.positions(slice(None), arcs.high)[0, 0] == pytest.approx(60)


def test_a_short_arc_is_not_extended() -> None:
    arcs = lines((30, 30, 50))
    extended = extend(arcs, passes(np.arange(160), np.full(160, 30.0)))
    assert extended.lengths.tolist() == arcs.lengths.tolist()


def _kept(arcs: Arcs, width: float = 1.4) -> list[list[int]]:
    edge = passes(np.arange(160), np.full(160, 30.0))
    samples = walk(arcs, edge)
    stays = uncovered(arcs, samples, arcs.lengths, width, SHAPE)
    columns = [samples.cells[stays & (samples.walk == i), 0] for i in range(len(arcs))]
    return [[int(c[0]), int(c[-1])] if len(c) else [] for c in columns]


def test_the_shorter_of_two_on_one_edge_goes() -> None:
    assert _kept(lines((30, 40, 80), (30.4, 20, 120))) == [[], [20, 120]]


def test_an_overlapping_end_is_trimmed() -> None:
    assert _kept(lines((30, 20, 120), (30.4, 100, 155))) == [[20, 120], [121, 155]]


def test_a_parallel_edge_two_pixels_away_stays() -> None:
    assert _kept(lines((30, 20, 120), (32, 20, 110))) == [[20, 120], [20, 110]]


def test_long_well_supported_and_straight_is_better() -> None:
    edge = passes(np.arange(160), np.full(160, 30.0))

    def quality(arcs: Arcs, points: tuple[EdgePoints, EdgePoints] = edge) -> float:
        samples = walk(arcs, points)
        return float(qualities(samples, samples.bounds(1), arcs.lengths)[0])

    good = quality(lines((30, 20, 120)))
    assert good == pytest.approx(0.5 * np.log(100) + 0.5 * np.log(90), abs=1e-6)
    assert quality(lines((30, 20, 80))) < good
    assert quality(lines((30.3, 20, 120))) == pytest.approx(good - 0.6, abs=1e-6)
    half = passes(np.arange(0, 160, 2), np.full(80, 30.0))
    assert quality(lines((30, 20, 120)), half) < good - np.log(1.9)


def test_scores_rise_with_quality_between_zero_and_one() -> None:
    values = scores(np.linspace(-30, 30, 50))
    assert (np.diff(values) >= 0).all()
    assert values.min() >= 0
    assert values.max() <= 1
