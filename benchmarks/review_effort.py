"""Keys and clicks that labelling costs: one key each, keep then reject the rest, and with suggestions.

python benchmarks/review_effort.py [--json] [--york DIR] [--scenes N]

The candidates are those of the page's default run; one is true if it matches a label, one-to-one by line IoU of at
least 0.5. A person who knows the truth labels each image in three ways with what the page offers
(`shared.review_replay`), every key, click and stroke counted, until every verdict is right. Suggestions for an
image are learnt on other images alone, on York and on synthetic scenes. A perfect model shows how few actions there
could be.
Time is one second for each action.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray
from shared.reporting import Target, argument_parser, finish, show_table
from shared.review_collection import Collection, held_out
from shared.review_images import ReviewImage, synthetic_images, york_images
from shared.review_replay import FINISH, Effort, by_turning, keep_by_clicks, keep_then_reject, with_suggestions

from app.review.calibration import CalibrationReport, calibration_report
from app.review.features import FEATURES
from app.review.thresholds import CHEAPEST, Thresholds, thresholds_for

LEARNT_ON = (0, 1, 2, 5, 10, 20, 40)
"""Images labelled before, for the curve."""
ERROR_RATES = (0.05, 0.2)
"""Wanted among what ``S`` accepts, beside the cheapest thresholds."""
FOLDS = 10
FOLDS_OF_CURVE = 5
SCENES = 24
FIRST_SCENE = 5000
"""Seed of the first scene; the prior was trained on others."""
SURE = (0.1, 0.9)
"""Suggestions beyond these probabilities are believed at a glance."""
TARGETS = tuple(
    Target(f"{name}_{figure}", bound)
    for name in ("york", "synthetic")
    for figure, bound in (("with_suggestions", 0.15), ("over_keep_then_reject", 0.6), ("label_error", 0.0))
)

Array = NDArray[np.float64]


class Total(NamedTuple):
    """Efforts of all images together."""

    actions: int
    wrong: int
    strokes: int
    families: int
    holds: int


def total(efforts: Sequence[Effort]) -> Total:
    return Total(*(sum(values) for values in zip(*efforts, strict=True)))


def suggested(
    collection: Collection,
    probabilities: Sequence[Array],
    thresholds: Thresholds,
    without: Sequence[Effort],
    *,
    turning: bool = True,
) -> Total:
    return total(
        [
            with_suggestions(image.page, probability, *thresholds, each, turning=turning)
            for image, probability, each in zip(collection.images, probabilities, without, strict=True)
        ]
    )


def turning(
    collection: Collection, probabilities: Sequence[Array], orders: Sequence[Array], *, keys: int = FINISH
) -> Total:
    return total(
        [
            by_turning(image.page, probability, order, keys=keys)
            for image, probability, order in zip(collection.images, probabilities, orders, strict=True)
        ]
    )


def ranks_of_score(image: ReviewImage) -> Array:
    """Return where each candidate stands among the image's by the pipeline's score, ``(S,)`` in [0, 1)."""
    scores = image.features[:, FEATURES.index("score")]
    return np.argsort(np.argsort(scores, kind="stable"), kind="stable") / len(scores)


def measure(collection: Collection) -> dict[str, float | None]:
    """Print the tables of a collection and return its figures."""
    name, count, images = collection.name, collection.candidates, len(collection.images)
    labels = sum(image.labels for image in collection.images)
    truths = [image.kept for image in collection.images]
    probabilities = held_out(collection, FOLDS)
    everything, kept = np.concatenate(probabilities), np.concatenate(truths)
    report = calibration_report(everything, kept, np.repeat(np.arange(images), [len(truth) for truth in truths]))

    by_key = Total(count + images * FINISH, 0, 0, 0, 0)
    without = [keep_then_reject(image.page) for image in collection.images]
    by_keeping = total(without)
    ways = {
        "a: one key each": by_key,
        "b: keep, reject the rest; clicks alone": total([keep_by_clicks(image.page) for image in collection.images]),
        "b: the same with strokes and families": by_keeping,
        "c: with suggestions": suggested(collection, probabilities, CHEAPEST, without),
        "c: without the turn brush": suggested(collection, probabilities, CHEAPEST, without, turning=False),
    }
    for rate in ERROR_RATES:
        ways[f"c: {rate:.0%} wrong among those accepted"] = suggested(
            collection, probabilities, thresholds_for(everything, rate), without
        )
    random = np.random.default_rng(2)
    ways["c: by the turn brush alone"] = turning(collection, probabilities, probabilities)
    ways["control: (c), the turn brush by random numbers"] = turning(
        collection, probabilities, [random.random(len(truth)) for truth in truths]
    )
    ways["control: (b), all rejected, a turn brush by score"] = turning(
        collection,
        [np.zeros(len(truth)) for truth in truths],
        [ranks_of_score(image) for image in collection.images],
        keys=1 + FINISH,  # the rest is rejected before the image ends
    )
    ways["c: with a perfect model"] = suggested(
        collection, [truth.astype(np.float64) for truth in truths], CHEAPEST, without
    )
    show_table(
        f"{name}: {images} images, {count} candidates, {kept.sum()} of them true",
        ["way", "per candidate", "per label", "of b", "s per image", "strokes", "families", "wrong"],
        [
            [
                way,
                f"{each.actions / count:.3f}",
                f"{each.actions / labels:.2f}",
                f"{each.actions / by_keeping.actions:.2f}",
                f"{each.actions / images:.1f}",
                f"{each.strokes / images:.1f}",
                f"{each.families / images:.1f}",
                f"{each.wrong / count:.3f}",
            ]
            for way, each in ways.items()
        ],
    )
    unsure = float(((everything > SURE[0]) & (everything < SURE[1])).mean())
    print(f"Suggestions of {SURE[0]:g} to {SURE[1]:g}, each of which may want a look: {unsure:.0%} of the candidates")
    curve = show_curve(collection, without)
    with_them = ways["c: with suggestions"]
    show_calibration(name, report)
    return {
        f"{name}_candidates": float(count),
        f"{name}_labels": float(labels),
        f"{name}_one_key": by_key.actions / count,
        f"{name}_keep_then_reject_by_clicks": ways["b: keep, reject the rest; clicks alone"].actions / count,
        f"{name}_keep_then_reject": by_keeping.actions / count,
        f"{name}_with_suggestions": with_them.actions / count,
        f"{name}_without_turn_brush": ways["c: without the turn brush"].actions / count,
        f"{name}_control_random_turns": ways["control: (c), the turn brush by random numbers"].actions / count,
        f"{name}_control_turns_by_score": ways["control: (b), all rejected, a turn brush by score"].actions / count,
        f"{name}_over_keep_then_reject_by_clicks": with_them.actions
        / ways["b: keep, reject the rest; clicks alone"].actions,
        f"{name}_with_suggestions_per_label": with_them.actions / labels,
        f"{name}_over_keep_then_reject": with_them.actions / by_keeping.actions,
        f"{name}_with_perfect_model": ways["c: with a perfect model"].actions / count,
        f"{name}_label_error": with_them.wrong / count,
        f"{name}_seconds_per_image": with_them.actions / images,
        f"{name}_unsure": unsure,
        f"{name}_suggestions_wrong": report.error_rate,
        f"{name}_log_loss": report.log_loss,
        f"{name}_calibration_error": report.ece,
        **{f"{name}_after_{known}_images": actions for known, actions in curve.items()},
    }


def show_curve(collection: Collection, without: Sequence[Effort]) -> dict[int, float]:
    """Print and return actions per candidate by the number of images that were labelled before."""
    curve, rows = {}, []
    most = len(collection.images) - -(-len(collection.images) // FOLDS_OF_CURVE)
    for known in (number for number in LEARNT_ON if number <= most):
        probabilities = held_out(collection, FOLDS_OF_CURVE, known)
        found = suggested(collection, probabilities, CHEAPEST, without)
        wrong = np.concatenate(
            [(p >= 0.5) != image.kept for p, image in zip(probabilities, collection.images, strict=True)]
        )
        curve[known] = found.actions / collection.candidates
        rows.append([str(known), f"{curve[known]:.3f}", f"{wrong.mean():.3f}"])
    show_table(f"{collection.name}: images labelled before", ["images", "per candidate", "suggestions wrong"], rows)
    return curve


def show_calibration(name: str, report: CalibrationReport) -> None:
    """Print what probabilities promise and what became of it."""
    rows = [
        [f"{each.low:.1f}-{each.high:.1f}", str(each.count), f"{each.predicted:.2f}", f"{each.observed:.2f}"]
        for each in report.bins
        if each.predicted is not None and each.observed is not None
    ]
    title = (
        f"{name}: suggestions on unseen images, {report.error_rate:.1%} wrong (all rejected: "
        f"{report.base_error_rate:.1%}), log loss {report.log_loss:.3f}, calibration error {report.ece:.3f}"
    )
    show_table(title, ["probability", "candidates", "predicted", "kept"], rows)


def main() -> None:
    parser = argument_parser(str(__doc__), "york")
    parser.add_argument("--scenes", type=int, default=SCENES, help="synthetic scenes to label")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    collections = [Collection("synthetic", list(synthetic_images(options.scenes, FIRST_SCENE)))]
    if options.york.is_dir():
        collections.insert(0, Collection("york", list(york_images(options.york))))
    else:
        print(f"no photos: {options.york} is not there")
    figures: dict[str, float | None] = {}
    for collection in collections:
        figures |= measure(collection)
    measured = {collection.name for collection in collections}
    targets = [target for target in TARGETS if target.figure.split("_")[0] in measured]
    finish(figures, targets, as_json=options.json)


if __name__ == "__main__":
    main()
