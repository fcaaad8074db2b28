"""Whole scenes and data sets of them: a street, a lens, a photo and its labels."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.synthesis.camera import Pose, SyntheticCamera, describe_camera
from app.synthesis.labels import label_curves, label_edges
from app.synthesis.lens import Lens, draw_lens
from app.synthesis.light import TIMES_OF_DAY
from app.synthesis.planning import plan_street
from app.synthesis.rasteriser import Haze, rasterise
from app.synthesis.sensor import LensMap, Sensor, expose, map_lens, read_out
from app.synthesis.sky import paint_sky
from app.synthesis.street import Street, draw_street
from app.vision.segments import Segments

EYE_HEIGHT = 1.6  # m
SEQUENCE_STEP = 3.2  # m between images of a sequence
SMALLEST, LARGEST = 64, 8192  # px


@dataclass(frozen=True, eq=False)
class SyntheticScene:
    """A street image with all that is true about it.

    Attributes:
        image: uint8 ``(H, W, 3)``: blue, green, red, as OpenCV writes them.
        labels: The visible parts of straight edges, a point about every px, exact.
        camera: The lens, in OpenCV's form and in the undistort direction.
        line_ids: Which straight edge of the street each label belongs to, int64 ``(S,)``: fragments of one edge
            (with a tree in front of its middle) share it.
        kinds: What each label is an edge of ("window pane", "kerb", "shadow"...), one per label.
        distractors: The visible parts of edges that are not straight in the street (those that are known).
        reasons: Why each of them isn't ("hanging wire", "curved kerb"...).
    """

    image: NDArray[np.uint8]
    labels: Segments
    camera: SyntheticCamera
    line_ids: NDArray[np.int64]
    kinds: tuple[str, ...]
    distractors: Segments
    reasons: tuple[str, ...]


def synthesize_scene(
    seed: int, *, width: int = 1280, height: int = 720, lens: Lens | None = None, sensor: Sensor | None = None
) -> SyntheticScene:
    """Make one street image with its labels; the same seed makes the same image.

    Args:
        seed: From 0 up.
        width: Image width in px.
        height: Image height in px.
        lens: The lens; drawn from the seed where none is given.
        sensor: Blur, vignetting and noise; a usual camera's where none is given.

    Raises:
        InvalidInput: On a negative seed, a size out of bounds or a lens made for another size.
    """
    _check(seed, width, height, lens)
    rng = np.random.default_rng([seed, 10])
    lens_map = map_lens(lens or draw_lens(rng, width, height))
    street = plan_street(seed, TIMES_OF_DAY[seed % len(TIMES_OF_DAY)])
    pose = _place(street, 0.0, rng)
    return _photograph(street, pose, lens_map, sensor or Sensor(), np.random.default_rng([seed, 11]))


def synthesize_dataset(
    count: int,
    seed: int,
    *,
    width: int = 1280,
    height: int = 720,
    lens: Lens | None = None,
    sequence_length: int = 4,
) -> Iterator[tuple[str, SyntheticScene]]:
    """Make images of one camera that drives through streets: yields names like ``street-00/000003`` with scenes.

    Args:
        count: Number of images.
        seed: From 0 up; the same seed makes the same images whatever their count.
        width: Image width in px.
        height: Image height in px.
        lens: The one lens of all images; drawn from the seed where none is given.
        sequence_length: Images per street, each some metres on from the one before.

    Raises:
        InvalidInput: As `synthesize_scene`; also on a negative count or a sequence of no images.
    """
    _check(seed, width, height, lens)
    if count < 0 or sequence_length < 1:
        raise InvalidInput(
            f"{count} images in sequences of {sequence_length}",
            where="count",
            expected="a count from 0, sequences from 1",
        )
    return _drive(count, seed, lens or draw_lens(np.random.default_rng([seed, 20]), width, height), sequence_length)


def _drive(count: int, seed: int, lens: Lens, sequence_length: int) -> Iterator[tuple[str, SyntheticScene]]:
    lens_map = map_lens(lens)
    street: Street | None = None
    for index in range(count):
        sequence, step = divmod(index, sequence_length)
        if street is None or step == 0:
            street_seed = int(np.random.default_rng([seed, 21, sequence]).integers(2**31))
            street = plan_street(street_seed, TIMES_OF_DAY[sequence % len(TIMES_OF_DAY)])
        pose = _place(street, step * SEQUENCE_STEP, np.random.default_rng([seed, 22, index]))
        scene = _photograph(street, pose, lens_map, Sensor(), np.random.default_rng([seed, 23, index]))
        yield f"street-{sequence:02d}/{index:06d}", scene


def _check(seed: int, width: int, height: int, lens: Lens | None) -> None:
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


def _place(street: Street, forward: float, rng: np.random.Generator) -> Pose:
    """Put the camera into its lane, looking down the street as a driving car does: not quite."""
    yaw, pitch, roll = rng.normal(0, [0.035, 0.012, 0.008]).clip(-0.09, 0.09)
    position = np.array([street.lane + float(rng.normal(0, 0.12)), -EYE_HEIGHT, forward])
    return Pose(position, float(yaw), float(pitch) + 0.03, float(roll))


def _photograph(
    street: Street, pose: Pose, lens_map: LensMap, sensor: Sensor, rng: np.random.Generator
) -> SyntheticScene:
    view = lens_map.view(pose)
    drawing = draw_street(street, pose.position)
    haze = Haze(street.light.horizon, street.light.haze)
    picture = rasterise(drawing, view, paint_sky(view, street.light, street.seed), haze)
    photo = expose(picture.colours, lens_map, sensor)
    labels = label_edges(drawing, view, lens_map, picture, photo)
    curves = label_curves(drawing, view, lens_map, picture, photo)
    return SyntheticScene(
        image=read_out(photo, sensor, rng),
        labels=labels.segments,
        camera=describe_camera(lens_map.lens),
        line_ids=labels.line_ids,
        kinds=labels.kinds,
        distractors=curves.segments,
        reasons=curves.kinds,
    )
