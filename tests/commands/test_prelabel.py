"""``clearlines prelabel``: files in, files out, and going on after an interruption."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.commands import prelabel as command
from app.commands.detection_cache import DetectionCache
from app.commands.prelabel import PrelabelChoice, prelabel_files
from app.errors import InvalidInput, NotFound
from app.formats.inert_npy import read_label_npy
from app.formats.json_segments import read_json
from app.formats.npz import read_npz
from app.vision import DetectionParameters, Segments

CHOICE = PrelabelChoice(DetectionParameters(min_length=60))


def test_the_command_writes_a_file_per_image_and_a_report(clearlines: Any, street: Path, tmp_path: Path) -> None:
    clearlines("prelabel", street, "--output", "out", "--min-length", 60, "--workers", 1)
    out = tmp_path / "out"
    assert sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()) == [
        "a/one.npz",
        "a/two.npz",
        "prelabel.json",
    ]
    report = json.loads((out / "prelabel.json").read_text())
    assert [image["name"] for image in report["images"]] == ["a/one", "a/two"]
    assert report["cameras"][0]["images"] == ["a/one", "a/two"]
    distortion = report["cameras"][0]["distortion"]
    assert (distortion["model"], distortion["width"], distortion["height"]) == ("brown", 320, 240)
    assert distortion["accepted"] is False or distortion["reasons"] == []
    for image in report["images"]:
        with np.load(out / image["file"], allow_pickle=False) as arrays:
            assert arrays["points"].dtype == np.float32
            assert arrays["offsets"].dtype == np.int64
            count = len(arrays["offsets"]) - 1
            assert count == image["candidates"] >= 4
            assert arrays["scores"].shape == arrays["straightness"].shape == (count,)
            segments = Segments(arrays["points"], arrays["offsets"])
        assert segments.extents().min() >= 60


def test_all_formats_hold_the_same_points(street: Path, tmp_path: Path) -> None:
    read: dict[str, Segments] = {}
    readers = {"npz": read_npz, "json": read_json}
    for name in ("npz", "json", "npy"):
        choice = PrelabelChoice(CHOICE.parameters, format=name)
        prelabel_files([street], tmp_path / name, choice)
        suffix, _ = command.WRITERS[name]
        data = (tmp_path / name / f"a/one{suffix}").read_bytes()
        read[name] = readers[name](data).segments if name in readers else read_label_npy(data)
    np.testing.assert_array_equal(read["npz"].points, read["npy"].points)
    np.testing.assert_array_equal(read["npz"].offsets, read["json"].offsets)
    np.testing.assert_allclose(read["npz"].points, read["json"].points, atol=1e-4)


def test_a_broken_image_fails_alone_and_the_command_says_so(clearlines: Any, street: Path, tmp_path: Path) -> None:
    whole = (street / "a" / "one.png").read_bytes()
    (street / "a" / "cut.png").write_bytes(whole[: len(whole) // 2])
    (street / "a" / "text.png").write_bytes(b"hello")
    done = clearlines("prelabel", street, "--output", "out", "--min-length", 60, "--workers", 1, status=1)
    assert "a/cut" in done.stderr
    assert "a/text" in done.stderr
    images = {image["name"]: image for image in json.loads((tmp_path / "out/prelabel.json").read_text())["images"]}
    assert images["a/cut"]["error"]["code"] == "invalid-image"
    assert images["a/one"]["candidates"] >= 4


def test_the_same_call_after_an_interruption_goes_on_where_it_was(
    street: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"

    def interrupt(done: int, total: int) -> None:
        if done < total:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        prelabel_files([street], out, CHOICE, progress=interrupt)
    assert not (out / "prelabel.json").exists()
    worked: list[str] = []
    through = command.map_in_processes

    def counting(task: Any, items: Any, workers: int) -> Any:
        items = list(items)
        worked.extend(item.image.name for item in items)
        return through(task, items, workers)

    monkeypatch.setattr(command, "map_in_processes", counting)
    report = prelabel_files([street], out, CHOICE)
    assert len(worked) == 1
    assert report.images == ("a/one", "a/two")
    assert not (out / ".prelabel").exists()


def test_a_file_name_that_is_no_text_fails_alone(clearlines: Any, street: Path, tmp_path: Path) -> None:
    odd = os.fsencode(street) + b"/odd\xff.png"
    try:
        (street / "a" / "one.png").rename(os.fsdecode(odd))
    except OSError:
        pytest.skip("this file system takes UTF-8 alone")
    done = clearlines("prelabel", street, "--output", "out", "--min-length", 60, "--workers", 1, status=1)
    assert "failed: odd\\udcff" in done.stderr
    entries = json.loads((tmp_path / "out" / "prelabel.json").read_text())["images"]
    assert [(entry["name"], "error" in entry) for entry in entries] == [("a/two", False), ("odd\\udcff", True)]


def test_other_parameters_and_other_images_are_other_detections(tmp_path: Path) -> None:
    keys = {
        DetectionCache(tmp_path, DetectionParameters(min_length=length).as_dict()).key(content)
        for length in (20, 190)
        for content in (b"one", b"two")
    }
    assert len(keys) == 4


def test_per_image_cameras_have_a_lens_each(street: Path, tmp_path: Path) -> None:
    choice = PrelabelChoice(CHOICE.parameters, camera="per-image")
    report = prelabel_files([street], tmp_path / "out", choice)
    assert [camera["images"] for camera in report.cameras] == [["a/one"], ["a/two"]]


def test_paths_that_can_not_be_are_told(clearlines: Any, street: Path, tmp_path: Path) -> None:
    with pytest.raises(NotFound, match="no such file"):
        prelabel_files([tmp_path / "nowhere"], tmp_path / "out", CHOICE)
    with pytest.raises(InvalidInput, match="two images are called one"):
        prelabel_files([street / "a", street / "a" / "one.png"], tmp_path / "out", CHOICE)
    done = clearlines("prelabel", "nowhere", "--output", "out", status=2)
    assert "error:" in done.stderr
    assert "Traceback" not in done.stderr
    wrong = clearlines("prelabel", street, "--output", "out", "--operating-point", "best", status=2)
    assert "recall, balanced, precise" in wrong.stderr
