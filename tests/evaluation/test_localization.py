from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.evaluation import ground_truth
from app.evaluation.clearlines_v2 import ImageScore, score_image
from app.evaluation.tallies import metrics
from app.vision.segments import Segments

Line = NDArray[np.floating]


def score(labels: Sequence[Line], predictions: Sequence[Line]) -> ImageScore:
    return score_image(ground_truth(Segments.from_list(labels)), Segments.from_list(predictions))


@settings(max_examples=40, deadline=None)
@given(st.floats(0, 180), st.floats(-2.5, 2.5))
def test_a_shift_is_measured_as_it_is(line, angle: float, shift: float) -> None:
    normal = np.array([-np.sin(np.radians(angle)), np.cos(np.radians(angle))])
    result = score([line(300, angle)], [line(300, angle) + shift * normal])
    found = metrics(result.tallies)
    assert found["offset_mean"] == pytest.approx(abs(shift), abs=1e-3)
    assert found["offset_median"] == pytest.approx(abs(shift), abs=0.0101)
    assert found["offset_p95"] == pytest.approx(abs(shift), abs=0.0101)
    assert found["translation_error"] == pytest.approx(abs(shift), abs=1e-3)
    assert found["angle_error"] == pytest.approx(0, abs=1e-4)
    assert result.localization.offset_mean == pytest.approx([abs(shift)], abs=1e-3)
    assert result.localization.offset_p95 == pytest.approx([abs(shift)], abs=1e-3)


@settings(max_examples=40, deadline=None)
@given(st.floats(0, 180), st.floats(-0.8, 0.8))
def test_a_turn_about_the_middle_is_an_angle_and_no_translation(line, angle: float, turn: float) -> None:
    found = metrics(score([line(300, angle)], [line(300, angle + turn)]).tallies)
    assert found["angle_error"] == pytest.approx(abs(np.radians(turn)), abs=1e-4)
    assert found["translation_error"] == pytest.approx(0, abs=5e-3)
    assert found["offset_mean"] == pytest.approx(150 * np.sin(np.radians(abs(turn))) / 2, abs=0.02)


def test_a_shift_of_all_pixels_shows_as_bias_at_every_angle_but_its_own(line) -> None:
    angles = np.arange(0, 180, 10)
    lines = [line(150, angle, (300.0 + 200 * (k % 6), 300.0 + 250 * (k // 6))) for k, angle in enumerate(angles)]
    normals = np.stack([-np.sin(np.radians(angles)), np.cos(np.radians(angles))], axis=1)
    for shift in (0.4, -0.4):
        result = score(lines, [each + shift for each in lines])
        expected = shift * np.abs(normals.sum(axis=1))
        assert result.localization.bias == pytest.approx(expected, abs=1e-3)
        assert metrics(result.tallies)["bias"] == pytest.approx(expected.mean(), abs=1e-3)


def test_what_runs_beyond_the_label_is_no_offset(line) -> None:
    found = metrics(score([line(300)[:200]], [line(300)]).tallies)
    # but for the 3 px behind its end
    assert found["offset_mean"] < 0.04
    assert found["offset_median"] == pytest.approx(0, abs=0.0101)
    assert found["mean_liou"] == pytest.approx(0.67, abs=0.02)


def test_measures_are_in_the_order_of_the_matches(line) -> None:
    lines = [line(200, 0, (300.0, 100.0 * k)) for k in range(5)]
    shifts = [0.5, 2.5, 0.0, 1.5, 1.0]
    moved = [each + np.array([0.0, shift]) for each, shift in zip(lines, shifts, strict=True)]
    result = score(lines, moved[::-1])
    assert result.matches.row.tolist() == [0, 1, 2, 3, 4]
    assert result.matches.column.tolist() == [4, 3, 2, 1, 0]
    assert result.localization.offset_mean == pytest.approx(shifts[::-1], abs=1e-4)
    assert result.localization.bias == pytest.approx(shifts[::-1], abs=1e-4)


def test_the_means_of_a_set_are_over_samples_or_over_hits(line) -> None:
    long, short = line(300, 0, (300.0, 100.0)), line(100, 0, (300.0, 300.0))
    found = metrics(score([long, short], [long, short + np.array([0.0, 2.0])]).tallies)
    assert found["offset_mean"] == pytest.approx(2 * 100 / 400, abs=1e-3)
    assert found["translation_error"] == pytest.approx(1, abs=1e-3)
    assert found["offset_p95"] == pytest.approx(2, abs=0.0101)
    assert found["offset_median"] == pytest.approx(0, abs=0.0101)


def test_the_percentile_is_that_of_numpy(line) -> None:
    label = line(200)
    bent = label + np.stack([np.zeros(201), np.linspace(0, 2.5, 201) ** 1.5 / 2], axis=1)
    result = score([label], [bent])
    distance = np.abs(bent[:, 1] - 500)
    assert result.localization.offset_p95 == pytest.approx([np.percentile(distance, 95)], abs=0.01)
