from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.evaluation import nearest_samples as module
from app.evaluation.nearest_samples import Nearest, nearest_samples
from app.evaluation.resampling import Samples, resample
from app.vision.segments import Segments


def curves(seed: int, count: int) -> Samples:
    """Polylines that turn and cross, some of a few points."""
    random = np.random.default_rng(seed)
    lines = []
    for _ in range(count):
        steps = random.normal(0, 6, (random.integers(1, 12), 2))
        lines.append(random.uniform(0, 40, 2) + np.cumsum(steps, axis=0))
    return resample(Segments.from_list(lines))


def literal(a: Samples, b: Samples, reach: float) -> dict[tuple[int, int], float]:
    """Least distance of each sample of a to the samples of each polyline of b."""
    distance = np.hypot(*(a.points[:, None] - b.points[None]).transpose(2, 0, 1))
    least: dict[tuple[int, int], float] = {}
    for sample, other in zip(*np.nonzero(distance <= reach), strict=True):
        key = int(sample), int(b.polyline[other])
        least[key] = min(least.get(key, np.inf), float(distance[sample, other]))
    return least


def found(parts: list[Nearest], a: Samples, b: Samples) -> dict[tuple[int, int], float]:
    rows = [
        ((sample, int(b.polyline[nearest])), float(np.hypot(*(a.points[sample] - b.points[nearest]))))
        for part in parts
        for sample, nearest in zip(part.sample.tolist(), part.nearest.tolist(), strict=True)
    ]
    assert len(dict(rows)) == len(rows)
    return dict(rows)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(0, 6), st.integers(0, 6), st.floats(0.5, 12))
def test_equals_comparing_all_samples_with_all(seed: int, count_a: int, count_b: int, reach: float) -> None:
    a, b = curves(seed, count_a), curves(seed + 1, count_b)
    parts = list(nearest_samples(a, b, reach))
    assert found([forth for forth, _ in parts], a, b) == pytest.approx(literal(a, b, reach))
    assert found([back for _, back in parts], b, a) == pytest.approx(literal(b, a, reach))


@pytest.mark.parametrize(("limit", "value"), [("_PAIRS_LISTED", 20), ("_PAIRS_AT_ONCE", 3)])
def test_a_bound_on_memory_changes_nothing(monkeypatch: pytest.MonkeyPatch, limit: str, value: int) -> None:
    a, b = curves(7, 20), curves(8, 20)
    monkeypatch.setattr(module, limit, value)
    parts = list(nearest_samples(a, b, 4.0))
    assert len(parts) > 1 or limit == "_PAIRS_AT_ONCE"
    assert found([forth for forth, _ in parts], a, b) == pytest.approx(literal(a, b, 4.0))
    assert found([back for _, back in parts], b, a) == pytest.approx(literal(b, a, 4.0))
