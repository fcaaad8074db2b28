"""Scores of detected segments against labels: protocols, matching and pictures. Arrays in, results out."""

from app.evaluation.ground_truth import GroundTruth, ground_truth, long_enough
from app.evaluation.line_iou import line_iou_matrix
from app.evaluation.matching import Matches, match_one_to_one, match_segments
from app.evaluation.outcome import Outcome, Outcomes
from app.evaluation.overlay import draw_overlay
from app.evaluation.protocols import PROTOCOLS, SCORER_VERSION, Protocol, protocol_named
from app.evaluation.totals import Totals, total

__all__ = [
    "PROTOCOLS",
    "SCORER_VERSION",
    "GroundTruth",
    "Matches",
    "Outcome",
    "Outcomes",
    "Protocol",
    "Totals",
    "draw_overlay",
    "ground_truth",
    "line_iou_matrix",
    "long_enough",
    "match_one_to_one",
    "match_segments",
    "protocol_named",
    "total",
]
