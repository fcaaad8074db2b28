"""kill -9 of the server while verdicts, images, a run and submissions are under way: nothing lost, nothing twice."""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import httpx2 as httpx
import pytest

LINES = 60
RUN_IMAGES = 8


def results(names: list[str]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name in names:
            points = [[[5, 3 + row], [150, 3.5 + row]] for row in range(20)]
            archive.writestr(f"{name}.json", json.dumps({"segments": [{"points": line} for line in points]}))
    return stream.getvalue()


def submit_to(split: str, content: bytes) -> Any:
    def ask(client: httpx.Client, number: int) -> tuple[Any, httpx.Response]:
        name = f"m{number}"
        files = [("files", ("results.zip", content))]
        answer = client.post(f"/splits/{split}/submissions", files=files, data={"method": name})
        return name, answer

    return ask


@pytest.mark.timeout(300)
# of the same with SQLite tell tests/jobs/test_killed_processes.py and tests/e2e/test_label_durability.py
@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
def test_a_killed_server_has_lost_nothing_and_does_nothing_twice(make_site, make_crowd, tools, database_url) -> None:
    site = make_site(environment={"CLEARLINES_DATABASE_URL": database_url})
    site.start()
    (judged,) = site.make_dataset("judged", {"one.png": tools.picture(1), "one.json": tools.label_file(LINES)})
    segments = [row["id"] for row in site.ask("GET", f"/images/{judged}/segments")["segments"]]
    kept = json.loads(tools.label_file(20).replace(b"undecided", b"keep"))
    files = {f"images/{n}.png": tools.picture(n) for n in range(3)}
    files |= {f"labels/{n}.json": json.dumps(kept).encode() for n in range(3)}
    site.make_dataset("truth", files)
    site.ask("POST", "/datasets/truth/splits", json={"name": "board", "daily_limit": 1000})
    site.make_dataset("street", {f"{n}.png": tools.picture(100 + n) for n in range(RUN_IMAGES)})
    site.ask("POST", "/datasets", json={"name": "arriving"})
    run = site.ask("POST", "/datasets/street/runs", json={})["id"]

    crowd = make_crowd(site)
    verdicts = crowd.add(tools.decide_on(judged, segments))
    images = crowd.add(tools.upload_to("arriving"))
    submissions = crowd.add(submit_to("board", results([f"{n}" for n in range(3)])))
    tools.eventually(
        lambda: len(verdicts.answered) > 9 and len(images.answered) > 4 and len(submissions.answered) > 0,
        "everybody is at work",
    )
    site.kill()
    before = [len(record.answered) for record in (verdicts, images, submissions)]
    site.start()
    tools.eventually(
        lambda: all(
            len(record.answered) > count for record, count in zip((verdicts, images, submissions), before, strict=True)
        ),
        "everybody goes on",
    )
    crowd.stop()
    assert [record.refused for record in (verdicts, images, submissions)] == [[], [], []]

    tools.check_verdicts(site, judged, verdicts)
    tools.check_images(site, "arriving", images)
    tools.check_run(site, run)
    check_submissions(site, tools, submissions)


def check_submissions(site, tools, submissions) -> None:
    """Each that was answered is scored, all alike, and stands on the board once."""
    listed = tools.eventually(
        lambda: (
            (found := site.items("/splits/board/submissions"))
            and all(row["status"] == "scored" for row in found)
            and found
        ),
        "all submissions are scored",
    )
    methods = [row["method"]["name"] for row in listed]
    assert len(set(methods)) == len(methods)
    assert set(submissions.answered) <= set(methods)
    board = site.ask("GET", "/splits/board/board")
    rows = board["rows"]
    assert sorted(row["method"]["name"] for row in rows) == sorted(methods)
    assert len({json.dumps(row["totals"], sort_keys=True) for row in rows}) == 1
