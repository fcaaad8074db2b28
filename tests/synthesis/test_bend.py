from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.synthesis.bend import Bend

bends = st.builds(
    lambda radius, side, begins, length: Bend(side / radius, begins, begins + length),
    st.floats(45, 200), st.sampled_from([-1, 1]), st.floats(5, 40), st.floats(5, 60),
)  # fmt: skip


def test_a_straight_street_is_its_plan() -> None:
    assert np.allclose(Bend().place([1.0, -2.0], [3.0, 40.0], 0.5), [[1, -0.5, 3], [-2, -0.5, 40]])
    assert Bend().pieces(-3, 70) == [(-3, 70, True)]


@settings(max_examples=50, deadline=None)
@given(bends, st.floats(-5, 120), st.floats(-6, 6))
def test_the_plan_is_laid_out_without_gaps_or_stretching_of_the_axis(bend: Bend, z: float, x: float) -> None:
    step = 1e-4
    axis = (bend.place(0.0, z + step) - bend.place(0.0, z)) / step
    assert np.linalg.norm(axis) == pytest.approx(1, abs=1e-4)
    assert np.arctan2(axis[0], axis[2]) == pytest.approx(float(bend.heading(z + step / 2)), abs=1e-3)
    assert np.linalg.norm(bend.place(x, z) - bend.place(0.0, z)) == pytest.approx(abs(x), abs=1e-9)
    assert (bend.place(x, z) - bend.place(0.0, z)) @ axis == pytest.approx(0, abs=1e-3)


@settings(max_examples=50, deadline=None)
@given(bends, st.floats(-5, 60), st.floats(1, 60))
def test_pieces_are_straight_where_they_say(bend: Bend, z0: float, length: float) -> None:
    pieces = bend.pieces(z0, z0 + length)
    assert pieces[0][0] == z0
    assert pieces[-1][1] == z0 + length
    for begin, end, straight in pieces:
        middle = (bend.place(2.0, begin) + bend.place(2.0, end)) / 2
        off = np.linalg.norm(bend.place(2.0, (begin + end) / 2) - middle)
        assert (off < 1e-9) == (straight or end - begin < 1e-4)


def test_steps_are_close_on_the_arc_alone() -> None:
    steps = np.diff(Bend(0.01, 20, 40).steps(0, 60, 2.0))
    assert steps[0] == steps[-1] == 20
    assert np.allclose(steps[1:-1], 2.0)
