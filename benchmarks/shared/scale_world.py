"""What the tables of a large installation hold: which images there are, how they were reviewed, what was found in them.

Everything follows from a seed and a share: one per cent of it has the same datasets with a hundredth of the images.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

IMAGES = (60_000, 15_000, 10_000, 5_000, *(2_000,) * 3, *(200,) * 20)
"""Images of each dataset at the full size: a hundred thousand in all."""
SEGMENTS_PER_IMAGE = 105
"""Mean number, those that a later run replaced included."""
SEQUENCE = 200
"""Images of a drive."""
SOURCES = ("KITTI", "BDD", "nuScenes", "Argoverse", "dashcam", "survey")
PEOPLE = ("Ada", "Björn", "Chen", "Dalia", "Emil", "Fatou", "Goran", "Hana")
SIZES = ((1242, 375), (1280, 720), (1600, 900), (1920, 1200), (1280, 960), (2048, 1536))
STATES = ("open", "done", "discarded")
OPEN, DONE, DISCARDED = range(3)
REVIEWED = 0.29
BEGUN = 1_735_689_600.0  # s since 1970; the first of January 2025
DAY = 86_400.0
HIDDEN_DATASET = 6
"""A hidden split was made from this dataset."""


@dataclass(frozen=True, eq=False)
class World:
    """N images; ids begin with 1 and follow the rows.

    Attributes:
        share: Of the full size.
        dataset: Number of the dataset of each image, from 0, ``(N,)``.
        first: Row of each dataset's first image, and one past the last.
        sequence: Number of the drive in the dataset, ``(N,)``.
        source: Into ``SOURCES``, ``(N,)``.
        camera: Row of the camera, ``(N,)``.
        camera_dataset: Dataset of each camera.
        camera_source: Source, and so the size, of each camera.
        status: Into ``STATES``, ``(N,)``.
        assignee: Into ``PEOPLE``, -1 for nobody, ``(N,)``.
        person: Who reviewed it, into ``PEOPLE``, ``(N,)``.
        added: When, s, ``(N,)``.
        reviewed: When, s; not a number for those that are open, ``(N,)``.
        candidates: Number of current segments, ``(N,)``.
        replaced: Number of segments that the second run replaced, ``(N,)``.
        failed: Whether the last run failed on it, ``(N,)``.
    """

    share: float
    dataset: NDArray[np.int64]
    first: NDArray[np.int64]
    sequence: NDArray[np.int64]
    source: NDArray[np.int64]
    camera: NDArray[np.int64]
    camera_dataset: NDArray[np.int64]
    camera_source: NDArray[np.int64]
    status: NDArray[np.int64]
    assignee: NDArray[np.int64]
    person: NDArray[np.int64]
    added: NDArray[np.float64]
    reviewed: NDArray[np.float64]
    candidates: NDArray[np.int64]
    replaced: NDArray[np.int64]
    failed: NDArray[np.bool_]

    @property
    def images(self) -> int:
        """Number of images."""
        return len(self.dataset)

    @property
    def starts(self) -> NDArray[np.int64]:
        """Id of the first current segment of each image, and one past the last, ``(N + 1,)``; replaced ones follow."""
        return 1 + np.concatenate([[0], np.cumsum(self.candidates)])

    @property
    def segments(self) -> int:
        """Number of segments, replaced ones included."""
        return int(self.candidates.sum() + self.replaced.sum())

    @property
    def names(self) -> list[str]:
        """Name of each image."""
        within = np.arange(self.images) - self.first[self.dataset]
        return [
            f"{SOURCES[source]}/drive_{drive:04d}/{number:07d}"
            for source, drive, number in zip(self.source, self.sequence, within, strict=True)
        ]


def make_world(share: float, seed: int) -> World:
    """Return the installation at a share of its full size."""
    random = np.random.default_rng([seed, round(share * 1e6)])
    sizes = np.maximum(2, np.round(np.array(IMAGES) * share).astype(np.int64))
    first = np.concatenate([[0], np.cumsum(sizes)])
    dataset = np.repeat(np.arange(len(sizes)), sizes)
    within = np.arange(len(dataset)) - first[dataset]
    sequence = within // SEQUENCE
    source = (sequence + dataset) % len(SOURCES)
    camera_key, camera = np.unique(dataset * 100 + source * 10 + sequence % 2, return_inverse=True)
    images = len(dataset)

    # drives are reviewed one after the other, most of the large datasets still waits
    place = within / sizes[dataset]
    done = place < REVIEWED
    odd = random.random(images) < 0.004
    status = np.where(odd, DISCARDED, np.where(done, DONE, OPEN))
    person = (sequence * 7 + dataset) % len(PEOPLE)
    assigned = place < 0.5
    added = BEGUN + dataset * DAY + within * 0.4
    reviewed = BEGUN + DAY * (30 + 300 * place) + random.random(images) * DAY / 2

    busy = random.lognormal(0, 0.35, images)
    replaced_share = 0.05
    candidates = np.round(SEGMENTS_PER_IMAGE * (1 - replaced_share) * busy / busy.mean()).astype(np.int64)
    old_run = place < 0.2
    replaced = np.where(old_run, np.round(candidates * replaced_share * 5), 0).astype(np.int64)
    failed = (random.random(images) < 0.003) & (status == OPEN)
    return World(
        share=share,
        dataset=dataset,
        first=first,
        sequence=sequence,
        source=source,
        camera=camera,
        camera_dataset=camera_key // 100,
        camera_source=camera_key // 10 % 10,
        status=status,
        assignee=np.where(assigned, person, -1),
        person=person,
        added=added,
        reviewed=np.where(status == OPEN, np.nan, reviewed),
        candidates=np.where(failed, 0, candidates),
        replaced=np.where(failed, 0, replaced),
        failed=failed,
    )
