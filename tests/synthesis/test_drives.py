from __future__ import annotations

import json

import numpy as np
import pytest

from app.errors import InvalidFile
from app.synthesis import SyntheticScene, plan_drives
from app.synthesis.drives import STREETS_PER_CAMERA
from app.synthesis.line_file import read_lines, write_lines


def test_cameras_change_after_some_streets_and_not_with_the_count() -> None:
    drives = plan_drives(9 * STREETS_PER_CAMERA, 4, sequence_length=3)
    assert [drive.camera for drive in drives] == sorted(list(range(3)) * STREETS_PER_CAMERA)
    assert sum(drive.count for drive in drives) == 9 * STREETS_PER_CAMERA
    lenses = [drives[camera * STREETS_PER_CAMERA].lens for camera in range(3)]
    assert len({float(lens.matrix[0, 0]) for lens in lenses}) == 3
    assert lenses[0].coefficients[0] < -0.2 < lenses[1].coefficients[0]  # wide, then plain
    fewer = plan_drives(4, 4, sequence_length=3)
    assert [(drive.first, drive.count) for drive in fewer] == [(0, 3), (3, 1)]
    assert np.array_equal(fewer[0].lens.matrix, lenses[0].matrix)


def test_a_line_file_names_every_line(scene: SyntheticScene) -> None:
    content = read_lines(write_lines(scene))
    assert [each["line"] for each in content["labels"]] == scene.line_ids.tolist()
    assert [each["kind"] for each in content["ambiguous"]] == list(scene.ambiguous_kinds)
    assert [each["reason"] for each in content["distractors"]] == list(scene.reasons)
    points = np.array(content["distractors"][0]["points"])
    assert np.abs(points - scene.distractors[0]).max() < 0.006


@pytest.mark.parametrize("data", [b"", b"[]", json.dumps({"version": 2}).encode()])
def test_what_is_no_line_file_is_refused(data: bytes) -> None:
    with pytest.raises(InvalidFile):
        read_lines(data, where="street.json")
