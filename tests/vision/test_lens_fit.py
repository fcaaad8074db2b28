"""Robust fit of the division model."""

from __future__ import annotations

import numpy as np
import pytest

from app.vision.bins import bin_segments
from app.vision.brown import Brown
from app.vision.conversion import refit_brown
from app.vision.division import Division
from app.vision.field import field_error
from app.vision.lens_evidence import SCAN, structures
from app.vision.lens_fit import SURE_OF_K1, fit_lens, refine
from app.vision.lens_mixture import mixture_of
from app.vision.lens_uncertainty import lens_uncertainty

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


@pytest.mark.parametrize(
    ("k", "offset"),
    [((0.2, 0.0, 0.0), (0.0, 0.0)), ((0.15, 0.3, -0.1), (0.0, 0.0)), ((0.2, 0.05, 0.0), (0.02, -0.015))],
)
def test_many_clean_segments_tell_all_parameters(segments_through, k: tuple[float, float, float], offset):
    lens = Division(*SIZE, k, offset)
    binned = bin_segments([segments_through(brown_of(k, offset), 150, bent=0.2, noise=0.03)], *SIZE)
    fit = fit_lens(binned, *SIZE)
    assert fit.refined
    assert field_error(lens, Division.from_parameters(*SIZE, fit.parameters), *SIZE).rms < 0.4


def test_refinement_stops_where_a_further_step_changes_nothing(segments_through):
    # half of the segments are bent: what bends anyway mustn't pull the lens to where it would seem to bend less
    binned = bin_segments([segments_through(brown_of((0.2, 0.0, 0.0)), 60, bent=0.5, noise=0.2)], *SIZE)
    mixture, structure = mixture_of(binned), structures(binned)
    found, more = (refine(binned, mixture, structure, 0.19, most_steps=most)[0] for most in (12, 40))
    assert found == pytest.approx(more, abs=2e-3)
    other, _ = refine(binned, mixture, structure, 0.22)
    low, high = (Division.from_parameters(*SIZE, parameters) for parameters in (found, other))
    assert field_error(low, high, *SIZE).rms < 0.3


def test_what_is_not_sure_of_k1_tells_nothing_further(segments_through):
    binned = bin_segments([segments_through(brown_of((0.2, 0.0, 0.0)), 4, noise=0.4, shortest=70.0)], *SIZE)
    fit = fit_lens(binned.select(np.arange(2)), *SIZE)
    assert fit.scan.sd > SURE_OF_K1
    assert not fit.refined
    assert fit.parameters.tolist() == [fit.scan.mean, 0, 0, 0, 0]


def test_the_scan_finds_k1(segments_through):
    binned = bin_segments([segments_through(brown_of((0.2, 0.0, 0.0)), 40)], *SIZE)
    fit = fit_lens(binned, *SIZE)
    assert SCAN[np.argmax(fit.scan.probability)] == pytest.approx(0.2, abs=0.02)


def test_more_segments_leave_less_uncertainty(segments_through):
    lens = brown_of((0.2, 0.0, 0.0))
    few, many = (
        lens_uncertainty(fit_lens(bin_segments([segments_through(lens, count, noise=0.2)], *SIZE), *SIZE), *SIZE)
        for count in (8, 200)
    )
    assert many.pred < 0.8 * few.pred
    assert many.scan_spread < 0.8 * few.scan_spread
    assert many.correction == pytest.approx(field_error(Brown.identity(*SIZE), lens, *SIZE).rms, rel=0.1)
