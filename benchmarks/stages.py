"""What each stage of detection costs: its time, and the labelled lines that are lost in it.

python benchmarks/stages.py [--json] [--york DIR]

Times are those of one thread on the processor, each the best of three passes over a photo; OpenCV's LSD takes turns
with us.

A labelled line of 50 px and more is supported where edge points within 3 px and 15 degrees lie along 60 % of it;
chained where pieces, together, cover 60 % of it; findable after a later stage where one arc or segment has a line IoU
of at least 0.5 with it, which another line may share. Lost and gained are the lines that were findable after the stage
before and are no longer, and the other way round. Candidates are arcs or segments of 40 px and more.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from shared.reporting import Target, arguments, finish, show_table
from shared.stage_survival import Survival, survival
from shared.stage_times import LSD, STAGES, WHOLE, stage_times
from shared.york import MIN_LENGTH, Photo, read_photos

from app.vision import DetectionParameters

PASSES = 3
MATCHED_WORDS = "matched one-to-one"
# what a line is found in lies along its edge points: more than a few exceptions would mean that the measures disagree
TARGETS = (Target("validated_without_support", 0.005),)


def time_stages(photos: Sequence[Photo]) -> dict[str, float]:
    """Print and return the median milliseconds of each stage, and its share of the time of all photos."""
    times = stage_times([photo.gray for photo in photos], MIN_LENGTH, PASSES)
    medians = {name: float(np.median(each)) for name, each in times.items()}
    shares = {name: float(each.sum() / times[WHOLE].sum()) for name, each in times.items()}
    printed = dict.fromkeys(STAGES) | {WHOLE: None, LSD: None}
    words = {WHOLE: "all of detect", LSD: "OpenCV LSD"}
    show_table(
        f"Processor time, {len(photos)} photos, best of {PASSES}",
        ["stage", "ms, median", "of detect"],
        [[words.get(name, name), f"{medians[name]:.2f}", f"{shares[name]:.1%}"] for name in printed],
    )
    figures = {f"{_key(name)}_milliseconds": medians[name] for name in printed}
    return figures | {f"{_key(name)}_of_detect": shares[name] for name in printed if name != WHOLE}


def follow_lines(photos: Sequence[Photo]) -> dict[str, float]:
    """Print and return the share of the labelled lines that each stage leaves, loses and gains."""
    parameters = DetectionParameters(min_length=MIN_LENGTH)
    left = [survival(photo.gray, photo.labels, parameters) for photo in photos]
    figures, rows = {}, []
    before = np.ones(sum(len(photo.labels) for photo in photos), np.bool_)
    for stage in left[0].findable:
        after = np.concatenate([each.findable[stage] for each in left])
        key, words = _key(stage), MATCHED_WORDS if stage == "matched" else stage
        figures |= {
            f"{key}_findable": float(after.mean()),
            f"{key}_lost": float((before & ~after).mean()),
            f"{key}_gained": float((after & ~before).mean()),
        }
        row = [words, *(f"{figures[f'{key}_{word}']:.3f}" for word in ("findable", "lost", "gained"))]
        rows.append([*row, _candidates(left, stage, figures)])
        before = after
    show_table(
        f"{len(before)} lines of {MIN_LENGTH:g} px and more, {parameters.operating_point}",
        ["after", "findable", "lost", "gained", "candidates per photo"],
        rows,
    )
    unsupported = [each.findable["validated"] & ~each.findable["supported"] for each in left]
    return figures | {"validated_without_support": float(np.concatenate(unsupported).mean())}


def _candidates(left: Sequence[Survival], stage: str, figures: dict[str, float]) -> str:
    if stage not in left[0].candidates:
        return ""
    mean = float(np.mean([each.candidates[stage] for each in left]))
    figures[f"{_key(stage)}_candidates"] = mean
    return f"{mean:.0f}"


def _key(name: str) -> str:
    return name.replace(",", "").replace("-", "_").replace(" ", "_")


def main() -> None:
    options = arguments(str(__doc__), "york")
    cv2.setNumThreads(1)
    if not options.york.is_dir():
        print(f"no data: {options.york} is not there")
        finish({}, [], as_json=options.json)
        return
    photos = read_photos(options.york)
    figures = time_stages(photos)
    figures |= follow_lines(photos)
    finish(figures, TARGETS, as_json=options.json)


if __name__ == "__main__":
    main()
