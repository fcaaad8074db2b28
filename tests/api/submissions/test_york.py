"""York's labels as a split: two detectors handed in through the API stand where the independent scorer puts them."""

from __future__ import annotations

import io
import json
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import pytest
from fastapi.testclient import TestClient

from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz
from app.services.baseline_detectors import detect_candidates, detect_lsd
from app.vision.segments import Segments

SHARED = Path(__file__).resolve().parents[4] / "shared"
YORK, SCORER = SHARED / "data" / "york", SHARED / "bench" / "score.py"
IMAGES = 4
SHORTEST = 30.0
DETECTORS: dict[str, Callable[[Any, float], Segments]] = {"LSD": detect_lsd, "Pipeline": detect_candidates}


def reference(labels: Path, predictions: Path) -> dict[str, Any]:
    """What the independent scorer says; it leaves short lines out of both sides, as nobody does here."""
    command = [sys.executable, SCORER, labels, predictions, "--min-length", "0"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=150)
    return json.loads(done.stdout)


@pytest.mark.skipif(not YORK.is_dir() or not SCORER.is_file(), reason="York's images aren't beside the project")
def test_the_board_says_what_the_independent_scorer_says(client: TestClient, tmp_path: Path) -> None:
    stems = [path.name.partition("_edge_segments")[0] for path in sorted((YORK / "labels").iterdir())][:IMAGES]
    upload = io.BytesIO()
    with zipfile.ZipFile(upload, "w") as archive:
        for stem in stems:
            (image,) = (YORK / "images").glob(f"{stem}.*")
            archive.write(image, f"images/{image.name}")
            name = f"{stem}_edge_segments_filtered.npy"
            archive.write(YORK / "labels" / name, f"labels/{name}")
            (tmp_path / "labels").mkdir(exist_ok=True)
            (tmp_path / "labels" / name).write_bytes((YORK / "labels" / name).read_bytes())
    assert client.post("/api/datasets", json={"name": "york"}).status_code == 201
    report = client.post("/api/datasets/york/images", files=[("files", ("york.zip", upload.getvalue()))]).json()
    assert report["labels"] == IMAGES
    assert client.post("/api/datasets/york/splits", json={"name": "York", "visibility": "open"}).status_code == 201

    expected = {}
    for method, detect in DETECTORS.items():
        folder, results = tmp_path / method, io.BytesIO()
        folder.mkdir()
        with zipfile.ZipFile(results, "w") as archive:
            for stem in stems:
                (image,) = (YORK / "images").glob(f"{stem}.*")
                found = detect(cv2.imread(str(image), cv2.IMREAD_GRAYSCALE), SHORTEST)
                content = write_npz(LabelledSegments(found))
                archive.writestr(f"{stem}.npz", content)
                (folder / f"{stem}.npz").write_bytes(content)
        answer = client.post(
            "/api/splits/york/submissions",
            files=[("files", ("results.zip", results.getvalue()))],
            data={"method": method},
        )
        assert answer.status_code == 202, answer.text
        with client.stream("GET", f"/api/submissions/{answer.json()['id']}/events") as events:
            last = [line for line in events.iter_lines() if line.startswith("data: ")][-1]
        assert json.loads(last[6:])["status"] == "scored"
        expected[method] = reference(tmp_path / "labels", folder)

    rows = client.get("/api/splits/york/board").json()["rows"]
    shown = {row["method"]["name"]: row["totals"] for row in rows}
    assert set(shown) == set(DETECTORS)
    for method, found in expected.items():
        for metric in ("precision", "recall"):
            assert shown[method][metric]["value"] == pytest.approx(found[metric], rel=0.005), (method, metric)
