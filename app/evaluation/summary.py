"""The result of an evaluation in words and as JSON: ``summary.txt``, ``summary.json``, one file per image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from app.evaluation.consequences import consequences
from app.evaluation.official_v1 import IOU_THRESHOLD, ImageScore, Totals, total
from app.evaluation.outcome import Outcome


@dataclass(frozen=True)
class Evaluation:
    """Scores of a set of images.

    Attributes:
        names: Names of the images.
        scores: Score of each.
        missing: Images without a prediction file: scored as images without predictions.
        extra: Names that have predictions but no labels: not scored.
        min_length: Shorter predictions were left out and shorter labels ignored, px.
    """

    names: tuple[str, ...]
    scores: tuple[ImageScore, ...]
    missing: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()
    min_length: float = 0.0

    @property
    def totals(self) -> Totals:
        """The averages over the images."""
        return total(self.scores)


def summary_text(evaluation: Evaluation) -> str:
    """Return ``summary.txt``: the four lines of the paper's script, exactly, then what they leave out."""
    totals = evaluation.totals
    lines = [
        f"Results for Intersection over Union (IoU) of: {IOU_THRESHOLD}",
        f"Average Precision: {totals.precision:.2f}",
        f"Average Recall: {totals.recall:.2f}",
        f"F1 Score;: {totals.f1:.2f}",  # the script's own spelling: programs read this line
        "",
        f"Protocol: {totals.protocol}",
        f"Precision, recall, F1: {totals.precision:.6f}, {totals.recall:.6f}, {totals.f1:.6f}",
        f"Images: {totals.images}",
        f"Labels: {totals.labels}",
        f"Predictions: {totals.predictions}",
        f"True positives: {totals.true_positives}",
    ]
    if evaluation.min_length > 0:
        lines.append(f"Shortest line that counts: {evaluation.min_length:g} px")
    lines += ["", *_extremes(evaluation.names, evaluation.scores)]
    lines += ["", "What to know about these numbers:"]
    lines += [f"- {consequence}" for consequence in consequences(evaluation.names, evaluation.scores)]
    for title, names in (
        ("Images without a prediction file, scored as empty", evaluation.missing),
        ("Predictions without a label file, not scored", evaluation.extra),
    ):
        if names:
            lines += ["", f"{title} ({len(names)}):", *(f"- {name}" for name in names)]
    return "\n".join(lines) + "\n"


def summary_content(evaluation: Evaluation) -> dict[str, Any]:
    """Return the content of ``summary.json``; numbers are not rounded."""
    totals, scores = evaluation.totals, evaluation.scores
    return {
        "protocol": totals.protocol,
        "iou_threshold": IOU_THRESHOLD,
        "precision": totals.precision,
        "recall": totals.recall,
        "f1": totals.f1,
        "images": totals.images,
        "counts": {
            "labels": totals.labels,
            "predictions": totals.predictions,
            "true_positives": totals.true_positives,
            "ignored_labels": sum(int((score.outcomes.labels == Outcome.IGNORED).sum()) for score in scores),
            "ignored_predictions": sum(int((score.outcomes.predictions == Outcome.IGNORED).sum()) for score in scores),
            "images_without_recall": totals.without_recall,
        },
        "min_length": evaluation.min_length,
        "missing": list(evaluation.missing),
        "extra": list(evaluation.extra),
        "consequences": consequences(evaluation.names, scores),
    }


def image_content(name: str, score: ImageScore, prediction_index: Sequence[int] | None = None) -> dict[str, Any]:
    """Return the content of one file of ``individual_results/``.

    Args:
        name: Name of the image.
        score: Its score.
        prediction_index: Place of each scored prediction in its file, if short ones were left out.
    """
    outcomes = score.outcomes
    index = range(len(score.best_iou)) if prediction_index is None else prediction_index
    rows = zip(index, outcomes.predictions.tolist(), score.best_iou.tolist(), score.best_label.tolist(), strict=True)
    return {
        "name": name,
        "protocol": score.protocol,
        "precision": score.precision,
        "recall": score.recall,
        "true_positives": score.true_positives,
        "predictions": score.predictions,
        "labels": score.labels,
        "prediction_outcomes": [
            {
                "index": int(place),
                "outcome": Outcome(outcome).name.lower(),
                "best_iou": iou,
                "best_label": None if label < 0 else label,
            }
            for place, outcome, iou, label in rows
        ],
        "label_outcomes": [Outcome(outcome).name.lower() for outcome in outcomes.labels.tolist()],
    }


def _extremes(names: Sequence[str], scores: Sequence[ImageScore]) -> list[str]:
    lines = []
    precisions = [(score.precision, name) for name, score in zip(names, scores, strict=True)]
    recalls = [(score.recall, name) for name, score in zip(names, scores, strict=True) if score.recall is not None]
    for word, values in (("precision", precisions), ("recall", recalls)):
        if values:
            (low, lowest), (high, highest) = min(values), max(values)
            lines.append(f"Lowest {word}: {low:.2f} ({lowest}), highest: {high:.2f} ({highest})")
    return lines
