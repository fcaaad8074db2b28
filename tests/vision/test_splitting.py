import numpy as np
import pytest

from app.vision.splitting import split


def runs(across: np.ndarray, offsets: list[int] | None = None) -> list[tuple[int, int]]:
    bounds = np.array(offsets or [0, len(across)], np.int64)
    along = np.concatenate([np.zeros(0), *(np.arange(count) for count in np.diff(bounds))])
    first, last = split(along, np.asarray(across, float), bounds)
    return list(zip(first.tolist(), last.tolist(), strict=True))


def test_a_line_stays_whole() -> None:
    assert runs(0.3 * np.arange(80)) == [(0, 80)]


def test_a_gentle_arc_stays_whole() -> None:
    assert runs(np.arange(100.0) ** 2 / 2000) == [(0, 100)]


def test_a_corner_is_cut_at_its_point() -> None:
    x = np.arange(61.0)
    assert runs(0.8 * np.abs(x - 30)) == [(0, 30), (31, 61)]


def test_a_tight_curve_becomes_several_runs_within_tolerance() -> None:
    x = np.arange(121.0)
    across = 40 - np.sqrt(100.0**2 - (x - 60) ** 2)
    found = runs(across)
    assert len(found) >= 2
    for first, last in found:
        coefficients = np.polyfit(x[first:last], across[first:last], 2)
        assert np.abs(np.polyval(coefficients, x[first:last]) - across[first:last]).max() < 0.7


def test_chains_are_split_apart_from_each_other() -> None:
    x = np.arange(40.0)
    across = np.concatenate([0 * x, 5 * (x > 20), 0.5 * x])
    found = runs(across, [0, 40, 80, 120])
    assert found[0] == (0, 40)
    assert found[-1] == (80, 120)
    assert all(40 <= first < last <= 80 for first, last in found[1:-1])


@pytest.mark.parametrize("count", [0, 1, 5])
def test_a_short_chain_gives_nothing(count: int) -> None:
    assert runs(np.zeros(count), [0, count] if count else [0]) == []


def test_six_points_are_kept() -> None:
    assert runs(np.zeros(6)) == [(0, 6)]
