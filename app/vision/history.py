"""How each segment came about: the pieces it was merged from, what joined them, and what was added and cut.

The arithmetic is that of `detect`, run with copies of what every stage leaves behind; so segments and order are the
same.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from app.vision.arcs import ends, project
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import SMALLEST_SIDE, check_image, choose, segments_of
from app.vision.segments import Segments
from app.vision.stages import Stages, run_stages
from app.vision.watch import Watch

Round = Literal["following", "flipping", "after extension"]


@dataclass(frozen=True, eq=False)
class SegmentHistory:
    """How one segment came about. All lists run from the segment's first point to its last.

    Attributes:
        pieces: float64 ``(P, 2, 2)`` px, start and end of the arc fitted to each piece.
        gaps: float64 ``(J, 2, 2)`` px, start and end of the gaps that merging closed; J = P - 1.
        costs: float64 ``(J,)``, effective length of each gap in px, made longer by what the joint arc misses.
        flipped: bool ``(J,)``, whether the bright side changes there.
        rounds: In which round of merging each was closed, ``(J,)``.
        extended: px that following the edge added before the first piece and after the last.
        trimmed: px that were cut off at the start and at the end: a better segment covers them, or points lack.
        features: What the score is made of, by name.
        score: In [0, 1].
    """

    pieces: NDArray[np.float64]
    gaps: NDArray[np.float64]
    costs: NDArray[np.float64]
    flipped: NDArray[np.bool_]
    rounds: tuple[Round, ...]
    extended: tuple[float, float]
    trimmed: tuple[float, float]
    features: dict[str, float]
    score: float


def detect_with_history(
    gray: NDArray[Any], parameters: DetectionParameters | None = None
) -> tuple[Segments, tuple[SegmentHistory, ...]]:
    """Find the segments that `detect` finds, and tell how each came about.

    Args:
        gray: As for `detect`.
        parameters: As for `detect`.

    Returns:
        The segments, and a history for each, in the same order.

    Raises:
        InvalidImage: As `detect` does.
        BrokenInstallation: As `detect` does.
    """
    eight_bit = check_image(gray)
    if min(eight_bit.shape) < SMALLEST_SIDE:
        return Segments.empty(), ()
    parameters = parameters or DetectionParameters()
    stages = run_stages(eight_bit, parameters, Watch(), keep=True)
    chosen = choose(stages.selection, parameters)
    segments = segments_of(stages, chosen)
    histories = []
    for rank, finding in enumerate(chosen.index.tolist()):
        features = {name: float(values[rank]) for name, values in chosen.features.items()}
        arc = int(stages.selection.findings["arc"][finding])
        histories.append(_history(stages, arc, segments[rank], features, float(chosen.scores[rank])))
    return segments, tuple(histories)


def _history(
    stages: Stages, index: int, points: NDArray[np.float32], features: dict[str, float], score: float
) -> SegmentHistory:
    merging = stages.merging
    arc = merging.arcs[index : index + 1]
    along, pieces = _along(arc, ends(stages.alive["chained"][_list(merging.next_piece, arc["first_piece"][0])]))
    outermost = along.min(), along.max()
    numbers = np.array(_list(merging.joins["next"], arc["first_join"][0]), np.int64)
    joins = merging.joins[numbers]
    gap_along, gaps = _along(arc, np.stack([joins["leave"], joins["enter"]], axis=1).astype(np.float64))
    order = np.argsort(gap_along.mean(axis=1), kind="stable")
    low, high = float(arc["low"][0]), float(arc["high"][0])
    first, last = _project(arc, points[[0, -1]].astype(np.float64)).tolist()
    names = list(stages.joins_made)
    rounds = np.searchsorted(list(stages.joins_made.values()), numbers, side="right")[order]
    return SegmentHistory(
        pieces=pieces[np.argsort(along.mean(axis=1), kind="stable")],
        gaps=gaps[order],
        costs=joins["cost"][order].astype(np.float64),
        flipped=joins["flipped"][order] != 0,
        rounds=tuple(cast(Round, names[each]) for each in rounds),
        extended=(max(float(outermost[0]) - low, 0.0), max(high - float(outermost[1]), 0.0)),
        trimmed=(max(first - low, 0.0), max(high - last, 0.0)),
        features=features,
        score=score,
    )


def _list(following: NDArray[Any], first: int) -> list[int]:
    """Members of a list whose links are ``following``; -1 ends it."""
    members = []
    member = int(first)
    while member >= 0:
        members.append(member)
        member = int(following[member])
    return members


def _along(arc: NDArray[Any], spans: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Tangent coordinates ``(n, 2)`` of spans ``(n, 2, 2)``, and the spans; all turned to run with the arc."""
    along = _project(arc, spans.reshape(-1, 2)).reshape(-1, 2)
    backward = along[:, 0] > along[:, 1]
    return (
        np.where(backward[:, None], along[:, ::-1], along),
        np.where(backward[:, None, None], spans[:, ::-1], spans),
    )


def _project(arc: NDArray[Any], points: NDArray[np.float64]) -> NDArray[np.float64]:
    return project(np.repeat(arc, len(points)), points)
