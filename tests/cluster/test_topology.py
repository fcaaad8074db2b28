"""The topology of the compose file, its parts killed in the middle of work: nothing is lost, nothing done twice."""

from __future__ import annotations

import signal
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import cv2
import numpy as np
import psutil

DEADLINE = 90.0


def eventually(condition: Callable[[], Any], what: str) -> Any:
    deadline = time.monotonic() + DEADLINE
    while not (value := condition()):
        assert time.monotonic() < deadline, f"never happened: {what}"
        time.sleep(0.1)
    return value


def drawn_image(seed: int) -> bytes:
    random = np.random.default_rng(seed)
    pixels = np.full((150, 200), 60, np.uint8)
    for height in (30, 70, 110):
        shift = int(random.integers(-5, 6))
        corners = np.array([[8, height], [190, height + shift], [190, height + shift + 14], [8, height + 14]], np.int32)
        cv2.fillPoly(pixels, [corners], 190)
    return cv2.imencode(".png", pixels)[1].tobytes()


def uploaded(topology: Any, server: str, slug: str, count: int) -> list[int]:
    """Make a dataset of so many images through a server; return their ids."""
    with topology.client(server) as client:
        assert client.post("/datasets", json={"name": slug}).is_success
        files = [("files", (f"{slug}-{seed}.png", drawn_image(seed), "image/png")) for seed in range(count)]
        answer = client.post(f"/datasets/{slug}/images", files=files)
        assert answer.is_success, answer.text
        return [image["id"] for image in client.get(f"/datasets/{slug}/images").json()["items"]]


def begun(topology: Any, server: str, slug: str) -> int:
    with topology.client(server) as client:
        answer = client.post(f"/datasets/{slug}/runs", json={"min_length": 40})
        assert answer.status_code == 202, answer.text
        return answer.json()["id"]


def counts(topology: Any, server: str, run_id: int) -> dict[str, int]:
    return topology.get(server, f"/runs/{run_id}")["counts"]


def working(topology: Any) -> list[psutil.Process]:
    """The worker processes, once there is one for each worker."""

    def found() -> list[psutil.Process]:
        children = [topology.part(name).children() for name in topology.named("worker")]
        return [each[0] for each in children] if all(children) else []

    return eventually(found, "each worker has a process")


@contextmanager
def held(topology: Any) -> Iterator[list[psutil.Process]]:
    """Hold all workers up in the middle of whatever they do."""
    processes = working(topology)
    for process in processes:
        process.suspend()
    try:
        yield processes
    finally:
        for process in processes:
            if process.is_running():
                process.resume()


def assert_done_once(topology: Any, server: str, run_id: int, images: list[int]) -> dict[int, int]:
    """All images are done, each with candidates; return how often each was tried."""
    eventually(lambda: topology.get(server, f"/runs/{run_id}")["status"] == "done", "the run is finished")
    rows = topology.get(server, f"/runs/{run_id}/images?limit=100")["items"]
    assert sorted(row["image"]["id"] for row in rows) == sorted(images)
    assert {row["status"] for row in rows} == {"done"}
    for image in images:
        segments = topology.get(server, f"/images/{image}/segments")["segments"]
        assert len(segments) > 0
        assert topology.get(server, f"/images/{image}")["candidates"] == len(segments)
    return {row["image"]["id"]: row["attempts"] for row in rows}


def test_a_killed_worker_costs_its_image_an_attempt_and_nobody_else(topology) -> None:
    images = uploaded(topology, "app-1", "worker", 6)
    with held(topology) as processes:
        run_id = begun(topology, "app-1", "worker")
        eventually(lambda: counts(topology, "app-2", run_id)["running"] == 4, "both workers have work")
        processes[0].send_signal(signal.SIGKILL)
        processes[0].wait(30)
    attempts = assert_done_once(topology, "app-2", run_id, images)
    assert sorted(attempts.values()) == [1, 1, 1, 1, 1, 2]


def test_a_killed_scheduler_costs_time_alone(topology) -> None:
    images = uploaded(topology, "app-2", "scheduler", 5)
    working(topology)
    with held(topology):
        run_id = begun(topology, "app-2", "scheduler")
        eventually(lambda: counts(topology, "app-1", run_id)["running"] >= 2, "both workers have work")
        topology.kill("scheduler")
        # the page tells the truth meanwhile: nobody works
        eventually(lambda: counts(topology, "app-1", run_id)["queued"] == 5, "all work is back in the queue")
    topology.restart("scheduler")
    assert set(assert_done_once(topology, "app-1", run_id, images).values()) == {1}


def test_decisions_through_both_servers_are_one_history(topology) -> None:
    (image,) = uploaded(topology, "app-1", "decisions", 1)
    run_id = begun(topology, "app-2", "decisions")
    assert_done_once(topology, "app-1", run_id, [image])
    segments = [segment["id"] for segment in topology.get("app-2", f"/images/{image}/segments")["segments"]]
    for place, segment in enumerate(segments):
        server, other = ("app-1", "app-2") if place % 2 else ("app-2", "app-1")
        decision = {
            "client_id": str(uuid.uuid4()),
            "group_id": str(uuid.uuid4()),
            "segment_id": segment,
            "verdict": "keep" if place % 2 else "reject",
        }
        with topology.client(server) as client:
            answer = client.post(f"/images/{image}/decisions", json={"decisions": [decision]})
            assert answer.is_success, answer.text
        seen = {each["id"]: each["verdict"] for each in topology.get(other, f"/images/{image}/segments")["segments"]}
        assert seen[segment] == decision["verdict"]
    assert len(segments) >= 2
    histories = [topology.get(name, f"/images/{image}/decisions") for name in ("app-1", "app-2")]
    assert histories[0] == histories[1]


def test_a_killed_server_is_replaced_by_the_other(topology) -> None:
    """The last one: it leaves one server dead."""
    images = uploaded(topology, "app-1", "server", 5)
    first = next(name for name in ("app-1", "app-2") if topology.get(name, "/status")["dispatcher"]["here"])
    second = {"app-1": "app-2", "app-2": "app-1"}[first]
    with held(topology):
        run_id = begun(topology, first, "server")
        eventually(lambda: counts(topology, second, run_id)["running"] >= 2, "both workers have work")
        topology.kill(first)
        eventually(lambda: topology.get(second, "/status")["dispatcher"]["here"], "the other one took over")
    attempts = assert_done_once(topology, second, run_id, images)
    assert max(attempts.values()) <= 2
