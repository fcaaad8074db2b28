from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from app.synthesis import Lens, make_lens
from app.synthesis.camera import Pose
from app.synthesis.geometry import Drawing, Points
from app.synthesis.labels import EdgeLabels, label_curves, label_edges
from app.synthesis.light import rgb
from app.synthesis.rasteriser import Haze, rasterise
from app.synthesis.sampling import across
from app.synthesis.sensor import LensMap, Sensor, expose, map_lens

PLAIN = make_lens(401, 301, 300.0, np.zeros(5))
QUIET = Sensor(blur=0.7, vignetting=0, noise=0, photon_noise=0)


@pytest.fixture(scope="module")
def plain_map() -> LensMap:
    return map_lens(PLAIN)


def rectangle(x0: float, y0: float, x1: float, y1: float, z: float = 3.0) -> Points:
    """At 3 m, 100 px of the plain lens are one m, and x = y = 0 lies at px (200, 150)."""
    return np.array([[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]]) * np.array([z / 3, z / 3, 1])


def look(drawing: Drawing, lens_map: LensMap, curves: bool = False) -> EdgeLabels:
    view = lens_map.view(Pose(np.zeros(3)))
    background = np.full((3, view.height, view.width), 60, np.float32)
    picture = rasterise(drawing, view, background, Haze(rgb(0, 0, 0), 1e9))
    photo = expose(picture.colours, lens_map, QUIET)
    return (label_curves if curves else label_edges)(drawing, view, lens_map, picture, photo)


def wall(kind: str | None = None) -> Drawing:
    drawing = Drawing()
    drawing.paint(rectangle(-30, -30, 30, 30, 8.0), (120, 120, 120), kind=kind)
    return drawing


def test_a_rectangle_gives_its_four_edges(plain_map: LensMap) -> None:
    drawing = wall()
    drawing.paint(rectangle(-1, -0.5, 1, 0.8), (200, 200, 200), kind="sign")
    labels = look(drawing, plain_map)
    assert labels.kinds == ("sign",) * 4
    assert sorted(labels.line_ids.tolist()) == [0, 1, 2, 3]
    boxes = labels.segments.boxes()
    assert np.allclose(boxes[labels.line_ids.tolist().index(0)], [100, 100, 300, 100], atol=1.5)
    assert np.allclose(boxes[labels.line_ids.tolist().index(1)], [300, 100, 300, 230], atol=1.5)
    assert np.allclose(np.linalg.norm(np.diff(labels.segments[0], axis=0), axis=1), 1.0, atol=0.02)


def test_an_edge_behind_something_is_split_and_keeps_its_identity(plain_map: LensMap) -> None:
    drawing = wall()
    drawing.paint(rectangle(-1.2, -0.5, 1.2, 0.8), (200, 200, 200), kind="sign")
    drawing.paint(rectangle(-0.1, -3, 0.3, 3, 2.0), (30, 30, 30))
    labels = look(drawing, plain_map)
    tops = [segment for segment, line in zip(labels.segments, labels.line_ids, strict=True) if line == 0]
    assert len(tops) == 2
    ends = sorted((float(top[:, 0].min()), float(top[:, 0].max())) for top in tops)
    assert ends[0] == pytest.approx((80, 190), abs=3)
    assert ends[1] == pytest.approx((230, 320), abs=3)


def test_what_is_wholly_hidden_has_no_labels(plain_map: LensMap) -> None:
    drawing = wall()
    drawing.paint(rectangle(-0.5, -0.5, 0.5, 0.5), (200, 200, 200), kind="sign")
    drawing.paint(rectangle(-1, -1, 1, 1, 2.0), (30, 30, 30))
    assert len(look(drawing, plain_map).segments) == 0


@pytest.mark.parametrize(("grey", "count"), [(122, 0), (124, 0), (136, 4), (100, 4)])
def test_an_edge_needs_contrast(plain_map: LensMap, grey: int, count: int) -> None:
    drawing = wall()
    drawing.paint(rectangle(-1, -1, 1, 1), (grey, grey, grey), kind="sign")
    assert len(look(drawing, plain_map).segments) == count


@pytest.mark.parametrize(("grey", "clear"), [(126, False), (136, True)])
def test_an_edge_of_little_contrast_is_faint(plain_map: LensMap, grey: int, clear: bool) -> None:
    drawing = wall()
    drawing.paint(rectangle(-1, -1, 1, 1), (grey, grey, grey), kind="sign")
    assert look(drawing, plain_map).clear.tolist() == [clear] * 4


def test_an_edge_that_is_clear_along_half_is_one_label(plain_map: LensMap) -> None:
    def tops(share: float) -> list[bool]:
        drawing = wall()
        drawing.paint(rectangle(-1, -1, 1, 1), (126, 126, 126), kind="sign")
        drawing.paint(rectangle(-1, -2, -1 + 2 * share, -1), (60, 60, 60))
        labels = look(drawing, plain_map)
        return labels.clear[labels.line_ids == 0].tolist()

    assert tops(0.7) == [True]
    assert tops(0.3) == [False]


def test_edges_of_little_length_are_left_out(plain_map: LensMap) -> None:
    drawing = wall()
    drawing.paint(rectangle(-0.08, -1, 0.08, 1), (200, 200, 200), kind="sign")  # 16 x 200 px
    assert sorted(look(drawing, plain_map).line_ids.tolist()) == [1, 3]


def test_edges_that_coincide_give_one_label(plain_map: LensMap) -> None:
    drawing = wall()
    drawing.paint(rectangle(-1, -1, 0, 1), (200, 200, 200), kind="wall")
    drawing.paint(rectangle(0, -1, 1, 1), (30, 30, 30), kind="wall")
    labels = look(drawing, plain_map)
    shared = [s for s in labels.segments if np.abs(s[:, 0] - 200).max() < 1]
    assert len(shared) == 1
    assert len(labels.segments) == 7


def test_two_sides_of_a_thin_bar_are_two_labels_and_a_thinner_one_is_none(plain_map: LensMap) -> None:
    def sides(width: float) -> int:
        drawing = wall()
        drawing.paint(rectangle(-width / 200, -1, width / 200, 1), (220, 220, 220), kind="pole")
        return len(look(drawing, plain_map).segments)

    assert sides(4.0) == 2
    assert sides(0.6) == 0


def test_what_lies_outside_the_frame_is_no_label(barrel: Lens, barrel_map: LensMap) -> None:
    drawing = wall()
    drawing.paint(rectangle(-9, -0.4, 9, 0.4), (220, 220, 220), kind="kerb")
    labels = look(drawing, barrel_map)
    assert len(labels.segments) == 2
    points = labels.segments.points
    assert (points >= 0).all()
    assert (points <= [barrel.width - 1, barrel.height - 1]).all()
    assert labels.segments.extents().min() > barrel.width - 4


def test_a_label_bends_as_the_lens_does(barrel: Lens, barrel_map: LensMap) -> None:
    drawing = wall()
    drawing.paint(rectangle(-9, -0.9, 9, 9), (220, 220, 220), kind="kerb")
    labels = look(drawing, barrel_map)
    top = labels.segments[int(labels.line_ids.tolist().index(0))].astype(float)
    assert np.ptp(top[:, 1]) > 5
    rays = barrel.to_rays(top)
    assert rays[:, 1] == pytest.approx(np.full(len(rays), -0.3), abs=1e-6)


def test_a_curve_is_a_distractor_with_its_reason(plain_map: LensMap) -> None:
    drawing = wall()
    turn = np.linspace(0, 2 * np.pi, 60)
    ring = np.stack([0.8 * np.cos(turn), 0.8 * np.sin(turn), np.full(60, 3.0)], axis=1)
    drawing.paint(ring[:-1], (220, 220, 220))
    drawing.curve(ring, "round sign")
    assert len(look(drawing, plain_map).segments) == 0
    curves = look(drawing, plain_map, curves=True)
    assert curves.kinds == ("round sign",)
    radii = np.linalg.norm(curves.segments.points - [200, 150], axis=1)
    assert np.abs(radii - 80).max() < 0.5
    assert curves.segments.lengths()[0] == pytest.approx(2 * np.pi * 80, rel=0.02)


def test_a_curve_along_a_label_is_no_distractor(plain_map: LensMap) -> None:
    drawing = wall()
    drawing.paint(rectangle(-1, -1, 1, 1), (220, 220, 220), kind="sign")
    drawing.curve(rectangle(-1, -1, 1, 1)[:2], "shadow")
    view = plain_map.view(Pose(np.zeros(3)))
    picture = rasterise(drawing, view, np.full((3, view.height, view.width), 60, np.float32), Haze(rgb(0, 0, 0), 1e9))
    photo = expose(picture.colours, plain_map, QUIET)
    labels = label_edges(drawing, view, plain_map, picture, photo)
    assert len(label_curves(drawing, view, plain_map, picture, photo).segments) == 1
    assert len(label_curves(drawing, view, plain_map, picture, photo, labels).segments) == 0


def test_an_empty_street_has_no_labels(plain_map: LensMap) -> None:
    assert len(look(Drawing(), plain_map).segments) == 0
    assert len(look(Drawing(), plain_map, curves=True).segments) == 0


@pytest.mark.parametrize("turn", [0.0, 0.03, 0.4, 0.785, 1.2])
def test_a_clean_edge_is_imaged_where_its_label_lies(turn: float, barrel: Lens, barrel_map: LensMap) -> None:
    """The half-pixel conventions of rasteriser, lens map and averaging agree to a hundredth of a pixel."""
    cosine, sine = np.cos(turn), np.sin(turn)
    corners = rectangle(-1.013, -0.517, 1.011, 0.523) @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]])
    drawing = wall()
    drawing.paint(corners, (220, 220, 220), kind="sign")
    view = barrel_map.view(Pose(np.zeros(3)))
    background = np.full((3, view.height, view.width), 60, np.float32)
    picture = rasterise(drawing, view, background, Haze(rgb(0, 0, 0), 1e9))
    grey = expose(picture.colours, barrel_map, QUIET)[..., 0].astype(np.float64)
    labels = label_edges(drawing, view, barrel_map, picture, expose(picture.colours, barrel_map, QUIET))
    assert len(labels.segments) == 4
    steps = np.arange(-3, 3.01, 0.05)
    for segment in labels.segments:
        points = segment[10:-10].astype(np.float64)
        normals = across(points, np.zeros(len(points), np.int64))
        at = points[:, None] + steps[None, :, None] * normals[:, None]
        profile = map_coordinates(grey, [at[..., 1], at[..., 0]], order=1)
        slopes = np.abs(np.diff(profile, axis=1))
        offsets = (slopes * (steps[:-1] + 0.025)).sum(axis=1) / slopes.sum(axis=1)  # where the edge's middle lies
        assert abs(offsets.mean()) < 0.012
        assert np.abs(offsets).max() < 0.1
