"""A disk that is full: who asks is told so, nothing is half-written, and with room again it goes on by itself."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

LINES = 40
ROOM = "size=24m"


def may_mount() -> bool:
    """Whether a file system of a given size can be had, seen by the server alone."""
    if not sys.platform.startswith("linux") or os.geteuid() != 0 or shutil.which("unshare") is None:
        return False
    tried = ["unshare", "-m", "sh", "-c", "mount -t tmpfs -o size=1m tmpfs /mnt"]
    return subprocess.run(tried, capture_output=True, check=False).returncode == 0


def fill(ballast: Path) -> None:
    """Take all the room that is left."""
    with ballast.open("ab", buffering=0) as file:
        for size in (2**20, 2**12, 2**9):
            with suppress(OSError):
                while True:
                    file.write(bytes(size))
    assert shutil.disk_usage(ballast.parent).free < 4096


@pytest.mark.timeout(300)
@pytest.mark.skipif(not may_mount(), reason="needs root on Linux, to mount a small tmpfs in a namespace of its own")
def test_a_full_disk_is_told_and_costs_nothing(make_site, make_crowd, tools, tmp_path) -> None:
    data = tmp_path / "data"
    data.mkdir()
    mount = f"mount -t tmpfs -o {ROOM} tmpfs '{data}' && exec \"$@\""
    site = make_site(data=data, prefix=("unshare", "-m", "sh", "-c", mount, "sh"))
    site.start()
    seen_by_server = Path(f"/proc/{site.process.pid}/root{data}")
    assert (seen_by_server / "clearlines.sqlite3").is_file()
    (judged,) = site.make_dataset("judged", {"one.png": tools.picture(1), "one.json": tools.label_file(LINES)})
    segments = [row["id"] for row in site.ask("GET", f"/images/{judged}/segments")["segments"]]
    site.ask("POST", "/datasets", json={"name": "arriving"})
    crowd = make_crowd(site)
    verdicts, images = crowd.add(tools.decide_on(judged, segments)), crowd.add(tools.upload_to("arriving"))
    tools.eventually(lambda: len(verdicts.answered) > 3 and len(images.answered) > 2, "both are at work")

    def both_are_told() -> bool:
        fill(seen_by_server / "ballast")
        return bool(verdicts.refused and images.refused)

    tools.eventually(both_are_told, "both are told")
    assert site.ask("GET", "/datasets/arriving")["images"] >= 3, "reading goes on"
    before = len(verdicts.answered), len(images.answered)
    (seen_by_server / "ballast").unlink()
    tools.eventually(
        lambda: len(verdicts.answered) > before[0] and len(images.answered) > before[1], "both go on with room again"
    )
    crowd.stop()

    told = [*verdicts.refused, *images.refused]
    assert {(status, body["code"]) for status, body in told} == {(507, "no-room")}, told
    assert all("no room" in body["message"] and body["hint"] for _, body in told)
    tools.check_verdicts(site, judged, verdicts)
    tools.check_images(site, "arriving", images)
    assert list((seen_by_server / "blobs" / "incoming").iterdir()) == []
