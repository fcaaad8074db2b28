"""How long scoring takes, how its cost grows, and whether it agrees with a scorer written independently.

python benchmarks/evaluation.py [--json] [--york DIR] [--images 156]

Speed is measured on made-up images of 300 labels and 300 predictions of 200 points each. official-v1 is timed against
a plain Python double loop over the same formula, on the same images in the same process; both by processor time, as
other programs may run. clearlines-v2 is timed as the server scores a submission: every protocol, M1 to M10, strata,
error types, and the intervals of a bootstrap of 2000 draws, by wall time, images in a process for each core. Agreement
is measured on the York Urban photos.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import cv2
import numpy as np
from shared.detectors import Detector, clearlines, opencv_lsd
from shared.plain_official import precision_and_recall
from shared.reference_scorer import load_reference_scorer, reference_counts
from shared.reporting import Target, argument_parser, finish, show_table
from shared.scored_scenes import SIZE, scene
from shared.york import MIN_LENGTH, read_gray

from app.evaluation import GroundTruth, ground_truth, long_enough, official_v1, protocol_named, total
from app.evaluation.bootstrap import DRAWS
from app.evaluation.clearlines_v2 import ImageScore, score_image
from app.evaluation.submission_scoring import (
    ImageRecord,
    ScoredImage,
    SplitImageInfo,
    score_cameras,
    score_part,
    score_totals,
)
from app.formats.inert_npy import read_label_npy
from app.vision import Segments

SEGMENTS, POINTS, IMAGES = 300, 200, 156
PROCESSES = 2
CAMERAS = 3
CLEARLINES = protocol_named("clearlines-v2")
TARGETS = (
    Target("official_times_faster", 50.0, at_most=False),
    Target("official_difference", 1e-12),
    Target("clearlines_seconds", 60.0),
    Target("growth", 1.1),
    Target("agreement", 0.005),
)

Image = tuple[GroundTruth, Segments]


def seconds(work: Callable[[], object]) -> float:
    """Return the processor time that some work takes in this thread, s."""
    start = time.thread_time()
    work()
    return time.thread_time() - start


def compare_official(images: Sequence[Image]) -> dict[str, float]:
    """Time official-v1 against the double loop and compare their results; no label is ignored."""
    segments = [(truth.segments, predictions) for truth, predictions in images]
    truths = [ground_truth(labels) for labels, _ in segments]
    plain = [tuple([list(map(tuple, line.tolist())) for line in side] for side in pair) for pair in segments]
    scores: list[official_v1.ImageScore] = []
    shares: list[tuple[float, float]] = []
    ours = seconds(
        lambda: scores.extend(
            official_v1.score_image(truth, predictions)
            for truth, (_, predictions) in zip(truths, segments, strict=True)
        )
    )
    loop = seconds(lambda: shares.extend(precision_and_recall(labels, found) for labels, found in plain))
    found = official_v1.total(scores)
    expected = np.mean(shares, axis=0)
    difference = float(np.abs(expected - (found.precision, found.recall)).max())
    return {
        "official_seconds": ours,
        "official_loop_seconds": loop,
        "official_times_faster": loop / ours,
        "official_difference": difference,
    }


def submission(images: Sequence[Image]) -> list[ScoredImage]:
    """Return the images as a submission has them, a third of them of each camera."""
    return [
        ScoredImage(SplitImageInfo(f"image {index}", *SIZE, camera=f"camera {index % CAMERAS}"), truth, predictions)
        for index, (truth, predictions) in enumerate(images)
    ]


def time_clearlines(images: Sequence[ScoredImage]) -> dict[str, float]:
    """Time the scoring of a submission: wall time, and processor time of all processes."""
    with ProcessPoolExecutor(PROCESSES) as pool:
        list(pool.map(_timed_record, images[:PROCESSES]))  # processes are there before the clock runs
        start = time.perf_counter()
        results = list(pool.map(_timed_record, images, chunksize=4))
        records = [record for record, _ in results]
        adding = seconds(lambda: add_up(images, records))
        whole = time.perf_counter() - start
    return {
        "clearlines_seconds": whole,
        "clearlines_processor_seconds": sum(elapsed for _, elapsed in results) + adding,
        "clearlines_totals_seconds": adding,
    }


def growth(images: Sequence[ScoredImage]) -> dict[str, float]:
    """Time the scoring of a quarter, a half and all of the images, one thread, processor time."""
    figures, per_image = {}, []
    for count in (len(images) // 4, len(images) // 2, len(images)):
        elapsed = seconds(lambda count=count: add_up(images[:count], score_part(images[:count])))
        figures[f"clearlines_one_thread_seconds_{count}"] = elapsed
        per_image.append(elapsed / count)
    return figures | {"clearlines_milliseconds_per_image": 1000 * per_image[-1], "growth": per_image[-1] / per_image[0]}


def add_up(images: Sequence[ScoredImage], records: Sequence[ImageRecord]) -> dict[str, object]:
    """Return every metric of the images with its interval, the cameras' calibration included."""
    return score_totals([image.info for image in images], records, score_cameras(images), draws=DRAWS)


def f1(scores: Sequence[ImageScore]) -> float:
    """Return F1 of the images together."""
    return float(total(CLEARLINES, np.stack([score.tallies for score in scores]))["f1"])


def _score(image: Image) -> ImageScore:
    return score_image(*image)


def _timed_record(image: ScoredImage) -> tuple[ImageRecord, float]:
    start = time.thread_time()
    return score_part([image])[0], time.thread_time() - start


def compare_with_reference(york: Path) -> dict[str, float]:
    """Compare F1 with the reference without ignored labels, and with what it is when short labels are ignored."""
    reference = load_reference_scorer()
    if reference is None or not york.is_dir():
        print("no agreement measured: the photos or the reference scorer aren't there")
        return {}
    photos = [
        (read_gray(path), read_label_npy((york / "labels" / f"{path.stem}_edge_segments_filtered.npy").read_bytes()))
        for path in sorted((york / "images").iterdir())
    ]
    figures: dict[str, float] = {}
    rows, differences = [], []
    detectors: dict[str, Detector] = {"ClearLines": clearlines(MIN_LENGTH), "OpenCV LSD": opencv_lsd()}
    for name, detector in detectors.items():
        found = [long_enough(detector(gray), MIN_LENGTH) for gray, _ in photos]
        long_labels = [long_enough(labels, MIN_LENGTH) for _, labels in photos]
        counts = reference_counts(reference, long_labels, found)
        expected = 2 * counts["tp"] / (2 * counts["tp"] + counts["fp"] + counts["fn"])
        without = f1([_score((ground_truth(truth), each)) for truth, each in zip(long_labels, found, strict=True)])
        with_rule = f1(
            [
                _score((ground_truth(labels, min_length=MIN_LENGTH), each))
                for (_, labels), each in zip(photos, found, strict=True)
            ]
        )
        differences.append(abs(without - expected) / expected)
        rows.append([name, f"{expected:.5f}", f"{without:.5f}", f"{with_rule:.5f}", f"{with_rule - without:+.5f}"])
        key = name.lower().replace(" ", "_")
        figures |= {f"{key}_f1_reference": expected, f"{key}_f1": without, f"{key}_f1_ignoring_short": with_rule}
    columns = ["detector", "reference", "ours, rule off", "rule on", "difference the rule makes"]
    show_table(f"F1 on {len(photos)} photos; the rule ignores labels below {MIN_LENGTH:g} px", columns, rows)
    return figures | {"agreement": max(differences)}


def show_times(figures: dict[str, float], images: int) -> None:
    """Print what was timed."""
    growing = [(name.rsplit("_", 1)[1], value) for name, value in figures.items() if "one_thread" in name]
    rows = [
        ["official-v1, plain double loop", str(images), f"{figures['official_loop_seconds']:.2f}"],
        [
            f"official-v1, {figures['official_times_faster']:.0f} times faster",
            str(images),
            f"{figures['official_seconds']:.3f}",
        ],
        *[["clearlines-v2, all metrics and intervals, one thread", count, f"{value:.2f}"] for count, value in growing],
        [f"the same, {PROCESSES} processes", str(images), f"{figures['clearlines_processor_seconds']:.2f}"],
        [f"the same, {PROCESSES} processes, wall time", str(images), f"{figures['clearlines_seconds']:.2f}"],
    ]
    show_table(f"Scoring images of {SEGMENTS} segments x {POINTS} points", ["processor time", "images", "s"], rows)


def main() -> None:
    parser = argument_parser(str(__doc__), "york")
    parser.add_argument("--images", type=int, default=IMAGES, help=f"made-up images, default {IMAGES}")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    images = [scene(seed, SEGMENTS, POINTS) for seed in range(options.images)]
    handed_in = submission(images)
    figures = compare_official(images) | time_clearlines(handed_in) | growth(handed_in)
    show_times(figures, len(images))
    figures |= compare_with_reference(options.york)
    finish(figures, TARGETS, as_json=options.json)


if __name__ == "__main__":
    main()
