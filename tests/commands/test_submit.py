"""``clearlines submit`` and ``clearlines baseline`` with a real server."""

from __future__ import annotations

import io
import json
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import httpx2 as httpx
import numpy as np
import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "docs" / "examples" / "submit.py"
NAMES = ("a/one", "a/two", "b/three")


def bars(seed: int) -> np.ndarray:
    image = np.full((240, 320), 60, np.uint8)
    for x in (30, 140, 240):
        cv2.rectangle(image, (x + seed, 15), (x + seed + 45, 225), 200, -1, cv2.LINE_AA)
    return image


def edges(seed: int) -> list[list[list[float]]]:
    """The upright edges of the bars, a point at each pixel."""
    return [[[x + seed + side, y] for y in range(20, 220)] for x in (30, 140, 240) for side in (-0.5, 45.5)]


def write_dataset(folder: Path) -> None:
    for seed, name in enumerate(NAMES):
        picture = folder / "images" / f"{name}.png"
        picture.parent.mkdir(parents=True, exist_ok=True)
        picture.write_bytes(cv2.imencode(".png", bars(seed))[1].tobytes())
        labels = folder / "labels" / f"{name}_edge_segments_filtered.npy"
        labels.parent.mkdir(parents=True, exist_ok=True)
        stream = io.BytesIO()
        array = np.empty(6, dtype=object)
        for index, line in enumerate(edges(seed)):
            array[index] = np.array(line).reshape(-1, 1, 2)
        np.save(stream, array, allow_pickle=True)
        labels.write_bytes(stream.getvalue())


def write_results(folder: Path) -> Path:
    for seed, name in enumerate(NAMES[:2]):
        path = folder / f"{name}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps({"segments": [{"points": line} for line in edges(seed)]}))
    (folder / ".hidden.json").write_text("{")
    return folder


@pytest.fixture
def split(tmp_path: Path, clearlines: Callable[..., Any], start: Callable[..., Any]) -> tuple[str, str]:
    """Address of a server and slug of a split on it."""
    write_dataset(tmp_path / "street")
    clearlines("import", tmp_path / "street", "--dataset", "street")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    start("serve", "--no-browser", "--port", port)
    address = f"http://127.0.0.1:{port}"
    deadline = time.monotonic() + 90
    while True:
        try:
            httpx.get(f"{address}/api/health", timeout=60).raise_for_status()
            break
        except httpx.HTTPError:
            assert time.monotonic() < deadline
            time.sleep(0.1)
    given = {"name": "Street", "visibility": "open", "min_length": 50}
    made = httpx.post(f"{address}/api/datasets/street/splits", json=given, timeout=60)
    assert made.status_code == 201, made.text
    return address, made.json()["slug"]


def test_results_are_checked_handed_in_and_scored(
    clearlines: Callable[..., Any], split: tuple[str, str], tmp_path: Path
) -> None:
    address, slug = split
    results = write_results(tmp_path / "results")
    target = ("--server", address, "--split", slug)
    checked = clearlines("submit", results, *target, "--validate").stderr
    assert "valid: 12 segments of 2 images" in checked
    assert "without a file, counted as empty: b/three" in checked

    done = clearlines("submit", results, *target, "--method", "Edges", "--label", "v1").stderr
    assert "scored under clearlines-v2" in done
    assert "f1           0.800" in done  # 12 of 18 labels found, nothing false
    assert f"{address}/submissions/1" in done

    (results / "a" / "two.json").write_text('{"segments": [{"points": [[1, 2], [NaN, 3]]}, {"points": []}]}')
    (results / "a" / "four.json").write_text('{"segments": []}')
    refused = clearlines("submit", results, *target, "--method", "Edges", status=1).stderr
    assert "3 things are wrong" in refused
    assert "a/two.json, segment 0, point 1: a coordinate is not finite" in refused
    assert "a/two.json, segment 1: a segment has no points" in refused
    assert "a/four.json: there is no image of this name" in refused

    assert (
        "there is no split nowhere"
        in clearlines("submit", results, "--server", address, "--split", "nowhere", "--method", "x", status=2).stderr
    )
    assert (
        "doesn't answer"
        in clearlines(
            "submit", results, "--server", "http://127.0.0.1:9", "--split", slug, "--method", "x", status=2
        ).stderr
    )

    names = clearlines("baseline", slug).stderr
    assert "Pre-labelling pipeline (ClearLines" in names
    assert "OpenCV LSD (OpenCV" in names
    clearlines("baseline", slug)  # again: nothing new
    rows = httpx.get(f"{address}/api/splits/{slug}/board", timeout=60).json()["rows"]
    assert {row["method"]["kind"] for row in rows} == {"baseline", "method"}
    assert len(rows) == 3
    assert {row["method"]["name"]: row["totals"]["recall"]["value"] for row in rows}["OpenCV LSD"] == 1.0

    whole = {
        "images": {name: {"segments": [{"points": line} for line in edges(seed)]} for seed, name in enumerate(NAMES)}
    }
    (tmp_path / "whole.json").write_text(json.dumps(whole))
    command = [sys.executable, EXAMPLE, address, slug, tmp_path / "whole.json", "--method", "By REST"]
    shown = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert shown.returncode == 0, shown.stderr
    assert "F1 1.000" in shown.stdout
    assert "6 found, 0 false, 0 missed" in shown.stdout
