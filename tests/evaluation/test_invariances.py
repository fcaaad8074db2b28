from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.evaluation import ground_truth
from app.evaluation.clearlines_v2 import ImageScore, score_image
from app.evaluation.tallies import metrics
from app.vision.segments import Segments

Line = NDArray[np.float64]
Motion = Callable[[Line], Line]


def rotation(degrees: float) -> NDArray[np.float64]:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, s], [-s, c]])


def scene(seed: int) -> tuple[list[Line], list[Line], list[Line]]:
    """Labels, predictions and ambiguous labels: found, found twice, in pieces, missed, crossing and unrelated ones."""
    random = np.random.default_rng(seed)

    def bent() -> Line:
        along = np.arange(-random.uniform(30, 90), random.uniform(30, 90))
        curve = np.stack([along, random.uniform(-5e-4, 5e-4) * along**2], axis=1)
        return curve @ rotation(random.uniform(0, 360)) + random.uniform(0, 300, 2)

    labels = [bent() for _ in range(16)]
    ambiguous = [bent() for _ in range(3)]
    predictions = [bent() for _ in range(4)]
    for label in [*labels[:12], *ambiguous[:2]]:
        moved = label + random.normal(0, 1.0, 2)
        predictions.append(moved @ rotation(random.normal(0, 0.3)))
        if random.random() < 0.3:
            predictions += [moved[: len(moved) // 2], moved[len(moved) // 2 :]]
    return labels, predictions, ambiguous


def scored(lines: Sequence[Sequence[Line]], move: Motion = lambda points: points) -> ImageScore:
    labels, predictions, ambiguous = (Segments.from_list([move(line) for line in side]) for side in lines)
    return score_image(ground_truth(labels, ambiguous), predictions)


MOTIONS: dict[str, Motion] = {
    "turned by 90 degrees": lambda points: points @ rotation(90),
    "turned by 31 degrees": lambda points: points @ rotation(31),
    "mirrored": lambda points: points * [-1, 1],
    "translated": lambda points: points + np.array([123.4, -77.7]),
    "reversed": lambda points: points[::-1],
}

DIRECTED = ("bias",)  # tells right and down from left and up
LENGTHS = (
    "completeness",
    "correctness",
    "quality",
    "redundancy",
    "offset_mean",
    "offset_median",
    "offset_p95",
    "angle_error",
    "translation_error",
    "mean_liou",
)


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_moving_both_sides_changes_nothing(name: str, seed: int) -> None:
    before, after = scored(scene(seed)), scored(scene(seed), MOTIONS[name])
    assert after.outcomes.predictions.tolist() == before.outcomes.predictions.tolist()
    assert after.outcomes.labels.tolist() == before.outcomes.labels.tolist()
    assert after.matches.row.tolist() == before.matches.row.tolist()
    assert after.matches.column.tolist() == before.matches.column.tolist()
    values, expected = metrics(after.tallies), metrics(before.tallies)
    assert 0.3 < expected["f1"] < 0.9
    assert after.matches.value == pytest.approx(before.matches.value, abs=0.03)
    for key, value in expected.items():
        if key in DIRECTED or key in ("f1_grid", "mean_f1"):
            continue
        # a sample at the very edge of 3 px may fall to either side by rounding, and weighs a pixel
        assert values[key] == pytest.approx(value, abs=0.02 if key in LENGTHS else 1e-12), key
    assert values["mean_f1"] == pytest.approx(expected["mean_f1"], abs=0.02)
    assert abs(values["f1_grid"] - expected["f1_grid"]).mean() < 0.02


def test_the_bias_changes_sign_by_half_a_turn_and_keeps_its_size() -> None:
    lines = [np.stack([np.arange(200.0), np.full(200, 20.0 * k)], axis=1) for k in range(4)]
    shifted = [line + np.array([0.0, 0.7]) for line in lines]
    straight = metrics(scored((lines, shifted, [])).tallies)
    turned = metrics(scored((lines, shifted, []), lambda points: points @ rotation(180)).tallies)
    assert straight["bias"] == pytest.approx(0.7, abs=1e-5)
    assert turned["bias"] == pytest.approx(-0.7, abs=1e-5)


@settings(max_examples=40, deadline=None)
@given(
    st.floats(0, 180),
    st.floats(-6, 6).filter(lambda shift: abs(abs(shift) - 3) > 1e-3),
    st.booleans(),
    st.booleans(),
)
def test_a_400_px_line_accepts_3_px_at_any_angle(angle: float, shift: float, flip: bool, mirror: bool) -> None:
    along = np.linspace(-200, 200, 401)
    label = np.stack([along, np.zeros(401)], axis=1)
    prediction = label + np.array([0.0, shift])
    turn = rotation(angle) * [-1 if mirror else 1, 1]
    result = scored(([label @ turn], [(prediction[::-1] if flip else prediction) @ turn], []))
    assert len(result.matches.row) == (abs(shift) < 3)


@settings(max_examples=40, deadline=None)
@given(st.floats(0, 180), st.floats(-4, 4).filter(lambda turn: not 1.26 < abs(turn) < 1.31))
def test_a_400_px_line_accepts_1_28_degrees_at_any_angle(angle: float, turn: float) -> None:
    along = np.linspace(-200, 200, 401)
    label = np.stack([along, np.zeros(401)], axis=1)
    result = scored(([label @ rotation(angle)], [label @ rotation(angle + turn)], []))
    assert len(result.matches.row) == (abs(turn) < 1.28)


@settings(max_examples=40, deadline=None)
@given(st.floats(0, 180), st.integers(20, 400).filter(lambda length: not 192 < length < 200))
def test_a_400_px_line_accepts_half_its_cover_at_any_angle(angle: float, length: int) -> None:
    along = np.linspace(-200, 200, 401)
    label = np.stack([along, np.zeros(401)], axis=1)
    result = scored(([label @ rotation(angle)], [label[: length + 1] @ rotation(angle)], []))
    assert len(result.matches.row) == (length >= 200)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 1000), st.randoms(use_true_random=False))
def test_the_order_of_segments_changes_no_number(seed: int, random: object) -> None:
    labels, predictions, ambiguous = scene(seed)
    before = metrics(scored((labels, predictions, ambiguous)).tallies)
    shuffled = [list(side) for side in (labels, predictions, ambiguous)]
    for side in shuffled:
        random.shuffle(side)  # type: ignore[attr-defined]
    after = metrics(scored(shuffled).tallies)
    for key, value in before.items():
        assert after[key] == pytest.approx(value, nan_ok=True), key
