"""clearlines-v2 against a scorer that was written independently of it."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from app.evaluation import ground_truth, protocol_named, total
from app.vision.segments import Segments
from benchmarks.shared.detectors import opencv_lsd
from benchmarks.shared.reference_scorer import load_reference_scorer, reference_counts
from benchmarks.shared.reporting import DATA
from benchmarks.shared.york import Photo, read_photos

PHOTOS = 8
YORK = DATA / "york"


@pytest.fixture(scope="module")
def photos() -> list[Photo]:
    if not YORK.is_dir():
        pytest.skip("the York Urban photos aren't there")
    return read_photos(YORK)[::6][:PHOTOS]


def test_counts_and_lengths_agree_with_the_reference_without_ignored_labels(photos: list[Photo]) -> None:
    reference = load_reference_scorer()
    if reference is None:
        pytest.skip("the reference scorer isn't there")
    cv2.setNumThreads(1)
    lsd = opencv_lsd()
    found = [segments.select(segments.lengths() >= 50) for segments in (lsd(photo.gray) for photo in photos)]
    labels = [photo.labels for photo in photos]

    protocol = protocol_named("clearlines-v2")
    scores = [
        protocol.score_image(ground_truth(truth), predictions) for truth, predictions in zip(labels, found, strict=True)
    ]
    ours = {name: value.item() for name, value in _totals(scores).items() if not value.ndim}
    theirs = reference_counts(reference, labels, found)

    precision = theirs["tp"] / (theirs["tp"] + theirs["fp"])
    recall = theirs["tp"] / (theirs["tp"] + theirs["fn"])
    assert 0.1 < precision < 0.9
    assert ours["precision"] == pytest.approx(precision, rel=0.005)
    assert ours["recall"] == pytest.approx(recall, rel=0.005)
    assert ours["f1"] == pytest.approx(2 * precision * recall / (precision + recall), rel=0.005)
    assert ours["tp"] + ours["fn"] == sum(map(len, labels))
    assert ours["completeness"] == pytest.approx(theirs["covered"] / theirs["labelled"], rel=0.005)


def test_the_labels_against_themselves_are_perfect(york_lines: dict[str, list[np.ndarray]]) -> None:
    protocol = protocol_named("clearlines-v2")
    labels = [Segments.from_list(lines) for lines in list(york_lines.values())[:3]]
    ours = _totals([protocol.score_image(ground_truth(truth), truth) for truth in labels])
    for name in ("f1", "precision", "recall", "mean_f1", "mean_liou"):
        assert ours[name] == pytest.approx(1), name
    assert ours["offset_p95"] < 0.011


def _totals(scores) -> dict[str, np.ndarray]:
    return total(protocol_named("clearlines-v2"), np.stack([score.tallies for score in scores]))
