"""Synthetic edge-segments through a known lens; images, edge points and arcs to try the detector's stages on."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import POINTER, c_double, c_int, c_int64, c_void_p
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from app.vision.brown import Brown
from app.vision.edges import EdgeMap, no_spans
from app.vision.frame import center_of
from app.vision.native.library import kernels
from app.vision.native.records import ARC, GRADIENT_SCALE, MARGIN, POINT, SPAN_PIXELS, Scene, address
from app.vision.segments import Segments

SegmentsThrough = Callable[..., Segments]


@pytest.fixture
def segments_through() -> SegmentsThrough:
    """Return a function that makes straight lines of the scene, seen through a lens, and bent edges among them."""

    def make(
        lens: Brown,
        count: int = 60,
        *,
        seed: int = 0,
        noise: float = 0.05,
        bent: float = 0.0,
        through_center: bool = False,
        shortest: float = 100.0,
    ) -> Segments:
        """The first ``bent * count`` segments are arcs with a sagitta of 2 to 8 px, the others are straight lines."""
        generator = np.random.default_rng(seed)
        size = np.array([lens.width - 1, lens.height - 1])
        polylines: list[np.ndarray] = []
        while len(polylines) < count:
            ends = generator.uniform(0.03, 0.97, (2, 2)) * size
            if through_center:
                ends[1] = 2 * np.array(center_of(lens.width, lens.height)) - ends[0]
            length = float(np.hypot(*(ends[1] - ends[0])))
            if not shortest <= length <= 0.6 * lens.width:
                continue
            t = np.linspace(0, 1, int(length))[:, None]
            first, last = lens.undistort(ends)
            points = lens.distort(first + t * (last - first))
            across = np.array([ends[0, 1] - ends[1, 1], ends[1, 0] - ends[0, 0]]) / length
            offset = generator.normal(0, noise, (len(t), 1))
            if len(polylines) < bent * count:
                offset = offset + generator.choice([-1, 1]) * generator.uniform(2, 8) * 4 * t * (1 - t)
            polylines.append(points + offset * across)
        return Segments.from_list(polylines)

    return make


@dataclass(frozen=True)
class Probes:
    """What kernels compute inside, through the doors of ``probes.c``."""

    library: Any

    def fit(self, runs: list[NDArray[Any]], traits: NDArray[Any] | None = None) -> NDArray[Any]:
        """Arcs fitted to runs of points, each directed from its first point to its last."""
        offsets = np.cumsum([0, *map(len, runs)]).astype(np.int64)
        points = np.ascontiguousarray(np.concatenate([*runs, np.zeros((0, 2))]), np.float64)
        traits = np.zeros((len(runs), 3)) if traits is None else np.ascontiguousarray(traits, np.float64)
        arcs = np.zeros(len(runs), ARC)
        self.library.cl_probe_fit(address(points), address(offsets), address(traits), len(runs), address(arcs))
        return arcs

    def place(self, arc: NDArray[Any], along: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Points and directions of one arc at tangent coordinates."""
        along = np.ascontiguousarray(along, np.float64)
        places, directions = np.empty((2, len(along), 2))
        self.library.cl_probe_place(address(arc), address(along), len(along), address(places), address(directions))
        return places, directions

    def project(self, arc: NDArray[Any], points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Tangent coordinates and signed distances of points from one arc."""
        points = np.ascontiguousarray(points, np.float64)
        along, distances = np.empty((2, len(points)))
        self.library.cl_probe_project(address(arc), address(points), len(points), address(along), address(distances))
        return along, distances

    def join(
        self, first: NDArray[Any], second: NDArray[Any], *, leave_end: bool = True, enter_start: bool = True
    ) -> NDArray[Any]:
        """The arc through two arcs."""
        joined = np.zeros(1, ARC)
        self.library.cl_probe_join(address(first), leave_end, address(second), enter_start, address(joined))
        return joined

    def gap(self, edges: EdgeMap, arcs: NDArray[Any], *, same_polarity: bool = True) -> float:
        """Effective length of the gap from the end of the first arc to the start of the second."""
        return self.library.cl_probe_gap(edges.scene, address(arcs[:1]), address(arcs[1:]), same_polarity)


@pytest.fixture(scope="session")
def probes() -> Probes:
    """Return what kernels compute inside."""
    library = kernels()
    p = c_void_p
    library.cl_probe_fit.argtypes = [p, p, p, c_int64, p]
    library.cl_probe_place.argtypes = [p, p, c_int64, p, p]
    library.cl_probe_project.argtypes = [p, p, c_int64, p, p]
    library.cl_probe_join.argtypes = [p, c_int, p, c_int, p]
    library.cl_probe_gap.argtypes = [POINTER(Scene), p, p, c_int]
    library.cl_probe_gap.restype = c_double
    return Probes(library)


EdgesOf = Callable[..., EdgeMap]


@pytest.fixture(scope="session")
def edges_of() -> EdgesOf:
    """Return a function that makes edge maps of points along x, and of none along y."""

    def make(
        columns: Any = (),
        rows: Any = (),
        *,
        shape: tuple[int, int] = (60, 160),
        slope: Any = 0.0,
        norm: Any = 90.0,
        gradients: NDArray[Any] | None = None,
    ) -> EdgeMap:
        """Points in columns, at sub-pixel rows, put in this order; ``gradients`` ``(2, H, W)`` in grey levels."""
        points = np.zeros(len(columns), POINT)
        points["along"], points["across"], points["slope"], points["norm"] = columns, rows, slope, norm
        points = points[np.lexsort((points["across"], points["along"]))]
        height, width = shape
        spans = no_spans(width, height), no_spans(height, width)
        occupied = np.zeros((*spans[0].shape, SPAN_PIXELS), np.uint8)
        across = MARGIN + np.rint(points["across"]).astype(int)
        occupied[points["along"], across // SPAN_PIXELS, across % SPAN_PIXELS] = 1
        spans[0]["occupied"] = np.packbits(occupied, axis=2, bitorder="little").view("<u4")[..., 0]
        counts = occupied.sum(axis=2)
        spans[0]["before"] = (np.cumsum(counts) - counts.ravel()).reshape(counts.shape)
        field = np.zeros((2, *shape)) if gradients is None else gradients
        steps = np.rint(np.moveaxis(field, 0, 2) * GRADIENT_SCALE).astype(np.int16, order="C")
        return EdgeMap(np.zeros(shape, np.uint8), np.moveaxis(steps, 2, 0), (points, np.zeros(0, POINT)), spans)

    return make


@pytest.fixture(scope="session")
def windows() -> NDArray[np.uint8]:
    """A wall with a slanted roof line and four windows, smooth and slightly noisy, 321 x 241."""
    large = np.full((241 * 4, 321 * 4), 90, np.uint8)
    cv2.fillPoly(large, [np.array([[0, 0], [1284, 0], [1284, 180], [0, 340]])], (190,))
    for x in (160, 760):
        for y in (400, 660):
            cv2.rectangle(large, (x, y), (x + 330, y + 200), (30,), -1)
    image = cv2.resize(large, (321, 241), interpolation=cv2.INTER_AREA).astype(float)
    return np.clip(image + np.random.default_rng(5).normal(0, 1.5, image.shape), 0, 255).astype(np.uint8)


@pytest.fixture(scope="session")
def street() -> Callable[[str], NDArray[np.uint8]]:
    """Return a function that reads a photo of the York data, or skips the test where there are none."""

    def read(name: str) -> NDArray[np.uint8]:
        path = Path(__file__).parents[2].parent / "shared" / "data" / "york" / "images" / f"{name}.jpg"
        if not path.exists():
            pytest.skip(f"no {path}")
        image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        assert image is not None
        return np.asarray(image, np.uint8)

    return read


HalfPlane = Callable[..., NDArray[np.float64]]


@pytest.fixture(scope="session")
def half_plane() -> HalfPlane:
    """Return a function that renders the exact share of each pixel's area beyond a line."""

    def render(angle: float, offset: float, size: int = 61) -> NDArray[np.float64]:
        """The line runs at ``angle`` (rad), ``offset`` px beyond the centre of an image with an odd side ``size``.

        The area of a unit square beyond a line is the convolution of two boxes as wide as the normal's components.
        """
        normal = np.array([-np.sin(angle), np.cos(angle)])
        y, x = np.mgrid[:size, :size] - size // 2
        distance = x * normal[0] + y * normal[1] - offset
        a, b = np.sort(np.abs(normal))
        if a < 1e-9:
            return np.clip(distance + 0.5, 0, 1)

        def ramp(t: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.maximum(t, 0) ** 2

        corners = ramp(distance + (a + b) / 2) + ramp(distance - (a + b) / 2)
        return (corners - ramp(distance + (b - a) / 2) - ramp(distance - (b - a) / 2)) / (2 * a * b)

    return render
