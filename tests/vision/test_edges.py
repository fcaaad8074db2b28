"""Edge points of both passes: where they are found, and where they are measured."""

from math import pi, radians, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import ndimage

from app.vision.edges import POSITION_SIGMA, EdgeMap, edge_map
from app.vision.equalisation import LEVELS, Equalisation, equalisation
from app.vision.native.records import GRADIENT_SCALE, MARGIN, SPAN_PIXELS
from app.vision.watch import Watch


def unchanged(gray: np.ndarray) -> Equalisation:
    """Tables that leave every level as it is."""
    width = gray.shape[1]
    tables = np.arange(LEVELS, dtype=np.float32).reshape(1, 1, LEVELS)
    return Equalisation(tables, np.zeros(width, np.int32), np.zeros(width, np.float32))


def find(gray: np.ndarray, weakest: float = 25.0, sigma: float = 0.5, tables: Equalisation | None = None) -> EdgeMap:
    gray = np.ascontiguousarray(gray, np.uint8)
    return edge_map(gray, tables or unchanged(gray), sigma, weakest, Watch())


def gradient(image: np.ndarray, sigma: float) -> np.ndarray:
    """Gauss and Sobel in double precision, ``(2, H, W)``."""
    reach = int(np.ceil(3 * sigma))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weights /= weights.sum()
    smooth, slope = np.convolve(weights, [1.0, 2.0, 1.0]), np.convolve(weights, [-1.0, 0.0, 1.0])
    return np.stack(
        [
            ndimage.correlate1d(
                ndimage.correlate1d(image, smooth, axis=1 - along, mode="mirror"), slope, axis=along, mode="mirror"
            )
            for along in (1, 0)
        ]
    )


def positions(edges: EdgeMap, axis: int) -> np.ndarray:
    points = edges.points[axis]
    place = np.stack([points["along"].astype(float), points["across"].astype(float)], axis=1)
    return place if axis == 0 else place[:, ::-1]


def occupied(edges: EdgeMap, axis: int) -> np.ndarray:
    """Whether a pixel has a point: columns in the pass along x, rows in that along y, with margins."""
    spans = np.ascontiguousarray(edges.spans[axis]["occupied"], "<u4")
    return np.unpackbits(spans.view(np.uint8), axis=1, bitorder="little").astype(bool)


def errors(edges: EdgeMap, angle: float, offset: float) -> np.ndarray:
    """Signed distances in px of the points found from the true line, points near the border left out."""
    size = edges.gray.shape[0]
    found = np.concatenate([positions(edges, axis) for axis in (0, 1)])
    inside = (found > 6).all(axis=1) & (found < size - 7).all(axis=1)
    return (found[inside] - size // 2) @ np.array([-np.sin(angle), np.cos(angle)]) - offset


def test_the_gradient_is_that_of_a_blur_and_a_sobel_operator() -> None:
    image = np.random.default_rng(4).integers(0, 256, (37, 53))
    for sigma in (0.5, 1.3):
        edges = find(image, sigma=sigma)
        assert np.abs(edges.gradients / GRADIENT_SCALE - gradient(image.astype(float), sigma)).max() < 0.04


def test_a_step_has_four_times_its_height_before_blurring() -> None:
    image = np.zeros((9, 12), np.uint8)
    image[:, 6:] = 20
    edges = find(image, sigma=0.3)
    # a blur of 0.3 px leaves almost all of the step between two columns
    assert edges.gradients[0, 4, 5:7] / GRADIENT_SCALE == pytest.approx([80, 80], rel=0.01)
    assert not edges.gradients[1].any()


@pytest.mark.parametrize(("degrees", "passes"), [(0, {0}), (38, {0}), (45, {0, 1}), (52, {1}), (90, {1})])
def test_directions_belong_to_the_passes_with_an_overlap_at_the_diagonal(half_plane, degrees, passes) -> None:
    edges = find(50 + 150 * half_plane(radians(degrees), 0.1), weakest=100)
    assert {axis for axis in (0, 1) if len(edges.points[axis]) > 20} == passes


def test_the_threshold_must_be_exceeded() -> None:
    image = np.zeros((20, 20), np.uint8)
    image[10:] = 10
    norm = np.abs(find(image).gradients[1]).max() / GRADIENT_SCALE
    assert len(find(image, weakest=norm - 0.2).points[0]) == 18
    assert not len(find(image, weakest=norm + 0.2).points[0])


@given(hnp.arrays(np.uint8, hnp.array_shapes(min_dims=2, max_dims=2, min_side=3, max_side=24)))
def test_points_and_places_agree(image: np.ndarray) -> None:
    edges = find(image, weakest=5)
    for axis in (0, 1):
        points, pixels = edges.points[axis], occupied(edges, axis)
        along, across = np.nonzero(pixels)
        assert np.array_equal(points["along"], along)
        assert (np.abs(points["across"] - (across - MARGIN)) <= 0.501).all()
        assert np.isfinite(points["slope"]).all()
        assert len(points) <= (image.shape[axis == 1] + 1) // 2 * image.shape[axis == 0]
        counts = pixels.reshape(-1, SPAN_PIXELS).sum(axis=1)
        assert np.array_equal(edges.spans[axis]["before"].ravel(), np.cumsum(counts) - counts)


def test_of_a_tie_one_pixel_is_taken() -> None:
    image = np.zeros((12, 30), np.uint8)
    image[6:] = 100  # the gradient of rows 5 and 6 is the same
    points = find(image).points[0]
    assert len(points) == 28
    assert points["across"] == pytest.approx(5.5, abs=1e-3)


@given(angle=st.floats(0, pi), offset=st.floats(-0.5, 0.5))
def test_an_anti_aliased_edge_is_found_within_a_tenth_of_a_pixel(half_plane, angle: float, offset: float) -> None:
    found = errors(find(np.rint(50 + 150 * half_plane(angle, offset)), weakest=100), angle, offset)
    assert len(found) > 30
    assert np.abs(found).max() < 0.1


def test_a_position_is_the_vertex_of_the_parabola_through_three_norms(half_plane) -> None:
    image = np.rint(50 + 150 * half_plane(radians(12.0), 0.3)).astype(np.uint8)
    norm = np.hypot(*gradient(image.astype(float), POSITION_SIGMA))
    points = find(image, weakest=150).points[0]
    inside = np.abs(points["along"] - 30) < 20
    for x, y in zip(points["along"][inside], points["across"][inside], strict=True):
        peak = int(np.argmax(norm[:, x]))
        expected = -np.polyfit([-1, 0, 1], norm[peak - 1 : peak + 2, x], 2)[1]
        expected /= 2 * np.polyfit([-1, 0, 1], norm[peak - 1 : peak + 2, x], 2)[0]
        assert y == pytest.approx(peak + expected, abs=1e-3)


def test_edges_are_measured_in_the_image_before_equalisation(half_plane) -> None:
    image = np.rint(50 + 100 * half_plane(0.0, 0.3)).astype(np.uint8)
    plain = find(image).points[0]["across"]
    # all of the step between 50 and 70: the equalised edge lies half a pixel higher
    bent = np.interp(np.arange(256), [50, 70], [50, 150]).astype(np.float32).reshape(1, 1, 256)
    tables = unchanged(image)
    moved = find(image, tables=Equalisation(bent, tables.left, tables.rightward))
    assert not np.array_equal(moved.gradients, find(image).gradients)
    assert moved.points[0]["across"] == pytest.approx(plain, abs=1e-3)
    assert plain.mean() == pytest.approx(30.3, abs=0.03)


def test_an_edge_that_only_equalisation_sees_stays_where_that_sees_it() -> None:
    image = np.full((20, 40), 100, np.uint8)
    tables = np.stack([np.full(256, 50.0), np.full(256, 150.0)]).astype(np.float32)[None]
    rightward = np.repeat(np.array([0.0, 1.0], np.float32), 20)
    points = find(image, tables=Equalisation(tables, np.zeros(40, np.int32), rightward)).points[1]
    assert len(points) == 18
    assert points["across"] == pytest.approx(19.5, abs=1e-3)


@pytest.mark.parametrize("degrees", [-20.0, 20.0, 40.0])
def test_slope_and_sign_describe_the_edge(half_plane, degrees: float) -> None:
    edge = half_plane(radians(degrees), 0.1)
    for image, sign in ((200 * edge, 1), (200 - 200 * edge, -1)):
        points = find(np.rint(image), weakest=150, sigma=1.0).points[0]
        middle = np.abs(points["along"] - 30) < 20
        assert points["slope"][middle].mean() == pytest.approx(tan(radians(degrees)), abs=0.02)
        assert (np.sign(points["norm"]) == sign).all()


def test_strips_leave_no_seam() -> None:
    # strips have 32768 pixels: this image is cut into many, its left half into few
    image = np.random.default_rng(8).integers(0, 256, (300, 1400)).astype(np.uint8)
    whole, left = find(image), find(image[:, :200])
    assert np.array_equal(whole.gradients[:, :, :195], left.gradients[:, :, :195])
    assert np.array_equal(occupied(whole, 0)[:195], occupied(left, 0)[:195])
    assert np.array_equal(occupied(whole, 1)[:, : MARGIN + 195], occupied(left, 1)[:, : MARGIN + 195])


def test_a_photo_is_equalised_while_its_edges_are_found() -> None:
    image = np.random.default_rng(8).integers(90, 110, (50, 60)).astype(np.uint8)
    tables = equalisation(image, 4.0, 96)
    looked_up = tables.tables[0, 0][image].astype(float)
    edges = find(image, tables=tables)
    assert np.abs(edges.gradients / GRADIENT_SCALE - gradient(looked_up, 0.5)).max() < 0.04


def test_an_image_with_more_points_than_is_usual_loses_none() -> None:
    # steps up and down by turns, 2 or 3 px apart: 40 % of the pixels have a point
    stripes = np.tile(np.where(np.arange(600) % 5 < 2, 255, 0).astype(np.uint8), (90, 1))
    edges = find(stripes)
    assert len(edges.points[1]) > stripes.size / 4
    points = edges.points[1].reshape(88, -1)
    assert (points["along"] == np.arange(1, 89)[:, None]).all()
    assert np.array_equal(points["across"], np.tile(points["across"][0], (88, 1)))
    assert np.array_equal(find(stripes.T).points[0]["across"], edges.points[1]["across"])


def test_progress_rises_even_where_points_are_looked_for_twice() -> None:
    stripes = np.tile(np.where(np.arange(600) % 5 < 2, 255, 0).astype(np.uint8), (400, 1))
    told: list[float] = []
    edge_map(stripes, unchanged(stripes), 0.5, 25.0, Watch(told.append))
    assert told
    assert told == sorted(told)
