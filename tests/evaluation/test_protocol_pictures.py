"""The pictures of docs/protocols.md say what the scorers say."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.evaluation import Outcome
from app.evaluation.tallies import LAYOUT
from tools.protocol_pictures import PICTURES, accepted_shift, draw_panels, draw_shifts, panels, verdicts


@pytest.mark.parametrize(
    ("draw", "name"),
    [(draw_panels, "protocols-what-counts.svg"), (draw_shifts, "protocols-accepted-shift.svg")],
)
def test_the_pictures_kept_are_those_that_the_program_draws(draw, name: str, tmp_path: Path) -> None:
    draw(tmp_path / name)
    assert (tmp_path / name).read_text() == (PICTURES / name).read_text()


def test_every_outcome_is_shown() -> None:
    scores = [verdicts(panel)[0] for panel in panels()]
    shown = {outcome for score in scores for outcome in score.outcomes.predictions.tolist()}
    assert shown == {Outcome.HIT, Outcome.FALSE_ALARM, Outcome.IGNORED}
    counts = {panel.title: LAYOUT.unpack(score.tallies) for panel, score in zip(panels(), scores, strict=True)}
    assert [counts["two halves"][name] for name in ("tp", "fp", "fn")] == [1, 1, 0]
    assert [counts["the line three times"][name] for name in ("tp", "fp", "fn")] == [1, 2, 0]


@pytest.mark.parametrize(
    ("protocol", "angle", "shift"),
    [("official-v1", 0, 10 / 3), ("official-v1", 45, 73.4), ("clearlines-v2", 0, 3), ("clearlines-v2", 37, 3)],
)
def test_the_accepted_shift_is_that_of_the_table(protocol: str, angle: float, shift: float) -> None:
    assert accepted_shift(protocol, angle, 400) == pytest.approx(shift, abs=0.05)
