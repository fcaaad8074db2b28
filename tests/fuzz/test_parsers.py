"""Valid files, changed in all manners: each parser reads them or tells what is wrong, and takes little memory for it.

The same changes each time. By hand, others and more of them, or guided by the code that is reached:

    CLEARLINES_FUZZ=20000 .venv/bin/pytest tests/fuzz
    .venv/bin/python tools/fuzz.py PARSER --seconds 60
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tools.fuzzing.mutations import CHANGES, changed
from tools.fuzzing.parsers import PARSERS, outcome

EXAMPLES = int(os.environ.get("CLEARLINES_FUZZ", "0"))
GROWTH = 512 * 2**20  # bytes beyond what the process has already


@pytest.fixture
def bounded_memory() -> Iterator[None]:
    """Let the process grow by so much and no more: what asks for more gets a MemoryError."""
    if not sys.platform.startswith("linux"):
        yield
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + GROWTH, hard))
    yield
    resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


@pytest.mark.parametrize("name", PARSERS)
def test_the_files_to_begin_from_are_read(name: str) -> None:
    parser = PARSERS[name]
    read = [outcome(parser, seed.form(seed.content)) for seed in parser.seeds()]
    assert None in read, read
    assert sum(error is not None for error in read) <= len(read) // 4, read


@pytest.mark.timeout(60 if not EXAMPLES else 3600)
@pytest.mark.parametrize("name", PARSERS)
@pytest.mark.usefixtures("bounded_memory")
def test_changed_files_are_read_or_refused_and_nothing_else(name: str) -> None:
    parser = PARSERS[name]
    seeds = parser.seeds()
    refused: list[bool] = []

    @settings(
        max_examples=EXAMPLES or 60,
        derandomize=not EXAMPLES,
        database=None,
        phases=[Phase.generate, Phase.shrink],
        suppress_health_check=[HealthCheck.too_slow],
    )
    @given(st.sampled_from(range(len(seeds))), CHANGES)
    def read_changed(place: int, changes: list) -> None:
        seed = seeds[place]
        refused.append(outcome(parser, seed.form(changed(seed.content, changes))) is not None)

    read_changed()
    assert any(refused)
    if name not in ("zip", "cursor", "names", "cameras"):  # hardly anything may be changed there
        assert not all(refused)
