"""What comes first in a review."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from app.errors import InvalidInput
from app.review.review_order import ORDERS, lens_information, review_order, review_values, uncertainty
from app.vision import Segments

SIZE = (640, 480)
Lines = Callable[..., Segments]


def test_uncertainty_in_bits() -> None:
    assert uncertainty([0.5, 0.0, 1.0]) == pytest.approx([1, 0, 0], abs=1e-6)
    assert uncertainty([0.25])[0] == pytest.approx(0.8112781)


def test_long_lines_far_from_the_centre_tell_most_of_the_lens(lines: Lines) -> None:
    long_outside, long_through_centre, short_outside = (
        ((60, 40), (580, 40)),
        ((60, 239.5), (580, 239.5)),
        ((60, 40), (160, 40)),
    )
    found = lens_information(lines([short_outside, long_through_centre, long_outside]), SIZE)
    assert found[2] == 1
    assert found[1] == pytest.approx(0, abs=1e-9)
    assert 0 < found[0] < 0.1


def test_orders(lines: Lines) -> None:
    segments = lines([((400, 40), (580, 40)), ((60, 240), (160, 240)), ((250, 60), (350, 60))])
    p = [0.9, 0.5, 0.05]
    assert review_order(p, segments, SIZE, "uncertain").tolist() == [1, 0, 2]
    assert review_order(p, segments, SIZE, "lens").tolist()[0] == 0
    assert review_order(p, segments, SIZE, "place").tolist() == [1, 2, 0]
    assert ((review_values(p, segments, SIZE) >= 0) & (review_values(p, segments, SIZE) <= 1)).all()


@pytest.mark.parametrize("order", ORDERS)
def test_every_order_is_a_permutation(facade: tuple[Segments, np.ndarray], order: str) -> None:
    segments, _ = facade
    p = np.random.default_rng(1).random(len(segments))
    assert sorted(review_order(p, segments, SIZE, order)) == list(range(len(segments)))  # type: ignore[arg-type]
    assert len(review_order([], Segments.empty(), SIZE, order)) == 0  # type: ignore[arg-type]


def test_an_unknown_order_is_refused(lines: Lines) -> None:
    with pytest.raises(InvalidInput, match="no order"):
        review_order([0.5], lines([((0, 0), (9, 0))]), SIZE, "backwards")  # type: ignore[arg-type]
