"""Robust fit of the division model."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.bins import bin_segments
from app.vision.brown import Brown
from app.vision.conversion import refit_brown
from app.vision.division import Division
from app.vision.field import field_error
from app.vision.lens_evidence import SCAN
from app.vision.lens_fit import DIVISION, RUNGS, fit_lens, mixture_of, refine, responsibilities
from app.vision.lens_uncertainty import lens_uncertainty
from app.vision.sampson import bend

SIZE = 640, 480


def brown_of(k: tuple[float, float, float], offset: tuple[float, float] = (0.0, 0.0)) -> Brown:
    lens = Division(*SIZE, k, offset)
    return refit_brown(lens, *SIZE, lens.center).brown


@pytest.mark.parametrize("k1", [-0.15, 0.0, 0.1, 0.3])
def test_recovers_k1_with_a_third_of_the_segments_bent(segments_through, k1: float):
    lens = brown_of((k1, 0.0, 0.0))
    binned = bin_segments([segments_through(lens, 90, bent=1 / 3, seed=2)], *SIZE)
    fit = fit_lens(binned, *SIZE)
    assert field_error(lens, Division.from_parameters(*SIZE, fit.parameters), *SIZE).rms < 1.0
    bent = binned.index < 30
    assert fit.responsibility[bent].mean() < 0.1
    assert fit.responsibility[~bent].mean() > 0.6


def test_releases_further_parameters_only_where_the_data_ask_for_it(segments_through):
    plain, strong = brown_of((0.2, 0.0, 0.0)), brown_of((0.15, 0.3, -0.1))
    fits = [fit_lens(bin_segments([segments_through(lens, 150)], *SIZE), *SIZE) for lens in (plain, strong)]
    assert fits[0].free == RUNGS[0]
    assert len(fits[1].free) > 1
    error = field_error(strong, Division.from_parameters(*SIZE, fits[1].parameters), *SIZE).rms
    assert error < 0.15 * field_error(strong, Brown.identity(*SIZE), *SIZE).rms


def test_refinement_never_loses(segments_through):
    binned = bin_segments([segments_through(brown_of((0.2, 0.0, 0.0)), 60, bent=0.3)], *SIZE)
    mixture = mixture_of(binned)
    losses = [np.inf]
    for iterations in (0, 1, 3, 20):
        parameters, loss = refine(binned, mixture, np.zeros(5), RUNGS[0], iterations=iterations)
        assert loss <= losses[-1]
        assert (parameters[1:] == 0).all()
        losses.append(loss)
    assert losses[-1] < losses[1]


def test_refinement_ends_where_the_loss_is_least(segments_through):
    # half of the segments are bent: what bends anyway mustn't pull k1 to where it would seem to bend less
    binned = bin_segments([segments_through(brown_of((0.2, 0.0, 0.0)), 60, bent=0.5, noise=0.2)], *SIZE)
    mixture = mixture_of(binned)
    start = np.array([0.19, 0, 0, 0, 0])
    best, loss = refine(binned, mixture, start, RUNGS[0], tolerance=1e-6)
    for k1 in np.linspace(best[0] - 0.02, best[0] + 0.02, 9):
        _, there = refine(binned, mixture, k1 * np.eye(5)[0], RUNGS[0], iterations=0)
        assert loss <= there + 1e-3


def test_k1_alone_is_the_mean_of_its_posterior(segments_through):
    binned = bin_segments([segments_through(brown_of((0.2, 0.0, 0.0)), 40)], *SIZE)
    fit = fit_lens(binned, *SIZE)
    assert fit.free == RUNGS[0]
    assert fit.parameters.tolist() == [fit.posterior.mean, 0, 0, 0, 0]
    assert SCAN[np.argmax(fit.posterior.probability)] == pytest.approx(0.2, abs=0.02)


def test_a_bent_segment_is_less_likely_straight(segments_through):
    binned = bin_segments([segments_through(Brown.identity(*SIZE), 20, bent=0.5)], *SIZE)
    left = bend(binned, DIVISION, np.zeros(5))
    probability, loss = responsibilities(left, mixture_of(binned))
    assert probability[:10].max() < probability[10:].min()
    assert np.isfinite(loss).all()


def test_more_segments_leave_less_uncertainty(segments_through):
    lens = brown_of((0.2, 0.0, 0.0))
    few, many = (
        lens_uncertainty(fit_lens(bin_segments([segments_through(lens, count, noise=0.2)], *SIZE), *SIZE), *SIZE)
        for count in (8, 200)
    )
    assert many.pred < 0.8 * few.pred
    assert many.scan_spread < 0.8 * few.scan_spread
    assert many.correction == pytest.approx(field_error(Brown.identity(*SIZE), lens, *SIZE).rms, rel=0.1)
