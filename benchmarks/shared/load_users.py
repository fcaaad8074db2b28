"""The people of the load benchmark, as locust runs them: annotators, readers and submitters.

What each annotator and submitter sent and was answered goes to a file of its own in the folder ``LOAD_RECORDS``; the
world that they meet is described by the file ``LOAD_WORLD``.
"""

from __future__ import annotations

import itertools
import json
import os
import random
from pathlib import Path
from typing import Any
from uuid import uuid4

from locust import FastHttpUser, between, task

WORLD = json.loads(Path(os.environ["LOAD_WORLD"]).read_text())
RECORDS = Path(os.environ["LOAD_RECORDS"])
BATCH = 5
BATCHES = 12
COUNTS = json.loads(os.environ["LOAD_COUNTS"])
NUMBERS = {kind: itertools.count() for kind in COUNTS}


class Person(FastHttpUser):
    """Somebody who asks one of the servers, each the same one all the time."""

    abstract = True
    kind = ""

    def on_start(self) -> None:
        self.number = next(NUMBERS[self.kind])
        hosts = WORLD["hosts"]
        self.host = hosts[self.number % len(hosts)]
        self.client.base_url = f"{self.host}/api"
        self.random = random.Random(self.number)
        self.record: list[dict[str, Any]] = []

    def on_stop(self) -> None:
        (RECORDS / f"{self.kind}-{self.number}.json").write_text(json.dumps(self.record))

    def get(self, name: str, path: str) -> Any:
        """Ask, and return the answer's document; errors are counted by locust."""
        answer = self.client.get(f"{self.host}/api{path}", name=name)
        return answer.json() if answer.status_code == 200 else None


class Annotator(Person):
    """Opens one image after the other, holds it, and gives verdicts in batches."""

    kind = "annotator"
    fixed_count = COUNTS["annotator"]
    wait_time = between(0.05, 0.15)

    def on_start(self) -> None:
        super().on_start()
        images = WORLD["labelled"]
        self.images = itertools.cycle(images[self.number :: COUNTS["annotator"]] or images)
        self.page = str(uuid4())
        self.open_next()

    def open_next(self) -> None:
        self.image = next(self.images)
        lease = {"client_id": self.page}
        self.client.put(f"{self.host}/api/images/{self.image}/lease", json=lease, name="lease")
        found = self.get("candidates", f"/images/{self.image}/segments") or {"segments": []}
        self.client.get(f"{self.host}/api/images/{self.image}/points", name="candidates' points")
        self.client.get(f"{self.host}/api/images/{self.image}/display", name="display")
        self.segments = [segment["id"] for segment in found["segments"]]
        self.left = BATCHES

    @task
    def decide(self) -> None:
        if not self.left or not self.segments:
            self.open_next()
            return
        self.left -= 1
        group = str(uuid4())
        rows = [
            {
                "client_id": str(uuid4()),
                "group_id": group,
                "segment_id": segment,
                "verdict": self.random.choice(("keep", "reject", "ambiguous")),
            }
            for segment in self.random.sample(self.segments, BATCH)
        ]
        answer = self.client.post(
            f"{self.host}/api/images/{self.image}/decisions", json={"decisions": rows}, name="decide (5 verdicts)"
        )
        self.record.append({"image": self.image, "rows": rows, "good": answer.status_code == 200})


class Reader(Person):
    """Browses: datasets, an image list with its thumbnails, an image, the board."""

    kind = "reader"
    fixed_count = COUNTS["reader"]
    wait_time = between(0.1, 0.3)

    @task(1)
    def datasets(self) -> None:
        self.get("datasets", "/datasets")

    @task(4)
    def images(self) -> None:
        images = WORLD["browsed"]
        page = self.get("image list", "/datasets/browsed/images?limit=50")
        for image in self.random.sample(images, 3):
            self.client.get(f"{self.host}/api/images/{image}/thumbnail", name="thumbnail")
        if page and page["next_cursor"]:
            self.get("image list", f"/datasets/browsed/images?limit=50&cursor={page['next_cursor']}")

    @task(2)
    def image(self) -> None:
        image = self.random.choice(WORLD["browsed"])
        self.get("image", f"/images/{image}")
        self.client.get(f"{self.host}/api/images/{image}/display", name="display")

    @task(2)
    def board(self) -> None:
        self.get("board", "/splits/board/board")


class Submitter(Person):
    """Hands in zips of predictions, and looks at how they fare."""

    kind = "submitter"
    fixed_count = COUNTS["submitter"]
    wait_time = between(0.5, 1.5)

    @task
    def hand_in(self) -> None:
        content = Path(WORLD["results"]).read_bytes()
        name = f"method {self.number}-{len(self.record)}"
        answer = self.client.post(
            f"{self.host}/api/splits/board/submissions",
            files={"files": ("results.zip", content, "application/zip")},
            data={"method": name},
            name="submit",
        )
        good = answer.status_code == 202
        self.record.append({"method": name, "good": good})
        if good:
            self.get("submission", f"/submissions/{answer.json()['id']}")
