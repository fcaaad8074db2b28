"""Everything that is kept of one scored image of a submission: enough for every total, list and picture of it."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidFile
from app.evaluation.average_precision import Ranked
from app.evaluation.bootstrap import or_none
from app.evaluation.outcome import Outcomes
from app.evaluation.protocols import PROTOCOLS
from app.evaluation.rejected_lines import NO_REASON, no_reasons

_TALLIES = "tallies:"
_ARRAYS = (
    "scored_predictions",
    "prediction_outcomes",
    "label_outcomes",
    "best_label",
    "liou",
    "offset",
    "angle",
    "prediction_errors",
    "label_errors",
    "strata",
    "prediction_reasons",
    "reasons",
)
_UNREADABLE = (ValueError, TypeError, KeyError, OSError, EOFError, zipfile.BadZipFile, zlib.error)


@dataclass(frozen=True, eq=False)
class ImageRecord:
    """The scores of one image with P submitted predictions and L labels, under all protocols.

    Attributes:
        tallies: float64 ``(K,)`` by name of the protocol; additive over images.
        scored_predictions: int64, those of the P that are long enough to count, ascending.
        prediction_outcomes: int8 ``(P,)``, `Outcome` under clearlines-v2; ``IGNORED`` also if too short to count.
        label_outcomes: int8 ``(L,)``, likewise.
        best_label: int64 ``(P,)``, the label that a true positive is matched with, else the one with the highest line
            IoU, -1 if that is 0.
        liou: float64 ``(P,)``, line IoU with that label.
        offset: float64 ``(P,)``, mean distance of a true positive from its label, px; NaN for others.
        angle: float64 ``(P,)``, angle of a true positive to its label, rad; NaN for others.
        prediction_errors: int8 ``(P,)``, `ErrorType`.
        label_errors: int8 ``(L,)``, `ErrorType`.
        strata: float64 ``(S, 3)``, see `app.evaluation.strata.stratum_tallies`.
        ranked: What average precision is made of; ``None`` where predictions have no scores.
        prediction_reasons: int8 ``(P,)``, why people rejected the line that a false positive is, see
            `app.evaluation.rejected_lines.reasons_of`.
        reasons: float64 ``(5, 2)``, see `app.evaluation.rejected_lines.reason_tallies`.
    """

    tallies: Mapping[str, NDArray[np.float64]]
    scored_predictions: NDArray[np.int64]
    prediction_outcomes: NDArray[np.int8]
    label_outcomes: NDArray[np.int8]
    best_label: NDArray[np.int64]
    liou: NDArray[np.float64]
    offset: NDArray[np.float64]
    angle: NDArray[np.float64]
    prediction_errors: NDArray[np.int8]
    label_errors: NDArray[np.int8]
    strata: NDArray[np.float64]
    ranked: Ranked | None
    prediction_reasons: NDArray[np.int8]
    reasons: NDArray[np.float64]

    @property
    def outcomes(self) -> Outcomes:
        """What became of each prediction and label under clearlines-v2."""
        return Outcomes(self.prediction_outcomes, self.label_outcomes)

    def metrics(self) -> dict[str, float | None]:
        """Return the metrics of this image alone under all protocols, ``None`` where one isn't defined.

        M2's grid and average precision are left out.
        """
        found: dict[str, float | None] = {}
        for name, tallies in self.tallies.items():
            values = PROTOCOLS[name].metrics(tallies)
            found |= {key: or_none(value) for key, value in values.items() if not np.ndim(value)}
        return found

    def as_npz(self) -> bytes:
        """Return the record as a compressed npz file without pickled content."""
        arrays = {name: getattr(self, name) for name in _ARRAYS}
        arrays |= {_TALLIES + name: tallies for name, tallies in self.tallies.items()}
        if self.ranked is not None:
            arrays |= {
                "ranked_scores": self.ranked.scores,
                "ranked_hit": self.ranked.hit,
                "ranked_labels": np.array(self.ranked.labels),
            }
        file = io.BytesIO()
        np.savez_compressed(file, **arrays)
        return file.getvalue()

    @classmethod
    def from_npz(cls, data: bytes) -> ImageRecord:
        """Read what ``as_npz`` wrote; nothing is unpickled.

        Raises:
            InvalidFile: When it is something else.
        """
        try:
            with np.load(io.BytesIO(data), allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
            ranked = None
            if "ranked_scores" in arrays:
                ranked = Ranked(arrays["ranked_scores"], arrays["ranked_hit"], int(arrays["ranked_labels"]))
            tallies = {
                name.removeprefix(_TALLIES): array for name, array in arrays.items() if name.startswith(_TALLIES)
            }
            # records of before reasons were frozen with labels
            arrays.setdefault("prediction_reasons", np.full(len(arrays["best_label"]), NO_REASON, np.int8))
            arrays.setdefault("reasons", no_reasons())
            return cls(tallies, **{name: arrays[name] for name in _ARRAYS}, ranked=ranked)
        except _UNREADABLE as error:
            raise InvalidFile("a record of scores can't be read", expected="npz as it was written") from error
