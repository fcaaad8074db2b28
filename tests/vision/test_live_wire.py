"""Tracing edges between clicked points, on edges whose place is known exactly."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.errors import InvalidInput, NoEdge
from app.vision.division import Division
from app.vision.edges import EdgeMap
from app.vision.measured_points import edges_of_image
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.tracing import straight_line, trace_edge

WIDTH, HEIGHT = 480, 360
LENSES = {"straight": 0.0, "barrel": 0.25, "pincushion": -0.2}
ENDS = [((40, 60), (440, 300)), ((30, 180), (450, 171)), ((233, 20), (251, 340)), ((60, 330), (380, 25))]
Scene = tuple[EdgeMap, Division, NDArray[np.float64]]


def lens_of(name: str) -> Division:
    return Division(WIDTH, HEIGHT, (LENSES[name], 0.0, 0.0), (0.02, -0.01))


def distances(lens: Division, line: NDArray[np.float64], points: NDArray[np.float64]) -> tuple[NDArray, NDArray]:
    """Signed distances in px of points ``(n, 2)`` from the image of a straight line, and unit normals there."""
    (x0, y0), (x1, y1) = lens.undistort(line)
    across = np.array([y0 - y1, x1 - x0]) / np.hypot(x1 - x0, y1 - y0)
    gradient = np.einsum("nij,i->nj", lens.jacobian(points), across)
    stretch = np.hypot(*gradient.T)
    return (lens.undistort(points) - (x0, y0)) @ across / stretch, gradient / stretch[:, None]


def render(lens: Division, line: NDArray[np.float64], contrast: float = 120.0) -> NDArray[np.uint8]:
    """Each pixel's share beyond the line, which is the convolution of two boxes as wide as its normal's components."""
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(float)
    distance, normal = distances(lens, line, np.stack([x.ravel(), y.ravel()], axis=1))
    a, b = np.sort(np.maximum(np.abs(normal), 1e-3), axis=1).T

    def ramp(t: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.maximum(t, 0) ** 2

    corners = ramp(distance + (a + b) / 2) + ramp(distance - (a + b) / 2)
    share = (corners - ramp(distance + (b - a) / 2) - ramp(distance - (b - a) / 2)) / (2 * a * b)
    return np.rint(60 + contrast * share).reshape(HEIGHT, WIDTH).astype(np.uint8)


@pytest.fixture(scope="module")
def scene() -> Callable[[str, int], Scene]:
    """Return a function that gives the edges of one of ENDS under one of LENSES, with that lens and line."""
    known: dict[tuple[str, int], Scene] = {}

    def make(name: str, number: int) -> Scene:
        if (name, number) not in known:
            lens, line = lens_of(name), np.array(ENDS[number], float)
            known[name, number] = edges_of_image(render(lens, line)), lens, line
        return known[name, number]

    return make


@pytest.mark.parametrize("knows_lens", [True, False])
@pytest.mark.parametrize("number", range(len(ENDS)))
@pytest.mark.parametrize("name", LENSES)
@settings(max_examples=4)
@given(off=st.lists(st.tuples(st.floats(0, 2 * np.pi), st.floats(0, 3)), min_size=2, max_size=2))
def test_points_lie_on_the_edge_however_unsteady_the_clicks(scene, name, number, knows_lens, off) -> None:
    edges, lens, line = scene(name, number)
    clicks = line + [(r * np.cos(angle), r * np.sin(angle)) for angle, r in off]
    trace = trace_edge(edges, clicks, lens=lens if knows_lens else None)
    distance, _ = distances(lens, line, trace.points.astype(float))
    assert np.sqrt((distance**2).mean()) <= 0.05
    assert abs(trace.length - np.hypot(*(line[1] - line[0]))) < 12
    assert trace.points[0] == pytest.approx(line[0], abs=5)
    assert trace.points[-1] == pytest.approx(line[1], abs=5)
    if knows_lens:
        assert trace.residual <= 0.05


@settings(max_examples=10)
@given(number=st.integers(0, len(ENDS) - 1), name=st.sampled_from(list(LENSES)), off=st.floats(-3, 3))
def test_the_result_is_the_same_from_either_end(scene, number, name, off) -> None:
    edges, lens, line = scene(name, number)
    clicks = np.stack([line[0] + off, line.mean(axis=0), line[1] - off])
    there, back = (trace_edge(edges, each, lens=lens) for each in (clicks, clicks[::-1]))
    assert np.array_equal(there.points, back.points[::-1])
    assert there.residual == pytest.approx(back.residual)


def test_the_points_are_those_of_a_candidate(scene) -> None:
    lens, line = lens_of("straight"), np.array(ENDS[0], float)
    candidate = detect(render(lens, line), DetectionParameters(min_length=100))[0]
    traced = trace_edge(scene("straight", 0)[0], line + np.array([(0, 2), (0, -1)])).points
    common = {tuple(point) for point in candidate.tolist()} & {tuple(point) for point in traced.tolist()}
    assert len(common) >= 0.98 * len(traced)


def test_of_two_edges_the_clicked_one_is_traced_although_the_other_is_stronger() -> None:
    image = np.full((120, 300), 200, np.uint8)
    image[60:66] = 160
    image[66:] = 20
    edges = edges_of_image(image)
    for y in (59.5, 65.5):
        points = trace_edge(edges, [(20, y + 1), (280, y - 1)]).points
        assert points[:, 1] == pytest.approx(y, abs=0.1)


def test_a_gap_is_left_without_points() -> None:
    image = np.full((120, 300), 90, np.uint8)
    image[60:] = 180
    image[40:80, 140:170] = 130  # a post, whose sides run across
    points = trace_edge(edges_of_image(image), [(20, 60), (280, 58)]).points
    beside = np.abs(points[:, 0] - 154.5) > 18  # blur rounds the corners at the post
    assert points[beside, 1] == pytest.approx(59.5, abs=0.1)
    assert not ((points[:, 0] > 143) & (points[:, 0] < 166)).any()
    assert (points[:, 0] < 139).sum() > 100
    assert (points[:, 0] > 170).sum() > 90


def test_a_line_ends_where_its_edge_does() -> None:
    image = np.full((120, 300), 90, np.uint8)
    image[60:, :200] = 180
    points = trace_edge(edges_of_image(image), [(20, 60), (240, 60)]).points
    assert 190 <= points[:, 0].max() <= 200


def test_an_edge_that_leads_away_from_the_clicked_points_is_none() -> None:
    image = np.full((300, 400), 70, np.uint8)
    image[:120] = 200
    with pytest.raises(NoEdge):
        trace_edge(edges_of_image(image), [(100, 122), (270, 160)])


@settings(max_examples=15)
@given(ends=st.tuples(st.integers(10, 290), st.integers(10, 190), st.integers(10, 290), st.integers(10, 190)))
def test_nothing_is_traced_in_noise_and_the_error_says_what_and_where(noise, ends) -> None:
    x0, y0, x1, y1 = ends
    if np.hypot(x1 - x0, y1 - y0) < 40:
        return
    with pytest.raises(NoEdge) as error:
        trace_edge(noise, [(x0, y0), (x1, y1)])
    problem = error.value.as_dict()
    assert f"({x0}, {y0})" in problem["where"]
    assert "straight line" in problem["hint"]
    assert problem["details"]["support"] < 0.5


@pytest.fixture(scope="module")
def noise() -> EdgeMap:
    pixels = np.random.default_rng(3).normal(120, 9, (200, 300))
    return edges_of_image(pixels.clip(0, 255).astype(np.uint8))


@pytest.mark.parametrize(
    ("clicks", "where"),
    [
        ([(10, 10)], "points"),
        ([(i, 10) for i in range(21)], "points"),
        ([(10, 10), (np.nan, 20)], "points[1]"),
        ([(10, 10), (300, 20)], "points[1]"),
        ([(-1, 10), (30, 20)], "points[0]"),
        ([(10, 10), (12, 12)], "points"),
        ([(10, 10), (200, 10), (100, 12), (250, 10)], "points[2]"),
    ],
)
def test_points_that_make_no_line_are_refused(noise, clicks, where) -> None:
    with pytest.raises(InvalidInput) as error:
        trace_edge(noise, clicks)
    assert error.value.where == where
    assert error.value.code == "invalid-input"


@pytest.mark.parametrize("reach", [0, -1, 65, np.inf, np.nan])
def test_the_reach_is_bounded(noise, reach) -> None:
    with pytest.raises(InvalidInput, match="reach"):
        trace_edge(noise, [(10, 10), (100, 100)], reach=reach)


@pytest.mark.parametrize("name", LENSES)
def test_the_line_as_drawn_passes_the_clicks_and_bends_as_the_lens_says(name) -> None:
    lens, line = lens_of(name), np.array(ENDS[0], float)
    drawn = straight_line(line, (WIDTH, HEIGHT), lens=lens)
    distance, _ = distances(lens, line, drawn.points.astype(float))
    assert np.abs(distance).max() < 0.02
    assert drawn.points[[0, -1]] == pytest.approx(line)
    assert np.hypot(*np.diff(drawn.points, axis=0).T).max() < 1.2
    middle = line.mean(axis=0) + np.array((1.0, 2.0))
    through = straight_line([line[0], middle, line[1]], (WIDTH, HEIGHT), lens=lens).points
    assert np.hypot(*(through - middle).T).min() < 1e-3
