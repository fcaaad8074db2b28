"""``clearlines card``."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2

Run = Callable[..., Any]


def test_a_card_is_told_and_written(clearlines: Run, street: Path, tmp_path: Path) -> None:
    (tmp_path / "set").mkdir()
    street.rename(tmp_path / "set" / "images")
    labels = tmp_path / "set" / "labels" / "a"
    labels.mkdir(parents=True)
    keep, reject = (
        {"points": [[10, y], [200, y]], "verdict": verdict} for y, verdict in ((20, "keep"), (90, "reject"))
    )
    (labels / "one.json").write_text(json.dumps({"segments": [keep, reject]}))
    clearlines("import", tmp_path / "set", "--dataset", "Street")
    told = clearlines("card", "street", "--output", tmp_path / "card").stdout
    assert "Street: 2 images, 1 done, 1 labels" in told
    assert told.splitlines()[-2].split() == ["a", "1", "0.50", "1.00", "0.67", "0.67"]
    card = json.loads((tmp_path / "card" / "card.json").read_text())
    assert card["table_one"][0]["precision"] == 0.5
    assert card["sources"][0]["sizes"] == ["320 x 240"]
    picture = cv2.imread(str(tmp_path / "card" / card["figure"]))
    assert picture is not None
    assert picture.shape[1] > 3 * 320
    assert "2 images" in clearlines("card", "street").stdout


def test_the_pipeline_is_run_where_it_hasn_t_been(clearlines: Run, tmp_path: Path) -> None:
    clearlines("synthesize", "--count", 1, "--seed", 3, "--output", tmp_path / "set")
    clearlines("import", tmp_path / "set", "--dataset", "Street")
    assert "No candidates to compare" in clearlines("card", "street").stdout
    source, images, precision, recall, *_ = (
        clearlines("card", "street", "--detect", "--min-length", 100).stdout.splitlines()[-1].split()
    )
    assert (source, images) == ("synthetic", "1")
    assert float(precision) > 0.4
    assert float(recall) > 0.7


def test_a_dataset_that_isn_t_there(clearlines: Run) -> None:
    assert "there is no dataset nowhere" in clearlines("card", "nowhere", status=2).stderr
