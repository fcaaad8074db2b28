"""Whether detectors come in one order on synthetic scenes and on photos: the point of having scenes at all.

python benchmarks/synthetic_ranking.py [--json] [--york DIR] [--scenes 100]

Every detector runs on the York Urban photos and on as many synthetic scenes of their size, each of a street and a lens
of its own. Both are scored by protocol clearlines-v2 (labels of less than 50 px are ignored, shorter findings are left
out) and by one-to-one matches of what has 50 px and more. The orders are compared by Spearman's and Kendall's rank
correlation; intervals are 95 %, by resampling the photos and the scenes.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from shared.detectors import take_turns
from shared.peers import NAMES, PeersUnavailable, run_peers
from shared.rank_agreement import Agreement, agreement, draws, places
from shared.ranked_detectors import ranked_detectors
from shared.reporting import Target, argument_parser, finish, show_table
from shared.strict_score import count, overlap
from shared.york import MIN_LENGTH, read_gray

from app.evaluation import ground_truth, long_enough, protocol_named, total
from app.evaluation.clearlines_v2 import score_image
from app.formats.inert_npy import read_label_npy
from app.synthesis import synthesize_scene
from app.vision import Segments

SIZE = (640, 480)
FIRST_SEED = 6000
RESAMPLES = 1000
METRICS = ("f1", "recall", "precision", "one_to_one_f1")
WORDS = {"f1": "F1", "recall": "recall", "precision": "precision", "one_to_one_f1": "F1, 1:1"}
TARGETS = (
    Target("spearman_f1", 0.8, at_most=False),
    Target("spearman_f1_low", 0.6, at_most=False),
    Target("detectors", 8, at_most=False),
)


@dataclass(frozen=True, eq=False)
class Image:
    """An image to score on: uint8 ``(H, W)``, its labels, and what may be found or not."""

    gray: NDArray[np.uint8]
    labels: Segments
    ambiguous: Segments


@dataclass(frozen=True, eq=False)
class Scores:
    """Scores of D detectors on one set of images.

    Attributes:
        values: By metric, ``(D,)``.
        drawn: By metric, when the images are drawn anew, ``(B, D)``.
    """

    values: Mapping[str, NDArray[np.float64]]
    drawn: Mapping[str, NDArray[np.float64]]


def make_scene(seed: int) -> Image:
    """Return a synthetic scene."""
    cv2.setNumThreads(1)
    scene = synthesize_scene(seed, width=SIZE[0], height=SIZE[1])
    gray = np.asarray(cv2.cvtColor(scene.image, cv2.COLOR_BGR2GRAY), np.uint8)
    return Image(gray, scene.labels, scene.ambiguous)


def find_all(photos: Sequence[Image]) -> dict[str, Sequence[Segments]]:
    """Run every detector that runs here; what is too short is left out."""
    images = [photo.gray for photo in photos]
    found = {name: each.segments for name, each in take_turns(ranked_detectors(MIN_LENGTH), images).items()}
    try:
        found |= {NAMES[name]: each.segments for name, each in run_peers(images).items()}
    except PeersUnavailable as reason:
        print(f"EDLines, FastLineDetector: opencv-contrib is not installable here: {reason}")
    return {name: [long_enough(each, MIN_LENGTH) for each in segments] for name, segments in found.items()}


def score_detector(photos: Sequence[Image], weights: NDArray[np.int64], found: Sequence[Segments]) -> NDArray:
    """Return the `METRICS` of one detector for each row of weights ``(B, N)``: float64 ``(M, B)``."""
    tallies = np.stack(
        [
            score_image(ground_truth(photo.labels, photo.ambiguous, min_length=MIN_LENGTH), segments).tallies
            for photo, segments in zip(photos, found, strict=True)
        ]
    )
    totals = total(protocol_named("clearlines-v2"), tallies, weights=weights.astype(np.float64))
    labels = [long_enough(photo.labels, MIN_LENGTH) for photo in photos]
    counts = count(found, labels, overlap(found, labels))
    one_to_one = 2 * weights @ counts.hits / np.maximum(weights @ (counts.predictions + counts.labels), 1)
    return np.stack([*(totals[name] for name in METRICS[:-1]), one_to_one])


def score_set(photos: Sequence[Image], found: Mapping[str, Sequence[Segments]], seed: int) -> Scores:
    """Score every detector on one set of images."""
    weights = np.concatenate([np.ones((1, len(photos)), np.int64), draws(len(photos), RESAMPLES, seed)])
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        every = np.stack(list(pool.map(partial(score_detector, photos, weights), found.values())), axis=-1)
    return Scores(
        {name: every[row, 0] for row, name in enumerate(METRICS)},
        {name: every[row, 1:] for row, name in enumerate(METRICS)},
    )


def show_scores(names: Sequence[str], scenes: Scores, photos: Scores) -> None:
    order = np.argsort(places(photos.values["f1"]))
    ranks = {metric: (places(scenes.values[metric]), places(photos.values[metric])) for metric in METRICS}
    rows = [
        [
            names[row],
            *(
                f"{side.values[metric][row]:.3f} ({ranks[metric][index][row]})"
                for metric in METRICS
                for index, side in enumerate((scenes, photos))
            ),
        ]
        for row in order
    ]
    columns = ["detector", *(word for metric in METRICS for word in (WORDS[metric], "York"))]
    show_table("Scores (and places) on synthetic scenes, and on York behind each", columns, rows)


def agreement_with_itself(scores: Scores, metric: str) -> Agreement:
    """Compare one set's images with other draws of the same images: what agreement is there to be had."""
    half = RESAMPLES // 2
    values, drawn = scores.values[metric], scores.drawn[metric]
    return agreement(values, values, drawn[:half], drawn[half:])


def show_agreement(title: str, agreements: Mapping[str, Agreement]) -> None:
    rows = [
        [
            WORDS[metric],
            "{:.2f} ({:.2f} to {:.2f})".format(each.spearman, *each.spearman_interval),
            "{:.2f} ({:.2f} to {:.2f})".format(each.kendall, *each.kendall_interval),
        ]
        for metric, each in agreements.items()
    ]
    show_table(f"Rank correlation of {title} (95 % intervals)", ["by", "Spearman", "Kendall"], rows)


def main() -> None:
    parser = argument_parser(str(__doc__), "york")
    parser.add_argument("--scenes", type=int, default=100, help="synthetic scenes, default 100")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    if not options.york.is_dir():
        print(f"no data: {options.york} is not there")
        finish({}, [], as_json=options.json)
        return
    photos = [
        Image(read_gray(path), read_label_npy(label_file(options.york, path.stem).read_bytes()), Segments.empty())
        for path in sorted((options.york / "images").iterdir())
    ]
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        scenes = list(pool.map(make_scene, range(FIRST_SEED, FIRST_SEED + options.scenes), chunksize=5))
    found_scenes, found_photos = find_all(scenes), find_all(photos)
    names = list(found_photos)
    on_scenes, on_photos = score_set(scenes, found_scenes, 0), score_set(photos, found_photos, 1)
    for title, images in (("scenes", scenes), ("York", photos)):
        long = sum(len(long_enough(image.labels, MIN_LENGTH)) for image in images)
        print(f"{title}: {len(images)} images, {long / len(images):.0f} labels of {MIN_LENGTH:g} px and more each")
    show_scores(names, on_scenes, on_photos)
    agreements = {
        metric: agreement(
            on_scenes.values[metric], on_photos.values[metric], on_scenes.drawn[metric], on_photos.drawn[metric]
        )
        for metric in METRICS
    }
    show_agreement("scenes and York", agreements)
    show_agreement(
        "York and York, its photos drawn twice",
        {metric: agreement_with_itself(on_photos, metric) for metric in METRICS},
    )
    figures: dict[str, float | None] = {"detectors": float(len(names))}
    for metric, each in agreements.items():
        for word, value, (low, high) in (
            ("spearman", each.spearman, each.spearman_interval),
            ("kendall", each.kendall, each.kendall_interval),
        ):
            figures |= {f"{word}_{metric}": value, f"{word}_{metric}_low": low, f"{word}_{metric}_high": high}
    for row, name in enumerate(names):
        key = name.lower().replace(",", "").replace(" ", "_")
        figures |= {f"{key}_f1_scenes": on_scenes.values["f1"][row], f"{key}_f1_york": on_photos.values["f1"][row]}
    finish(figures, TARGETS, as_json=options.json)


def label_file(york: Path, stem: str) -> Path:
    """Return where the labels of a photo lie."""
    return york / "labels" / f"{stem}_edge_segments_filtered.npy"


if __name__ == "__main__":
    main()
