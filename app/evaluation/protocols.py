"""The protocols by name. A score is a number under a named protocol and its version."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol as Interface

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInput
from app.evaluation import clearlines_v2, official_v1, official_v1_fixed, tallies
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.layout import Layout
from app.evaluation.outcome import Outcomes
from app.vision.segments import Segments

SCORER_VERSION = "1"
"""Rises whenever a change of the program can change a number under the same protocol version: a corrected mistake."""


class Score(Interface):
    """What the score of an image has under every protocol."""

    @property
    def protocol(self) -> str:
        """Name of the protocol."""
        ...

    @property
    def precision(self) -> float:
        """Precision of the image."""
        ...

    @property
    def recall(self) -> float | None:
        """Recall of the image; ``None`` where the protocol leaves it out."""
        ...

    @property
    def outcomes(self) -> Outcomes:
        """What became of each prediction and label."""
        ...

    @property
    def tallies(self) -> NDArray[np.float64]:
        """Numbers ``(K,)`` that are added up over images."""
        ...


@dataclass(frozen=True)
class Protocol:
    """One way to score.

    Attributes:
        name: As results and pages write it.
        version: Rises when the definition changes; old scores stay what they were.
        description: One line.
        score_image: Scores the predictions of one image.
        layout: What stands where in the tallies of an image.
        metrics: Turns tallies ``(..., K)`` that were added up into values ``(...)`` by name.
        metric_names: Those names.
        key: The metric that an image or a set is known by.
    """

    name: str
    version: str
    description: str
    score_image: Callable[[GroundTruth, Segments], Score]
    layout: Layout
    metrics: Callable[[NDArray[np.float64]], dict[str, NDArray[np.float64]]]
    metric_names: tuple[str, ...]
    key: str


PROTOCOLS: dict[str, Protocol] = {
    protocol.name: protocol
    for protocol in (
        Protocol(
            official_v1.PROTOCOL,
            "1",
            "What the paper's evaluate.py computes: bounding boxes, not one-to-one. To compare with published numbers.",
            official_v1.score_image,
            official_v1.LAYOUT,
            official_v1.metrics,
            official_v1.METRICS,
            "official_f1",
        ),
        Protocol(
            official_v1_fixed.PROTOCOL,
            "1",
            "The bounding boxes of official-v1, matched one-to-one; micro and macro averages.",
            official_v1_fixed.score_image,
            official_v1_fixed.LAYOUT,
            official_v1_fixed.metrics,
            official_v1_fixed.METRICS,
            "fixed_f1",
        ),
        Protocol(
            clearlines_v2.PROTOCOL,
            "1",
            "Lines, matched one-to-one by how much of them runs along one another. The rank key.",
            clearlines_v2.score_image,
            tallies.LAYOUT,
            tallies.metrics,
            tallies.METRICS,
            "f1",
        ),
    )
}
"""All protocols, the one for ranking last."""


def protocol_named(name: str) -> Protocol:
    """Return a protocol.

    Raises:
        InvalidInput: When there is none of that name.
    """
    if name not in PROTOCOLS:
        raise InvalidInput(f"there is no protocol {name!r}", where="protocol", expected=" | ".join(PROTOCOLS))
    return PROTOCOLS[name]
