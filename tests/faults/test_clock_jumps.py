"""A clock that jumps a day ahead, then back to an hour ago, while people and workers are at work."""

from __future__ import annotations

import sys
from datetime import UTC, datetime
from pathlib import Path

import pytest

LINES = 40
PAGE = "5f0c7a3e-6f0f-4e8e-9d53-0a6f0f1c2b3d"


@pytest.fixture
def clock(tmp_path: Path) -> tuple[Path, dict[str, str]]:
    """The file that says how far the clock is off, and what makes a process look at it; monotonic clocks stay right."""
    if not sys.platform.startswith("linux"):
        pytest.skip("a clock can be changed for one process on Linux")
    libfaketime = pytest.importorskip("libfaketime")
    library = Path(libfaketime.__file__).parent / "vendor" / "libfaketime" / "src" / "libfaketime.so.1"
    file = tmp_path / "clock"
    file.write_text("+0\n")
    return file, {
        "LD_PRELOAD": str(library),
        "FAKETIME_TIMESTAMP_FILE": str(file),
        "FAKETIME_CACHE_DURATION": "1",
        "DONT_FAKE_MONOTONIC": "1",
    }


def jump(file: Path, seconds: int) -> None:
    """Set the clock so far off the right time, at once."""
    other = file.with_suffix(".new")
    other.write_text(f"{seconds:+d}\n")
    other.replace(file)


@pytest.mark.timeout(300)
def test_clock_jumps_cost_nothing_and_repeat_nothing(make_site, make_crowd, tools, clock) -> None:
    file, environment = clock
    site = make_site(environment={**environment, "CLEARLINES_STALE_SECONDS": "5", "CLEARLINES_HEARTBEAT_SECONDS": "1"})
    site.start()
    (judged,) = site.make_dataset("judged", {"one.png": tools.picture(1), "one.json": tools.label_file(LINES)})
    segments = [row["id"] for row in site.ask("GET", f"/images/{judged}/segments")["segments"]]
    site.make_dataset("street", {f"{n}.png": tools.picture(100 + n) for n in range(3)})
    site.make_dataset("gone", {"2.png": tools.picture(2)})
    site.ask("DELETE", "/datasets/gone")

    crowd = make_crowd(site)
    verdicts = crowd.add(tools.decide_on(judged, segments))
    run = site.ask("POST", "/datasets/street/runs", json={})["id"]
    assert lease(site, judged)["mine"]
    for seconds in (86_400, -3_600):
        before = len(verdicts.answered)
        jump(file, seconds)
        tools.eventually(lambda seconds=seconds: is_off(site, judged, seconds), "the server's clock has jumped")
        tools.eventually(lambda before=before: len(verdicts.answered) > before + 5, "verdicts go on")
        assert lease(site, judged)["mine"], "who has the image open still holds it"
    crowd.stop()
    assert verdicts.refused == []
    tools.check_verdicts(site, judged, verdicts)
    tools.check_run(site, run)
    # a heartbeat that seems a day old is no reason to do anything again
    assert {row["attempts"] for row in site.items(f"/runs/{run}/images")} == {1}
    site.ask("POST", "/datasets/gone/restore")


def is_off(site, image: int, seconds: int) -> bool:
    """Whether the latest verdict bears a time that is so far off the right one."""
    latest = site.ask("GET", f"/images/{image}/decisions")["decisions"][-1]["created_at"]
    off = datetime.fromisoformat(latest) - datetime.now(UTC)
    return abs(off.total_seconds() - seconds) < 1_800


def lease(site, image: int):
    return site.ask("PUT", f"/images/{image}/lease", json={"client_id": PAGE})["holder"]
