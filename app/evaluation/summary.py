"""The result of an evaluation in words: ``summary.txt``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from app.evaluation import official_v1, official_v1_fixed
from app.evaluation.bootstrap import FEWEST_CLUSTERS
from app.evaluation.consequences import consequences
from app.evaluation.metric_labels import METRIC_LABELS
from app.evaluation.outcome import Outcome
from app.evaluation.protocols import PROTOCOLS, Score
from app.evaluation.rejected_lines import REASON
from app.evaluation.tallies import THRESHOLD

_BOXES = (official_v1.PROTOCOL, official_v1_fixed.PROTOCOL)
_WIDTH = 38


@dataclass(frozen=True)
class Evaluation:
    """Scores of a set of images.

    Attributes:
        protocol: Name of the protocol that the result is stated under.
        names: Names of the images.
        scores: Score of each under that protocol.
        totals: Of all protocols, with intervals (`app.evaluation.submission_totals.score_totals`).
        missing: Images without a prediction file: scored as images without predictions.
        extra: Names that have predictions but no labels: not scored.
        min_length: Shorter predictions were left out and shorter labels ignored, px.
    """

    protocol: str
    names: tuple[str, ...]
    scores: tuple[Score, ...]
    totals: Mapping[str, Any]
    missing: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()
    min_length: float = 0.0

    @property
    def precision(self) -> float:
        """Of all images, under the protocol."""
        return self._value("precision")

    @property
    def recall(self) -> float:
        """Of all images, under the protocol."""
        return self._value("recall")

    @property
    def f1(self) -> float:
        """Of all images, under the protocol."""
        return self._value("f1")

    def counted(self, side: str) -> dict[Outcome, int]:
        """Return how many ``predictions`` or ``labels`` have each outcome."""
        outcomes = [getattr(score.outcomes, side) for score in self.scores]
        return {outcome: sum(int((each == outcome).sum()) for each in outcomes) for outcome in Outcome}

    def consequences(self) -> list[str]:
        """Return what a reader of these numbers should know."""
        scores = [score for score in self.scores if isinstance(score, official_v1.ImageScore)]
        return consequences(self.names, scores) if len(scores) == len(self.names) else []

    def _value(self, name: str) -> float:
        prefix = PROTOCOLS[self.protocol].key.removesuffix("f1")
        return self.totals["protocols"][self.protocol]["totals"][prefix + name]["value"]


def summary_text(evaluation: Evaluation) -> str:
    """Return ``summary.txt``: four lines, for official-v1 exactly those of the paper's script, then the rest."""
    predictions, labels = evaluation.counted("predictions"), evaluation.counted("labels")
    lines = [
        *_first_lines(evaluation),
        "",
        f"Protocol: {evaluation.protocol}",
        f"Precision, recall, F1: {evaluation.precision:.6f}, {evaluation.recall:.6f}, {evaluation.f1:.6f}",
        f"Images: {len(evaluation.names)}",
        f"Labels: {sum(labels.values()) - labels[Outcome.IGNORED]}",
        f"Predictions: {sum(predictions.values()) - predictions[Outcome.IGNORED]}",
        f"True positives: {predictions[Outcome.HIT]}",
    ]
    if evaluation.min_length > 0:
        lines.append(f"Shortest line that counts: {evaluation.min_length:g} px")
    lines += ["", *_extremes(evaluation.names, evaluation.scores)]
    known = evaluation.consequences()
    if known:
        lines += ["", "What to know about these numbers:", *(f"- {consequence}" for consequence in known)]
    totals = evaluation.totals
    lines += [*_metrics(totals), *_errors(totals), *_strata(totals), *_reasons(totals)]
    for title, names in (
        ("Images without a prediction file, scored as empty", evaluation.missing),
        ("Predictions without a label file, not scored", evaluation.extra),
    ):
        if names:
            lines += ["", f"{title} ({len(names)}):", *(f"- {name}" for name in names)]
    return "\n".join(lines) + "\n"


def _first_lines(evaluation: Evaluation) -> list[str]:
    values = f"{evaluation.precision:.2f}", f"{evaluation.recall:.2f}", f"{evaluation.f1:.2f}"
    names = ("Precision", "Recall", "F1 Score")
    if evaluation.protocol == official_v1.PROTOCOL:
        names = ("Average Precision", "Average Recall", "F1 Score;")  # the script's own spelling: programs read it
    overlap = "Intersection over Union (IoU)" if evaluation.protocol in _BOXES else "line IoU"
    return [
        f"Results for {overlap} of: {THRESHOLD}",
        *(f"{name}: {value}" for name, value in zip(names, values, strict=True)),
    ]


def _extremes(names: Sequence[str], scores: Sequence[Score]) -> list[str]:
    lines = []
    precisions = [(score.precision, name) for name, score in zip(names, scores, strict=True)]
    recalls = [(score.recall, name) for name, score in zip(names, scores, strict=True) if score.recall is not None]
    for word, values in (("precision", precisions), ("recall", recalls)):
        if values:
            (low, lowest), (high, highest) = min(values), max(values)
            lines.append(f"Lowest {word}: {low:.2f} ({lowest}), highest: {high:.2f} ({highest})")
    return lines


def _metrics(totals: Mapping[str, Any]) -> list[str]:
    lines = ["", f"All protocols, {_uncertainty(totals)}:"]
    for protocol in reversed(PROTOCOLS):
        values = totals["protocols"][protocol]["totals"]
        lines += [f"  {protocol}", *(_metric(key, values[key]) for key in METRIC_LABELS if key in values)]
        if protocol == official_v1.PROTOCOL and values["official_recall"]["value"] > 1:
            lines.append("    Recall exceeds 1, as several predictions count for one label.")
    return lines


def _uncertainty(totals: Mapping[str, Any]) -> str:
    images, clusters = totals["images"], totals["clusters"]
    if clusters < FEWEST_CLUSTERS:
        return "without intervals, which a single " + ("image" if images == 1 else "sequence") + " can't give"
    of = f"{images} images" + (f" in {clusters} sequences" if clusters < images else "")
    return f"with {100 * totals['level']:g} % intervals (bootstrap, {totals['draws']} draws of {of})"


def _metric(key: str, estimate: Mapping[str, float | None]) -> str:
    label = METRIC_LABELS[key]
    value, low, high = (_number(estimate[end], label.factor) for end in ("value", "low", "high"))
    interval = "" if estimate["low"] is None else f"  [{low}, {high}]"
    name = f"{label.text}, {label.unit}" if label.unit else label.text
    return f"    {name:<{_WIDTH}}{value:>8}{interval}"


def _number(value: float | None, factor: float) -> str:
    return "-" if value is None else f"{factor * value:.3f}"


def _errors(totals: Mapping[str, Any]) -> list[str]:
    counts = {name.replace("over_", "over-").replace("_", " "): count for name, count in totals["error_types"].items()}
    found = ", ".join(f"{count} {name}" for name, count in counts.items() if count)
    return ["", f"Errors under clearlines-v2: {found or 'none'}"]


def _strata(totals: Mapping[str, Any]) -> list[str]:
    lines = ["", f"clearlines-v2 by kind of line:{'F1':>15}{'P':>8}{'R':>8}{'TP':>8}{'FP':>8}{'FN':>8}"]
    for kind, strata in totals["strata"].items():
        for stratum in strata if kind != REASON else ():
            shares = "".join(f"{stratum[key]['value']:>8.3f}" for key in ("f1", "precision", "recall"))
            counts = "".join(f"{stratum[key]:>8}" for key in ("tp", "fp", "fn"))
            lines.append(f"  {kind + ' ' + stratum['name']:<{_WIDTH - 3}}{shares}{counts}")
    return lines


def _reasons(totals: Mapping[str, Any]) -> list[str]:
    strata = totals["strata"].get(REASON, ())
    return ["", "Lines that people rejected, found all the same:", *map(_reason, strata)] if strata else []


def _reason(stratum: Mapping[str, Any]) -> str:
    share = stratum["share"]
    interval = "" if share["low"] is None else f"  [{share['low']:.3f}, {share['high']:.3f}]"
    counts = f"{stratum['fp']} of {stratum['candidates']}"
    return f"  {stratum['name'].replace('_', ' '):<{_WIDTH + 2}}{share['value']:>8.3f}{interval}  ({counts})"
