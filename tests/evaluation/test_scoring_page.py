"""The page on how results are scored shows what the scorers say of its lines."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.evaluation import clearlines_v2
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.outcome import Outcome
from app.evaluation.protocols import protocol_named
from app.evaluation.totals import total
from app.vision.segments import Segments

CASES = Path(__file__).resolve().parents[2] / "frontend" / "src" / "pages" / "scoring_docs" / "cases.json"


def cases() -> list[Any]:
    return json.loads(CASES.read_text()) if CASES.is_file() else []


def segments(lines: list[Any]) -> Segments:
    return Segments.from_list([np.array(line, np.float32) for line in lines])


@pytest.mark.skipif(not CASES.is_file(), reason="the browser tool's sources aren't here")
@pytest.mark.parametrize("case", cases(), ids=lambda case: case["title"])
def test_a_picture_says_what_the_scorers_say(case: Any) -> None:
    predictions = segments(case["predictions"])
    truth = GroundTruth(segments(case["labels"]), np.full(len(case["labels"]), case["ambiguous"]))
    outcomes = clearlines_v2.score_image(truth, predictions).outcomes
    assert (outcomes.predictions == Outcome.HIT).sum() == case["tp"]
    assert (outcomes.predictions == Outcome.FALSE_ALARM).sum() == case["fp"]
    assert (outcomes.labels == Outcome.MISS).sum() == case["fn"]
    assert sum(case["found"]) == case["tp"]
    assert len(case["found"]) == len(predictions)
    if not case["ambiguous"]:
        protocol = protocol_named("official-v1")
        totals = total(protocol, protocol.score_image(truth, predictions).tallies[None], None, np.ones((1, 1)))
        assert totals["official_precision"][0] == case["official_precision"]
        assert totals["official_recall"][0] == case["official_recall"]
