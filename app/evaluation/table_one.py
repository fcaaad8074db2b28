"""Table I of the ClearLines paper: how well pre-labelling's candidates do against the labels that were made of them.

Precision and recall are those of official-v1, averaged over the images of a source, as the paper's are; F1 under
clearlines-v2 (M1) stands beside them. Source: Schroeder, Sabry, Olaverri-Monreal, "ClearLines - Camera Calibration from
Straight Lines", IEEE IV 2025, with P 0.43 and R 0.91 on 85 images of KITTI, P 0.46 and R 0.98 on 50 and P 0.24 and
R 0.98 on 21 images of IAMCV.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.evaluation import clearlines_v2, official_v1
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.protocols import PROTOCOLS
from app.vision.segments import Segments

ALL = "all"
SHOWN = (official_v1.PROTOCOL, clearlines_v2.PROTOCOL)
"""Protocols that the table is made of."""

Tallies = Mapping[str, NDArray[np.float64]]
"""Tallies ``(K,)`` of one image, or ``(I, K)`` of many, by name of the protocol; of those in ``SHOWN`` at least."""


@dataclass(frozen=True)
class TableRow:
    """Scores of the candidates of one source's images.

    Attributes:
        source: ``None`` for images of which no source is known; the last row of several has all images: ``all``.
        images: Number of images.
        precision: Under official-v1.
        recall: Under official-v1; may exceed 1.
        f1: Under official-v1.
        f1_v2: M1, under clearlines-v2.
    """

    source: str | None
    images: int
    precision: float
    recall: float
    f1: float
    f1_v2: float


def table_one(images: Iterable[tuple[str | None, GroundTruth, Segments]]) -> list[TableRow]:
    """Score candidates against labels, source by source.

    Args:
        images: Source, labels and candidates of each image; one is held at a time.

    Returns:
        A row per source in order of its name, the one without a name last, and one for all if there are several.
    """
    sources, tallies = [], []
    for source, truth, candidates in images:
        sources.append(source)
        tallies.append({name: PROTOCOLS[name].score_image(truth, candidates).tallies for name in SHOWN})
    return table_rows(sources, {name: np.array([each[name] for each in tallies]) for name in SHOWN})


def table_rows(sources: Sequence[str | None], tallies: Tallies) -> list[TableRow]:
    """Return the table of images that have been scored.

    Args:
        sources: Source of each of I images.
        tallies: ``(I, K)`` by name of the protocol.

    Raises:
        InvalidInput: When the tallies are of another number of images.
    """
    if any(len(tallies[name]) != len(sources) for name in SHOWN):
        raise InvalidInput(f"the tallies aren't of {len(sources)} images", where="tallies")
    names = sorted(set(sources), key=lambda name: (name is None, name or ""))
    rows = [_row(name, np.array([source == name for source in sources]), tallies) for name in names]
    return [*rows, _row(ALL, np.ones(len(sources), bool), tallies)] if len(rows) > 1 else rows


def table_text(rows: Sequence[TableRow], nameless: str = "(no source)") -> str:
    """Return the table for people, in the paper's form: two digits."""
    names = [row.source or nameless for row in rows]
    width = max([len("source"), *map(len, names)])
    lines = [f"{'source':<{width}}  images     P     R    F1  F1 clearlines-v2"]
    for name, row in zip(names, rows, strict=True):
        official = "".join(f"{value:>6.2f}" for value in (row.precision, row.recall, row.f1))
        lines.append(f"{name:<{width}}  {row.images:>6}{official}  {row.f1_v2:>16.2f}")
    return "\n".join(lines) + "\n"


def _row(source: str | None, chosen: NDArray[np.bool_], tallies: Tallies) -> TableRow:
    of_source = {name: PROTOCOLS[name].metrics(tallies[name][chosen].sum(axis=0)) for name in SHOWN}
    official, ours = of_source[official_v1.PROTOCOL], of_source[clearlines_v2.PROTOCOL]
    return TableRow(
        source,
        int(chosen.sum()),
        float(official["official_precision"]),
        float(official["official_recall"]),
        float(official["official_f1"]),
        float(ours["f1"]),
    )
