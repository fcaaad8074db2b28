"""A camera whose images show straight lines through a lens that is known, labelled and calibrated."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.calibration.lens import CameraLens

SIZE = (320, 240)
LENS = CameraLens("division", *SIZE, (0.12, 0.0, 0.0, 0.0, 0.0))


def bent_lines(seed: int, count: int = 20) -> list[np.ndarray]:
    """Straight lines of the scene as the image shows them, px."""
    random = np.random.default_rng(seed)
    lines: list[np.ndarray] = []
    while len(lines) < count:
        ends = random.uniform((3, 3), (SIZE[0] - 4, SIZE[1] - 4), (2, 2))
        if np.hypot(*(ends[0] - ends[1])) > 90:
            corrected = LENS.undistort(ends)
            points = LENS.distort(np.linspace(corrected[0], corrected[1], 60))
            lines.append(points + random.normal(0, 0.05, points.shape))
    return lines


def street(seed: int, verdict: str = "keep") -> dict[str, bytes]:
    """An image with these lines drawn, and a label file that says this of them; a few are rejected."""
    picture = np.full((SIZE[1], SIZE[0], 3), 90, np.uint8)
    picture[:, :, 2] = seed
    lines = bent_lines(seed)
    for points in lines:
        cv2.polylines(picture, [np.round(points).astype(np.int32)], False, (230, 230, 230), 1, cv2.LINE_AA)
    segments = [{"points": points.tolist(), "verdict": verdict} for points in lines]
    segments += [{"points": [[5, 5 + row], [100, 90 + row]], "verdict": "reject"} for row in range(3)]
    return {
        f"images/drive/{seed}.png": cv2.imencode(".png", picture)[1].tobytes(),
        f"labels/drive/{seed}.json": json.dumps({"segments": segments}).encode(),
    }


@pytest.fixture
def finish(client: TestClient) -> Callable[[int], dict[str, Any]]:
    """Wait for a calibration and return it."""

    def finish(calibration: int) -> dict[str, Any]:
        deadline = time.monotonic() + 90
        while (state := client.get(f"/api/calibrations/{calibration}").json())["status"] in ("queued", "running"):
            assert time.monotonic() < deadline, state
            time.sleep(0.05)
        return state

    return finish


@pytest.fixture
def camera(client: TestClient, upload: Callable[..., dict[str, Any]]) -> int:
    """A camera of three labelled images, and one that nobody has labelled."""
    labelled = {name: content for seed in (1, 2, 3) for name, content in street(seed).items()}
    upload("street", {**labelled, **street(9, "undecided")})
    return client.get("/api/datasets/street/cameras").json()[0]["id"]
