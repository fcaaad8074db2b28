import hashlib
import os
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.storage.caching import ReadCache

MOST = 8000


def blob(number: int, size: int = 1000) -> tuple[str, bytes]:
    content = bytes([number]) * size
    return hashlib.sha256(content).hexdigest(), content


def total(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.iterdir())


def test_what_was_not_read_longest_goes_first(tmp_path: Path) -> None:
    cache = ReadCache(tmp_path, MOST)
    blobs = [blob(number) for number in range(9)]
    for age, (sha256, content) in enumerate(blobs[:8]):
        cache.add(sha256, content)
        os.utime(tmp_path / sha256, (1000 + age, 1000 + age))
    assert cache.get(blobs[0][0]) == blobs[0][1]  # so that the second is the oldest
    cache.add(*blobs[8])
    assert {sha256 for sha256, _ in blobs} - {path.name for path in tmp_path.iterdir()} == {blobs[1][0]}


def test_a_copy_that_is_not_what_it_is_called_is_none(tmp_path: Path) -> None:
    cache = ReadCache(tmp_path, MOST)
    sha256, content = blob(1)
    cache.add(sha256, content)
    (tmp_path / sha256).write_bytes(content[:-1])
    assert cache.get(sha256) is None
    assert list(tmp_path.iterdir()) == []


def test_large_contents_are_not_kept(tmp_path: Path) -> None:
    cache = ReadCache(tmp_path, MOST)
    cache.add(*blob(1, MOST // 8 + 1))
    assert list(tmp_path.iterdir()) == []
    cache.add(*blob(1, MOST // 8))
    assert total(tmp_path) == MOST // 8


def test_without_its_folder_nothing_is_kept_and_nothing_breaks(tmp_path: Path) -> None:
    cache = ReadCache(tmp_path / "cache", MOST)
    (tmp_path / "cache").rmdir()
    sha256, content = blob(1)
    cache.add(sha256, content)
    assert cache.get(sha256) is None
    cache.forget(sha256)


@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(steps=st.lists(st.tuples(st.integers(0, 1), st.integers(0, 20), st.integers(0, 1000)), max_size=40))
def test_two_processes_together_stay_near_the_bound(tmp_path: Path, steps: list[tuple[int, int, int]]) -> None:
    caches = [ReadCache(tmp_path, MOST), ReadCache(tmp_path, MOST)]
    for which, number, size in steps:
        sha256, content = blob(number, size)
        found = caches[which].get(sha256)
        assert found in (None, content)
        if found is None:
            caches[which].add(sha256, content)
        assert total(tmp_path) <= MOST + 2 * (MOST // 16)
