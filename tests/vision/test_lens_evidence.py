"""Evidence about k1, structure by structure."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.bins import bin_segments
from app.vision.lens_evidence import (
    KINDS,
    LYING_SD,
    SCAN,
    TEMPERATURE,
    UPRIGHT_SD,
    k1_posterior,
    k1_prior,
    structure_sd,
    structures,
    sum_structures,
)
from app.vision.segments import Segments

LYING, UPRIGHT = 1, 5


def says(k1: float, sd: float, count: int = 1) -> np.ndarray:
    """Losses of segments that all ask for k1."""
    return np.repeat(0.5 * ((SCAN - k1) / sd)[:, None] ** 2, count, axis=1)


def test_no_evidence_leaves_the_prior():
    known = k1_posterior(np.zeros((len(SCAN), 3)), np.array([0, 1, 5]))
    assert known.probability == pytest.approx(k1_prior())
    assert known.probability.sum() == pytest.approx(1)


def test_the_prior_holds_each_kind_of_lens_by_its_share():
    little, wide = KINDS
    assert k1_prior() @ SCAN == pytest.approx(little.share * little.mean + wide.share * wide.mean, abs=0.002)
    assert k1_prior()[wide.mean < SCAN].sum() == pytest.approx(wide.share / 2, rel=0.15)


@pytest.mark.parametrize("k1", [0.0, 0.18])
def test_a_lens_of_either_kind_is_not_drawn_towards_the_other(k1: float):
    losses = says(k1, 0.03, 4) * TEMPERATURE
    assert k1_posterior(losses, np.array([4, 5, 6, 7])).mean == pytest.approx(k1, abs=0.003)


@pytest.mark.parametrize(("structure", "sd"), [(LYING, LYING_SD), (UPRIGHT, UPRIGHT_SD)])
def test_one_structure_never_tells_more_than_its_own_bend_allows(structure: int, sd: float):
    few, many = (k1_posterior(says(0.1, 0.02, count), np.full(count, structure)) for count in (20, 2000))
    assert many.sd == pytest.approx(few.sd, rel=0.05)
    widest = max(kind.sd for kind in KINDS)
    assert many.sd > 0.7 * (sd**-2 + widest**-2) ** -0.5


def test_structures_that_agree_tell_more_than_one():
    losses = says(0.15, 0.02, 40)
    alone = k1_posterior(losses, np.full(40, UPRIGHT))
    four = k1_posterior(losses, np.repeat([4, 5, 6, 7], 10))
    assert four.sd < 0.6 * alone.sd
    assert four.mean == pytest.approx(0.15, abs=0.01)


def test_one_structure_astray_is_outvoted_however_many_segments_it_has():
    losses = np.concatenate([says(-0.2, 0.02, 500), says(0.15, 0.02, 30)], axis=1)
    structure = np.concatenate([np.full(500, 3), np.repeat([4, 5, 6], 10)])
    assert k1_posterior(losses, structure).mean == pytest.approx(0.15, abs=0.02)


def test_two_that_disagree_leave_both_answers_open():
    losses = np.concatenate([says(0.0, 0.02, 20), says(0.3, 0.02, 20)], axis=1)
    known = k1_posterior(losses, np.repeat([4, 5], 20))
    assert known.sd > 2 * UPRIGHT_SD


def test_edges_in_pairs_count_for_one_each():
    weak = says(0.1, 1.0)
    single = k1_posterior(weak * TEMPERATURE, np.array([UPRIGHT]))
    pair = k1_posterior(np.repeat(weak * TEMPERATURE / 2, 2, axis=1), np.array([UPRIGHT, UPRIGHT]))
    assert pair.probability == pytest.approx(single.probability)


def line(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    return np.linspace([x0, y0], [x1, y1], 200)


def test_structures_are_heights_of_lying_and_columns_of_upright_segments():
    lying = [line(10, 20, 200, 20), line(400, 30, 600, 35), line(10, 470, 300, 460)]
    upright = [line(20, 10, 20, 400), line(600, 100, 610, 300)]
    segments = Segments.from_list([*lying, *upright])
    found = structures(bin_segments([segments], 640, 480))
    assert found.tolist() == [0, 0, 3, 4, 7]
    assert structure_sd(found).tolist() == [LYING_SD] * 3 + [UPRIGHT_SD] * 2


@pytest.mark.parametrize(("images", "number"), [(1, 1), (3, 1), (4, 4)])
def test_over_few_images_what_lies_at_one_place_is_one_structure(images: int, number: int):
    segments = Segments.from_list([line(100, 460, 500, 465)])
    found = structures(bin_segments([segments] * images, 640, 480))
    assert len(np.unique(found)) == number
    assert (structure_sd(found) == LYING_SD).all()


def test_sums_by_structure():
    found, sums = sum_structures(np.array([[1.0, 2], [3, 4], [5, 6]]), np.array([9, 2, 9]))
    assert found.tolist() == [2, 9]
    assert sums.tolist() == [[3, 4], [6, 8]]
