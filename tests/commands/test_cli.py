"""The command line as a whole: the commands of the documentation exist, and errors are told in a line."""

from __future__ import annotations

import json
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest

COMMANDS = (
    *("demo", "serve", "prelabel", "evaluate", "calibrate", "synthesize", "import", "export"),
    *("submit", "baseline", "card", "token", "user"),
    *("migrate", "backup", "restore"),
)


def test_help_names_every_command(clearlines: Any) -> None:
    text = clearlines("--help").stdout
    assert all(command in text for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(clearlines: Any, command: str) -> None:
    assert "Usage:" in clearlines(command, "--help").stdout


def test_the_version_is_the_package_s(start: Any) -> None:
    assert start("--version").communicate() == (f"{version('clearlines')}\n", "")


SLOW = ("numpy", "cv2", "scipy", "sqlalchemy", "fastapi", "alembic")


MISTAKES = (
    ["serve", "--public-url", "lines.example.org"],
    ["serve", "nowhere"],
    ["prelabel", "nowhere", "--output", "out"],
    ["prelabel", ".", "--output", "out", "--format", "xml"],
    ["prelabel", ".", "--output", "a_file/below"],
    ["evaluate", "--ground-truth", "nowhere", "--predictions", "."],
    ["calibrate", "nowhere"],
    ["calibrate", ".", "--family", "fisheye"],
    ["calibrate", ".", "--size", "640"],
    ["import", "nowhere", "--dataset", "x"],
    ["export", "x", "--output", "a_file"],
    ["restore", "nowhere"],
)


def test_a_mistake_is_told_before_anything_slow_is_imported(tmp_path: Path) -> None:
    (tmp_path / "a_file").write_text("")
    program = f"""
import sys
from app.cli import main
for arguments in {MISTAKES}:
    sys.argv = ["clearlines", *arguments]
    try:
        main()
    except SystemExit as end:
        print(end.code, *(name for name in {SLOW} if name in sys.modules))
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.stdout.splitlines() == ["2"] * len(MISTAKES)
    assert done.stderr.count("error: ") == len(MISTAKES)
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["import", ".", "--dataset", "a\udcff"], "no image"),
        (["import", "street", "--dataset", "a\udcff"], "control characters"),
        (["import", "street", "--dataset", " "], "needs a name"),
        (["import", "street/a/one.png", "--dataset", "x"], "no such folder"),
        (["import", "street", "--dataset", "x", "--data", "street/a/one.png"], "a file is where a folder"),
        (["export", "a\udcff", "--output", "out"], "there is no dataset"),
        (["synthesize", "--count", "1", "--output", "street/a/one.png"], "a file is where a folder"),
    ],
)
def test_what_can_not_be_is_told_in_a_line(clearlines: Any, street: Path, arguments: list[str], message: str) -> None:
    if arguments[1] == ".":
        shutil.rmtree(street)
    said = clearlines(*arguments, status=2).stderr
    assert said.startswith("error: ")
    assert message in said


@pytest.mark.parametrize(
    ("name", "value"), [("WORKERS", "0"), ("PORT", "abc"), ("DATABASE_URL", "mysql://x"), ("DATABASE_URL", "nonsense")]
)
def test_a_setting_that_can_not_be_is_named(clearlines: Any, monkeypatch: Any, name: str, value: str) -> None:
    monkeypatch.setenv(f"CLEARLINES_{name}", value)
    assert name.lower() in clearlines("export", "x", "--output", "out", status=2).stderr


def test_a_database_that_is_none_and_one_of_a_newer_version_are_told(
    clearlines: Any, street: Path, tmp_path: Path
) -> None:
    clearlines("import", street, "--dataset", "x")
    with closing(sqlite3.connect(tmp_path / "data" / "clearlines.sqlite3")) as connection, connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")
    assert "newer version" in clearlines("import", street, "--dataset", "x", status=2).stderr
    shutil.rmtree(tmp_path / "data")
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "clearlines.sqlite3").write_bytes(b"no database at all" * 100)
    assert "no SQLite database" in clearlines("import", street, "--dataset", "x", status=2).stderr


def test_a_name_with_brackets_is_no_markup(clearlines: Any, tmp_path: Path) -> None:
    said = clearlines("prelabel", tmp_path / "[red]none[/]", "--output", "out", status=2).stderr
    assert "[red]none[/]" in said


def test_a_synthetic_dataset_goes_in_and_comes_out_unchanged(clearlines: Any, tmp_path: Path) -> None:
    clearlines("synthesize", "--count", 1, "--output", "streets", "--seed", 3)
    streets, out = tmp_path / "streets", tmp_path / "out"
    labels = sorted(path.relative_to(streets) for path in (streets / "labels").rglob("*_filtered.npy"))
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
