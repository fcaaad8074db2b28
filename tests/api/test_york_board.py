"""Photos with marked lines as a split: the board says what a scorer that knows nothing of this project says."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from numpy.typing import NDArray

from app.formats.inert_npy import read_label_npy
from app.formats.label_npy import write_label_npy
from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz
from app.images.decode import decode_gray
from app.services.baseline_detectors import detect_candidates, detect_lsd
from app.vision.segments import Segments
from benchmarks.shared.plain_official import precision_and_recall

SHARED = Path(__file__).resolve().parents[3] / "shared"
YORK, SCORER = SHARED / "data" / "york", SHARED / "bench" / "score.py"
PHOTOS = 12
MIN_LENGTH = 50.0
LABELS = "_edge_segments_filtered.npy"
DETECTORS: Mapping[str, Callable[[Any, float], Segments]] = {"OpenCV LSD": detect_lsd, "Pipeline": detect_candidates}

pytestmark = pytest.mark.skipif(
    not YORK.is_dir() or not SCORER.is_file(), reason="the photos with marked lines aren't beside the project"
)


@pytest.fixture(scope="module")
def photos() -> dict[str, Path]:
    """The photos by name, every fourth one, so that several scenes are among them."""
    return {path.stem: path for path in sorted((YORK / "images").iterdir())[:: 51 // PHOTOS][:PHOTOS]}


@pytest.fixture(scope="module")
def labels(photos: dict[str, Path]) -> dict[str, Segments]:
    """The marked lines of at least the minimum length: no label is left to be ignored."""
    found = {name: read_label_npy((YORK / "labels" / f"{name}{LABELS}").read_bytes()) for name in photos}
    return {name: segments.select(segments.lengths() >= MIN_LENGTH) for name, segments in found.items()}


@pytest.fixture(scope="module")
def detections(photos: dict[str, Path]) -> dict[str, dict[str, Segments]]:
    """What each detector finds in each photo."""
    grays = {name: decode_gray(path.read_bytes()) for name, path in photos.items()}
    return {
        method: {name: detect(gray, MIN_LENGTH) for name, gray in grays.items()} for method, detect in DETECTORS.items()
    }


@pytest.fixture
def board(
    client: TestClient,
    photos: dict[str, Path],
    labels: dict[str, Segments],
    detections: dict[str, dict[str, Segments]],
) -> dict[str, Any]:
    """The board's rows by method, once both detectors are handed in and scored."""
    dataset: list[tuple[str, tuple[str, bytes]]] = []
    for name, path in photos.items():
        dataset.append(("files", (f"york/images/{path.name}", path.read_bytes())))
        dataset.append(("files", (f"york/labels/{name}{LABELS}", write_label_npy(labels[name]))))
    assert client.post("/api/datasets", json={"name": "york"}).status_code == 201
    report = client.post("/api/datasets/york/images", files=dataset)
    assert report.status_code == 201, report.text
    assert report.json()["labels"] == PHOTOS
    given = {"name": "York", "visibility": "open", "min_length": MIN_LENGTH}
    split = client.post("/api/datasets/york/splits", json=given)
    assert split.status_code == 201, split.text
    assert split.json()["version"]["labels"] == sum(map(len, labels.values()))
    for method, found in detections.items():
        files = [("files", (f"{name}.npz", write_npz(LabelledSegments(each)))) for name, each in found.items()]
        answer = client.post("/api/splits/york/submissions", files=files, data={"method": method})
        assert answer.status_code == 202, answer.text
        with client.stream("GET", f"/api/submissions/{answer.json()['id']}/events") as events:
            states = [json.loads(line[6:]) for line in events.iter_lines() if line.startswith("data: ")]
        assert states[-1]["status"] == "scored", states[-1]
    rows = client.get("/api/splits/york/board").json()["rows"]
    return {row["method"]["name"]: row for row in rows}


def independent_counts(
    folder: Path, labels: Mapping[str, Segments], found: Mapping[str, Segments]
) -> tuple[float, float, float]:
    """F1, precision and recall as the independent program prints them, of files of the same segments."""
    for kind in ("labels", "found"):
        (folder / kind).mkdir(parents=True)
    for name in labels:
        (folder / "labels" / f"{name}{LABELS}").write_bytes(write_label_npy(labels[name]))
        (folder / "found" / f"{name}.npz").write_bytes(write_npz(LabelledSegments(found[name])))
    command = [sys.executable, SCORER, folder / "labels", folder / "found", "--min-length", str(MIN_LENGTH)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=150)
    told = json.loads(done.stdout)
    assert told["images"] == len(labels)
    precision, recall = told["precision"], told["recall"]
    return 2 * precision * recall / (precision + recall), precision, recall


def coordinates(segments: Segments) -> list[list[tuple[float, float]]]:
    return [[(float(x), float(y)) for x, y in line] for line in segments]


def drawn_f1(counts: NDArray[np.float64], draws: NDArray[np.int64]) -> NDArray[np.float64]:
    """F1 of each draw of the images; counts are (I, 3): true positives, false positives, false negatives."""
    tp, fp, fn = np.moveaxis(counts[draws].sum(axis=1), -1, 0)
    return 2 * tp / (2 * tp + fp + fn)


def test_the_board_says_what_the_independent_scorer_says(
    client: TestClient,
    board: dict[str, Any],
    labels: dict[str, Segments],
    detections: dict[str, dict[str, Segments]],
    tmp_path: Path,
) -> None:
    assert set(board) == set(DETECTORS)
    counts = {}
    for method, row in board.items():
        expected = independent_counts(tmp_path / method, labels, detections[method])
        totals = row["totals"]
        shown = [totals[metric]["value"] for metric in ("f1", "precision", "recall")]
        # It counts samples where the definition has lengths: a pair at the threshold may fall on the other side.
        assert shown == pytest.approx(expected, rel=0.005)

        pairs = [precision_and_recall(coordinates(labels[n]), coordinates(detections[method][n])) for n in labels]
        precision, recall = np.mean(pairs, axis=0)
        official = [totals[f"official_{metric}"]["value"] for metric in ("precision", "recall", "f1")]
        assert official == pytest.approx([precision, recall, 2 * precision * recall / (precision + recall)], rel=1e-9)
        assert (row["warning"] is not None) == (recall > 1)

        items = client.get(f"/api/submissions/{row['submission_id']}/images", params={"limit": PHOTOS}).json()["items"]
        assert {item["name"] for item in items} == set(labels)
        by_name = {item["name"]: (item["tp"], item["fp"], item["fn"]) for item in items}
        counts[method] = np.array([by_name[name] for name in labels], np.float64)
        assert totals["tp"]["value"] == counts[method][:, 0].sum()

    # Ranks and intervals, from the counts of the photos and draws of our own.
    draws = np.random.default_rng(5).integers(0, PHOTOS, (4000, PHOTOS))
    drawn = {method: drawn_f1(each, draws) for method, each in counts.items()}
    for method, row in board.items():
        found = row["totals"]["f1"]
        assert [found["low"], found["high"]] == pytest.approx(np.percentile(drawn[method], [2.5, 97.5]), abs=0.01)
    low, high = np.percentile(drawn["Pipeline"] - drawn["OpenCV LSD"], [2.5, 97.5])
    assert low > 0.005 or high < -0.005 or low < -0.005 < 0.005 < high, "too close a call to tell ranks by"
    better, worse = board.values()
    assert better["totals"]["f1"]["value"] > worse["totals"]["f1"]["value"]
    tied = low < 0 < high
    expected_ranks = [(1, 2), (1, 2)] if tied else [(1, 1), (2, 2)]
    assert [(row["rank_low"], row["rank_high"]) for row in (better, worse)] == expected_ranks
    assert better["tied_with"] == ([worse["method"]["slug"]] if tied else [])
    assert worse["tied_with"] == ([better["method"]["slug"]] if tied else [])
