"""Data sets of scenes: cameras that drive through streets, a few images in each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from app.errors import InvalidInput
from app.synthesis.lens import LENS_KINDS, Lens, draw_lens
from app.synthesis.light import TIMES_OF_DAY
from app.synthesis.planning import plan_street
from app.synthesis.poses import driving_pose
from app.synthesis.scene import SyntheticScene, check_scene, photograph
from app.synthesis.sensor import draw_motion, draw_sensor, map_lens

SEQUENCE_LENGTH = 4
STREETS_PER_CAMERA = 6
STEP = 3.2  # m between images of a drive
_FIRST_KIND = LENS_KINDS.index("wide")


@dataclass(frozen=True, eq=False)
class Drive:
    """Images of one camera in one street.

    Attributes:
        seed: Of the data set.
        number: Of the drive.
        camera: Number of its camera.
        lens: Of that camera.
        first: Number of its first image in the data set.
        count: Number of its images.
    """

    seed: int
    number: int
    camera: int
    lens: Lens
    first: int
    count: int

    @property
    def name(self) -> str:
        """Its street's name, ``street-03``."""
        return f"street-{self.number:02d}"


def plan_drives(
    count: int,
    seed: int,
    *,
    width: int = 1280,
    height: int = 720,
    lens: Lens | None = None,
    sequence_length: int = SEQUENCE_LENGTH,
) -> list[Drive]:
    """Divide a data set into drives; the same seed gives the same images whatever their count.

    Each camera has `STREETS_PER_CAMERA` drives; lenses are wide, plain and mild in turns.

    Args:
        count: Number of images.
        seed: From 0 up.
        width: Image width in px.
        height: Image height in px.
        lens: The one lens of all images; one per camera is drawn from the seed where none is given.
        sequence_length: Images per drive, each some metres on from the one before.

    Raises:
        InvalidInput: On a negative seed or count, a size out of bounds, a sequence of no images or a lens made for
            another size.
    """
    check_scene(seed, width, height, lens)
    if count < 0 or sequence_length < 1:
        raise InvalidInput(
            f"{count} images in sequences of {sequence_length}",
            where="count",
            expected="a count from 0, sequences from 1",
        )
    lenses: dict[int, Lens] = {}
    drives: list[Drive] = []
    for number, first in enumerate(range(0, count, sequence_length)):
        camera = number // STREETS_PER_CAMERA if lens is None else 0
        if camera not in lenses:
            kind = LENS_KINDS[(_FIRST_KIND + camera) % len(LENS_KINDS)]
            lenses[camera] = lens or draw_lens(np.random.default_rng([seed, 20, camera]), width, height, kind)
        drives.append(Drive(seed, number, camera, lenses[camera], first, min(sequence_length, count - first)))
    return drives


def drive_scenes(drive: Drive) -> Iterator[tuple[str, SyntheticScene]]:
    """Make the images of a drive: names like ``street-00/000003`` with scenes."""
    lens_map = map_lens(drive.lens)
    sensor = draw_sensor(np.random.default_rng([drive.seed, 24, drive.camera]))
    street_seed = int(np.random.default_rng([drive.seed, 21, drive.number]).integers(2**31))
    street = plan_street(street_seed, TIMES_OF_DAY[drive.number % len(TIMES_OF_DAY)])
    for step in range(drive.count):
        index = drive.first + step
        pose = driving_pose(street, step * STEP, np.random.default_rng([drive.seed, 22, index]))
        rng = np.random.default_rng([drive.seed, 23, index])
        moved = replace(sensor, motion=draw_motion(rng))
        yield f"{drive.name}/{index:06d}", photograph(street, pose, lens_map, moved, rng)


def synthesize_dataset(
    count: int,
    seed: int,
    *,
    width: int = 1280,
    height: int = 720,
    lens: Lens | None = None,
    sequence_length: int = SEQUENCE_LENGTH,
) -> Iterator[tuple[str, SyntheticScene]]:
    """Make the images of all drives, one after the other; see `plan_drives`."""
    drives = plan_drives(count, seed, width=width, height=height, lens=lens, sequence_length=sequence_length)
    return (made for drive in drives for made in drive_scenes(drive))
