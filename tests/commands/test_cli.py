"""The command line as a whole: the commands of the documentation exist, and errors are told in a line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

COMMANDS = ("demo", "serve", "prelabel", "evaluate", "synthesize", "import", "export")


def test_help_names_every_command(clearlines: Any) -> None:
    text = clearlines("--help").stdout
    assert all(command in text for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(clearlines: Any, command: str) -> None:
    assert "Usage:" in clearlines(command, "--help").stdout


def test_the_version_is_the_package_s(clearlines: Any) -> None:
    from importlib.metadata import version

    assert clearlines("--version").stdout.strip() == version("clearlines")


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.4", "::", "example.org"])
def test_serving_an_address_that_others_reach_is_refused(clearlines: Any, host: str) -> None:
    done = clearlines("serve", "--host", host, "--no-browser", status=2)
    assert "no accounts" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_synthetic_dataset_goes_in_and_comes_out_unchanged(clearlines: Any, tmp_path: Path) -> None:
    clearlines("synthesize", "--count", 1, "--output", "streets", "--seed", 3)
    streets, out = tmp_path / "streets", tmp_path / "out"
    labels = sorted(path.relative_to(streets) for path in (streets / "labels").rglob("*.npy"))
    assert len(labels) == 1
    done = clearlines("import", "streets", "--dataset", "Synthetic streets")
    assert "1 images added" in done.stderr
    again = clearlines("import", "streets", "--dataset", "Synthetic streets")
    assert "1 were there already" in again.stderr
    clearlines("export", "synthetic-streets", "--output", "out")
    for name in labels:
        before, after = (np.load(root / name, allow_pickle=True) for root in (streets, out))
        assert len(before) == len(after) > 20
        for one, other in zip(before, after, strict=True):
            np.testing.assert_array_equal(one, other)
    images = [path.relative_to(streets) for path in (streets / "images").rglob("*.png")]
    assert all((streets / name).read_bytes() == (out / name).read_bytes() for name in images)
    cameras = [json.loads((root / "cameras.json").read_text()) for root in (streets, out)]
    assert cameras[0] == cameras[1]
    assert (streets / "images.csv").read_text() == (out / "images.csv").read_text()


def test_the_labels_against_themselves_are_perfect(clearlines: Any, tmp_path: Path) -> None:
    clearlines("synthesize", "--count", 1, "--output", "streets", "--seed", 5)
    clearlines(
        "evaluate", "--ground-truth", "streets/labels", "--predictions", "streets/labels", "--images", "streets/images"
    )
    assert json.loads((tmp_path / "evaluation/summary.json").read_text())["recall"] >= 1.0
    assert len(list((tmp_path / "evaluation/visualization").rglob("*.png"))) == 1
    lines = (tmp_path / "evaluation/summary.txt").read_text().splitlines()
    assert lines[0] == "Results for Intersection over Union (IoU) of: 0.5"


def test_an_export_of_a_dataset_that_is_not_there_is_told(clearlines: Any) -> None:
    done = clearlines("export", "nothing", "--output", "out", status=2)
    assert "error:" in done.stderr
