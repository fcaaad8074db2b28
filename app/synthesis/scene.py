"""Whole scenes: a street, a lens, a photo and its labels."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.synthesis.camera import Pose, SyntheticCamera, describe_camera
from app.synthesis.distractors import REASON_OF
from app.synthesis.labels import label_curves, label_edges
from app.synthesis.lens import Lens, draw_lens
from app.synthesis.light import TIMES_OF_DAY
from app.synthesis.planning import plan_street
from app.synthesis.poses import driving_pose, walking_pose
from app.synthesis.rasteriser import Haze, rasterise
from app.synthesis.sensor import LensMap, Sensor, draw_motion, draw_sensor, expose, map_lens, read_out
from app.synthesis.sky import paint_sky
from app.synthesis.street import Street, draw_street
from app.vision.segments import Segments

_WALKERS = 0.5  # share of single images
SMALLEST, LARGEST = 64, 8192  # px


@dataclass(frozen=True, eq=False)
class SyntheticScene:
    """A street image with all that is true about it.

    Attributes:
        image: uint8 ``(H, W, 3)``: blue, green, red, as OpenCV writes them.
        labels: The visible parts of straight edges, a point about every px, exact.
        camera: The lens, in OpenCV's form and in the undistort direction.
        line_ids: Which straight edge each label belongs to, int64 ``(S,)``: fragments of one edge (with a tree in front
            of its middle) share it. The numbers are those of this image alone.
        kinds: What each label is an edge of ("window pane", "kerb"...), one per label.
        ambiguous: The parts of straight edges that are hardly visible: a step of grey that people may or may not see.
        ambiguous_ids: Which edge each of them belongs to, int64 ``(A,)``, as `line_ids`.
        ambiguous_kinds: What each is an edge of.
        distractors: The visible parts of edges that are no labels (those that are known).
        distractor_ids: Which edge each distractor belongs to, int64 ``(D,)``, as `line_ids`; numbers of their own.
        distractor_kinds: What each distractor is an edge of, a key of `app.synthesis.distractors.REASON_OF`.
        reasons: What a reviewer would reject each distractor for, one of `app.verdicts.REASONS`.
    """

    image: NDArray[np.uint8]
    labels: Segments
    camera: SyntheticCamera
    line_ids: NDArray[np.int64]
    kinds: tuple[str, ...]
    ambiguous: Segments
    ambiguous_ids: NDArray[np.int64]
    ambiguous_kinds: tuple[str, ...]
    distractors: Segments
    distractor_ids: NDArray[np.int64]
    distractor_kinds: tuple[str, ...]
    reasons: tuple[str, ...]


def synthesize_scene(
    seed: int, *, width: int = 1280, height: int = 720, lens: Lens | None = None, sensor: Sensor | None = None
) -> SyntheticScene:
    """Make one street image with its labels, from a car or by a walker; the same seed makes the same image.

    Args:
        seed: From 0 up.
        width: Image width in px.
        height: Image height in px.
        lens: The lens; drawn from the seed where none is given.
        sensor: What the camera adds; drawn from the seed where none is given.

    Raises:
        InvalidInput: On a negative seed, a size out of bounds or a lens made for another size.
    """
    check_scene(seed, width, height, lens)
    rng = np.random.default_rng([seed, 10])
    lens_map = map_lens(lens or draw_lens(rng, width, height))
    street = plan_street(seed, TIMES_OF_DAY[seed % len(TIMES_OF_DAY)])
    pose = walking_pose(street, rng) if rng.random() < _WALKERS else driving_pose(street, 0.0, rng)
    if sensor is None:
        sensor = replace(draw_sensor(rng), motion=draw_motion(rng))
    return photograph(street, pose, lens_map, sensor, np.random.default_rng([seed, 11]))


def check_scene(seed: int, width: int, height: int, lens: Lens | None) -> None:
    """Refuse what makes no scene.

    Raises:
        InvalidInput: On a negative seed, a size out of bounds or a lens made for another size.
    """
    if seed < 0:
        raise InvalidInput(f"the seed is {seed}", where="seed", expected="an integer from 0")
    if not (SMALLEST <= width <= LARGEST and SMALLEST <= height <= LARGEST):
        raise InvalidInput(
            f"an image of {width} x {height} px", where="size", expected=f"{SMALLEST} to {LARGEST} px a side"
        )
    if lens is not None and (lens.width, lens.height) != (width, height):
        raise InvalidInput(
            f"the lens is for {lens.width} x {lens.height} px", where="lens", expected=f"{width} x {height} px"
        )


def photograph(
    street: Street, pose: Pose, lens_map: LensMap, sensor: Sensor, rng: np.random.Generator
) -> SyntheticScene:
    """Take a photo of a street, with all that is true about it."""
    view = lens_map.view(pose)
    drawing = draw_street(street, pose.position)
    haze = Haze(street.light.horizon, street.light.haze)
    picture = rasterise(drawing, view, paint_sky(view, street.light, street.sky), haze)
    photo = expose(picture.colours, lens_map, sensor)
    labels = label_edges(drawing, view, lens_map, picture, photo)
    curves = label_curves(drawing, view, lens_map, picture, photo, labels)
    clear, faint = np.flatnonzero(labels.clear), np.flatnonzero(~labels.clear)
    return SyntheticScene(
        image=read_out(photo, sensor, rng),
        labels=labels.segments.select(clear),
        camera=describe_camera(lens_map.lens),
        line_ids=labels.line_ids[clear],
        kinds=tuple(labels.kinds[index] for index in clear),
        ambiguous=labels.segments.select(faint),
        ambiguous_ids=labels.line_ids[faint],
        ambiguous_kinds=tuple(labels.kinds[index] for index in faint),
        distractors=curves.segments,
        distractor_ids=curves.line_ids,
        distractor_kinds=curves.kinds,
        reasons=tuple(REASON_OF[kind] for kind in curves.kinds),
    )
