"""What is written while people look: verdicts, a detection, an upload; and what the server does without being asked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from uuid import uuid4

import cv2
import httpx2 as httpx
import numpy as np
from shared.scale_requests import SLUG
from shared.scale_world import OPEN, World

from app.db.models import Dataset
from app.db.session import Database
from app.services.detections import FoundCandidates, store_detection
from app.services.lens_estimates import pending_estimates, pending_judgements
from app.services.purging import purge
from app.services.run_queue import claim_images, has_queued_images, unsettled_runs
from app.services.runs import start_run
from app.services.suggestion_features import images_without_features
from app.services.suggestion_training import next_training
from app.services.tallies import IMAGES, owners_to_merge
from app.settings import Settings
from app.storage import open_blobs
from app.vision.segments import Segments

DECIDED = 20
FOUND = 150


@dataclass(frozen=True)
class Writes:
    """What is written to one server.

    Attributes:
        address: Of its API.
        database: Its database.
        settings: Its settings.
        world: What it holds.
    """

    address: str
    database: Database
    settings: Settings
    world: World

    def decide(self, number: int) -> None:
        """Judge candidates of an image that waits for review."""
        waiting = np.flatnonzero(self.world.status == OPEN)
        row = int(waiting[number * 17 % len(waiting)])
        first = int(self.world.starts[row])
        verdicts = [
            {"client_id": str(uuid4()), "group_id": str(uuid4()), "segment_id": first + place, "verdict": "keep"}
            for place in range(min(DECIDED, int(self.world.candidates[row])))
        ]
        if verdicts:
            content = {"decisions": verdicts}
            _checked(httpx.post(f"{self.address}/images/{row + 1}/decisions", json=content, timeout=60))

    def upload(self, number: int) -> None:
        """Add one image to the largest dataset."""
        del number
        pixels = np.random.default_rng().integers(0, 255, (48, 64, 3), np.uint8)
        content = cv2.imencode(".png", pixels)[1].tobytes()
        files = {"files": (f"upload/{uuid4()}.png", content, "image/png")}
        _checked(httpx.post(f"{self.address}/datasets/{SLUG}/images", files=files, timeout=60))

    def store(self, number: int) -> None:
        """Start a run over one image of the largest dataset, claim it before the server does, store many candidates."""
        random = np.random.default_rng(number)
        polylines = [np.cumsum(random.random((30, 2)), axis=0) + 10 * place for place in range(FOUND)]
        found = FoundCandidates(Segments.from_list(polylines, random.random(FOUND)), None, 180.0)
        now = datetime.now(UTC)
        with self.database.write() as session:
            dataset = session.query(Dataset).filter_by(slug=SLUG).one()
            start_run(session, dataset, {"camera": "per-image"}, [int(self.world.first[1]) - number], now)
            claim = claim_images(session, 1, now)[0]
        with self.database.write() as session:
            store_detection(session, claim, found, now)

    def background(self) -> dict[str, Callable[[int], object]]:
        """Return what a server looks for again and again."""

        def reading(look: Callable[..., object]) -> Callable[[int], object]:
            def ask(_number: int) -> object:
                with self.database.read() as session:
                    return look(session)

            return ask

        def purged(_number: int) -> object:
            blobs = open_blobs(self.settings)
            return purge(self.database, blobs, datetime.now(UTC), grace=self.settings.grace)

        return {
            "work to claim": reading(has_queued_images),
            "runs to finish": reading(unsettled_runs),
            "lenses to estimate": reading(pending_estimates),
            "candidates to judge": reading(lambda session: pending_judgements(session, 4)),
            "tallies to merge": reading(lambda session: owners_to_merge(session, IMAGES)),
            "images to describe": reading(lambda session: images_without_features(session, 1)),
            "models to learn": reading(next_training),
            "purge": purged,
        }


def _checked(answer: httpx.Response) -> None:
    if answer.status_code not in (httpx.codes.OK, httpx.codes.CREATED):
        raise RuntimeError(f"{answer.status_code} {answer.text[:500]}")
