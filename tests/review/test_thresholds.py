"""Thresholds from calibrated probabilities."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import InvalidInput
from app.review.thresholds import CHEAPEST, thresholds_for


def test_as_many_are_accepted_as_the_rate_allows() -> None:
    # kept from the most certain on: errors of 0.02, 0.1, 0.4 have means of 0.02, 0.06, 0.173
    p = [0.98, 0.9, 0.6, 0.05, 0.3]
    assert thresholds_for(p, 0.06) == pytest.approx((0.75, 0.175))
    assert thresholds_for(p, 0.5) == CHEAPEST


def test_nothing_wrong_wanted_accepts_nothing_uncertain() -> None:
    keep, reject = thresholds_for([0.9, 0.2], 0.0)
    assert keep > 0.9
    assert reject < 0.2


def test_those_alike_are_let_in_together_or_not_at_all() -> None:
    assert thresholds_for([1.0, 1.0, 0.8, 0.8], 0.07).keep == pytest.approx(0.9)


@given(st.lists(st.floats(0, 1), max_size=60), st.floats(0, 1))
def test_the_rate_holds_for_those_accepted(probabilities: list[float], rate: float) -> None:
    p = np.array(probabilities)
    keep, reject = thresholds_for(p, rate)
    assert 0 <= reject <= 0.5 <= keep <= 1
    for wrong in (1 - p[p >= keep], p[p < reject]):
        assert not len(wrong) or wrong.mean() <= rate + 1e-9


def test_a_rate_that_is_none_is_refused() -> None:
    with pytest.raises(InvalidInput, match="error rate"):
        thresholds_for([0.5], 1.5)
