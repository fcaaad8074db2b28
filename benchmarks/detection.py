"""Precision and recall of our detector on real photos, beside OpenCV's LSD and the detectors of opencv-contrib.

python benchmarks/detection.py [--json] [--york DIR] [--plot FILE.svg]

A segment found and a labelled line are matched one-to-one when their line IoU is at least 0.5; lines of 50 px and more
count, over all photos together. Length recall is the share of the labelled length that any segment covers. The labels
hold the three Manhattan directions only, so precision is a lower bound. Intervals are 95 %, by resampling photos.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from shared.bootstrap import interval
from shared.detectors import Detector, Found, clearlines, opencv_lsd, take_turns
from shared.peers import NAMES, PeersUnavailable, run_peers
from shared.ranking import Ranking, rank
from shared.reporting import Target, argument_parser, finish, show_table
from shared.strict_score import THRESHOLD, Counts, count, overlap
from shared.svg_chart import Curve, Mark, write_chart
from shared.york import MIN_LENGTH, Photo, read_photos

NAMES_OF_OURS = {point: f"ClearLines, {point}" for point in ("recall", "balanced", "precise")}
PRINTED = {**NAMES_OF_OURS, "lsd": "OpenCV LSD", **NAMES}
MARKED = {"recall": "recall", "balanced": "balanced", "precise": "precise", "lsd": "OpenCV LSD"} | {
    name: printed.split(",")[0] for name, printed in NAMES.items()
}
TARGETS = (
    Target("balanced_recall", 0.82, at_most=False),
    Target("balanced_precision", 0.20, at_most=False),
    Target("balanced_length_recall", 0.88, at_most=False),
    Target("precise_recall", 0.78, at_most=False),
    Target("precise_precision", 0.27, at_most=False),
    Target("area_gained_by_score_low", 0.0, at_most=False),
)
CURVE_POINTS = 300
LEAST_RECALL_DRAWN = 0.02


def find_all(photos: Sequence[Photo]) -> dict[str, Found]:
    """Run every detector that runs here on all photos, once; segments of less than `MIN_LENGTH` are left out."""
    detectors: dict[str, Detector] = {
        "recall": clearlines(MIN_LENGTH, "recall"),
        "balanced": clearlines(MIN_LENGTH, "balanced"),
        "precise": clearlines(MIN_LENGTH, "precise"),
        "lsd": opencv_lsd(),
    }
    images = [photo.gray for photo in photos]
    found = take_turns(detectors, images)
    try:
        found |= run_peers(images)
    except PeersUnavailable as reason:
        print(f"EDLines, FastLineDetector: opencv-contrib is not installable here: {reason}")
    return {name: _long_enough(result) for name, result in found.items()}


def _long_enough(found: Found) -> Found:
    return Found(tuple(each.select(each.lengths() >= MIN_LENGTH) for each in found.segments), found.seconds)


def figures_of(name: str, counts: Counts, milliseconds: float) -> dict[str, float]:
    """Return the figures of one detector, with the ends of their intervals."""
    figures = {}
    for word, statistic in (
        ("precision", counts.precision),
        ("recall", counts.recall),
        ("length_recall", counts.length_recall),
    ):
        low, high = interval(statistic, len(counts.hits))
        figures |= {f"{name}_{word}": statistic(counts.once), f"{name}_{word}_low": low, f"{name}_{word}_high": high}
    return figures | {f"{name}_candidates": float(counts.predictions.mean()), f"{name}_milliseconds": milliseconds}


def show_scores(figures: dict[str, float], names: Sequence[str]) -> None:
    rows = []
    for name in names:
        shares = [
            "{:.3f} ({:.3f}-{:.3f})".format(*(figures[f"{name}_{word}{end}"] for end in ("", "_low", "_high")))
            for word in ("precision", "recall", "length_recall")
        ]
        rows.append(
            [PRINTED[name], *shares, f"{figures[f'{name}_candidates']:.0f}", f"{figures[f'{name}_milliseconds']:.1f}"]
        )
    columns = ["detector", "precision", "recall", "length recall", "per image", "ms"]
    show_table("Detection (95 % intervals), one thread", columns, rows)


def compare_orders(by_score: Ranking, by_length: Ranking) -> dict[str, float]:
    """Return the areas under precision over recall of the same candidates in two orders, and their difference."""
    once = np.ones_like(by_score.labels)
    low, high = interval(lambda weights: by_score.area(weights) - by_length.area(weights), len(once))
    figures = {
        "area_by_score": by_score.area(once),
        "area_by_length": by_length.area(once),
        "area_gained_by_score_low": low,
        "area_gained_by_score_high": high,
    }
    recall = by_score.curve(once)[0][-1]
    gain = figures["area_by_score"] - figures["area_by_length"]
    show_table(
        f"Area under precision over recall, candidates of the recall point, recall 0 to {recall:.3f}",
        ["ordered by", "area"],
        [
            ["score", f"{figures['area_by_score']:.4f}"],
            ["length", f"{figures['area_by_length']:.4f}"],
            ["gained by the score", f"{gain:.4f} ({low:.4f} to {high:.4f})"],
        ],
    )
    return figures


def draw(path: Path, rankings: dict[str, Ranking], figures: dict[str, float], names: Sequence[str]) -> None:
    curves = []
    for order, ranking in rankings.items():
        recall, precision = ranking.curve(np.ones_like(ranking.labels))
        # the first few candidates alone make precision jump
        begin = int(np.searchsorted(recall, LEAST_RECALL_DRAWN))
        index = np.unique(np.linspace(begin, len(recall) - 1, CURVE_POINTS).astype(int))
        curves.append(Curve(f"ClearLines, by {order}", recall[index], precision[index]))
    marks = [Mark(MARKED[name], figures[f"{name}_recall"], figures[f"{name}_precision"]) for name in names]
    highest = min(1.0, np.ceil(10 * max(curve.y.max() for curve in curves)) / 10)
    write_chart(
        path, "Precision over recall, line IoU of at least 0.5", ("recall", "precision"), curves, marks, highest
    )
    print(f"drawn: {path}")


def main() -> None:
    parser = argument_parser(str(__doc__), "york")
    parser.add_argument("--plot", type=Path, help="draw precision over recall into this SVG file")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    if not options.york.is_dir():
        print(f"no data: {options.york} is not there")
        finish({}, [], as_json=options.json)
        return
    photos = read_photos(options.york)
    labels = [photo.labels for photo in photos]
    found = find_all(photos)
    overlaps = {name: overlap(result.segments, labels) for name, result in found.items()}
    figures: dict[str, float] = {}
    for name, result in found.items():
        figures |= figures_of(name, count(result.segments, labels, overlaps[name]), result.milliseconds)
    print(f"{len(photos)} photos, {sum(map(len, labels))} labelled lines of {MIN_LENGTH:g} px and more")
    show_scores(figures, list(found))

    candidates = found["recall"].segments
    scores = [np.zeros(len(each)) if each.scores is None else each.scores for each in candidates]
    keys = {"score": scores, "length": [each.lengths() for each in candidates]}
    rankings = {
        order: rank(values, [len(lines) for lines in labels], overlaps["recall"], THRESHOLD)
        for order, values in keys.items()
    }
    figures |= compare_orders(rankings["score"], rankings["length"])
    if options.plot:
        draw(options.plot, rankings, figures, list(found))
    finish(figures, TARGETS, as_json=options.json)


if __name__ == "__main__":
    main()
