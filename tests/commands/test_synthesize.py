"""What ``clearlines synthesize`` writes."""

from __future__ import annotations

import json
from pathlib import Path

from app.commands.synthesize import CARD, synthesize_folder
from app.formats.dataset import read_dataset
from app.formats.inert_npy import read_label_npy

SIZE = (96, 72)


def test_several_processes_write_what_one_writes(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    paths = synthesize_folder(
        5, tmp_path / "many", seed=2, size=SIZE, processes=2, progress=lambda *done: told.append(done)
    )
    synthesize_folder(5, tmp_path / "one", seed=2, size=SIZE, processes=1)
    assert told == [(done, 5) for done in range(1, 6)]
    for path in paths:
        assert path.read_bytes() == (tmp_path / "one" / path.relative_to(tmp_path / "many")).read_bytes()


def test_a_dataset_comes_with_its_lines_and_a_card(tmp_path: Path) -> None:
    synthesize_folder(2, tmp_path, seed=1, size=(320, 240))
    dataset = read_dataset(tmp_path)
    assert [image.name for image in dataset.images] == ["street-00/000000", "street-00/000001"]
    assert not dataset.extra_labels
    total = 0
    for image in dataset.images:
        lines = json.loads((tmp_path / "lines" / f"{image.name}.json").read_text())
        assert image.labels is not None
        labels = read_label_npy((tmp_path / image.labels).read_bytes())
        assert len(labels) == len(lines["labels"]) > 10
        total += len(labels)
    card = (tmp_path / CARD).read_text()
    assert f"{total} labels" in card
    assert "--count 2 --seed 1" in card
    assert f"| synthetic | 2 | {dataset.cameras['synthetic'].matrix[0][0]:.1f} |" in card
