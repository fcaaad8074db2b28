"""Images with candidates by the page's default run, their features, and which of them are true."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from app.evaluation.matching import match_segments
from app.formats.inert_npy import read_label_npy
from app.review.families import families
from app.review.features import candidate_features
from app.synthesis import synthesize_scene
from app.vision import DetectionParameters, Segments, detect_for_prelabel, estimate_distortion, judge_straightness
from app.vision.division import Division
from app.vision.sampson import sampson_residuals

from .review_replay import KEEP, REJECT, Page
from .review_strokes import strokes
from .york import read_gray

SIZES = ((1280, 720), (960, 640), (1024, 768), (800, 600))
"""Of the synthetic scenes, taking turns."""


@dataclass(frozen=True, eq=False)
class ReviewImage:
    """An image before its review.

    Attributes:
        name: File name without its extension, or the scene's seed.
        features: float32 ``(S, F)``.
        kept: bool ``(S,)``, whether a candidate matches a label: one-to-one, by line IoU of at least 0.5.
        labels: Labels as long as the shortest candidate may be.
        page: For the replay.
    """

    name: str
    features: NDArray[np.float32]
    kept: NDArray[np.bool_]
    labels: int
    page: Page


def york_images(folder: Path) -> Iterator[ReviewImage]:
    """Yield the photos of York in the order of their names."""
    for path in sorted((folder / "images").iterdir()):
        labels = read_label_npy((folder / "labels" / f"{path.stem}_edge_segments_filtered.npy").read_bytes())
        yield review_image(path.stem, read_gray(path), labels)


def synthetic_images(count: int, first_seed: int) -> Iterator[ReviewImage]:
    """Yield synthetic scenes, each of its own street and lens."""
    for number in range(count):
        width, height = SIZES[number % len(SIZES)]
        scene = synthesize_scene(first_seed + number, width=width, height=height)
        gray = np.asarray(cv2.cvtColor(scene.image, cv2.COLOR_BGR2GRAY), np.uint8)
        yield review_image(str(first_seed + number), gray, scene.labels)


def review_image(name: str, gray: NDArray[np.uint8], labels: Segments) -> ReviewImage:
    """Detect and describe the candidates of an image as the server does for an image with a lens of its own.

    Args:
        name: Of the image.
        gray: uint8 ``(H, W)``.
        labels: All true lines, px.
    """
    parameters = DetectionParameters()
    found = detect_for_prelabel(gray, parameters)
    size, candidates = (found.width, found.height), found.candidates
    lens = estimate_distortion([found.lens_segments], size)
    residuals = sampson_residuals(candidates, lens.division if lens.accepted else Division(*size))
    squares = np.bincount(candidates.segment_of_point, residuals**2, len(candidates))
    features = candidate_features(
        candidates,
        gray=gray,
        size=size,
        residuals=np.sqrt(squares / candidates.counts),
        straightness=judge_straightness(candidates, lens),
        lens=lens,
    )
    kept = np.zeros(len(candidates), bool)
    kept[match_segments(candidates, labels).row] = True
    page = Page(
        strokes(candidates, size),
        np.where(kept, KEEP, REJECT).astype(np.int64),
        families(candidates, size),
    )
    return ReviewImage(name, features, kept, int((labels.lengths() >= parameters.min_length).sum()), page)
