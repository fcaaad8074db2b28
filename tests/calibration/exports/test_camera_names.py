"""No name of a camera can break a file or lead out of a folder."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable, Mapping
from typing import Any

import cv2
import numpy as np
import pytest
import yaml
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.io import loadmat

from app.calibration.exports import FORMATS, choose_intrinsics, export_lens
from app.calibration.exports.names import file_stem, one_line
from app.calibration.lens import CameraLens

LENS = CameraLens("brown", 64, 48, (0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
NASTY = (
    'front "left"',
    "O'Brien's",
    "a\\b",
    "line\nbreak\r\n%YAML 1.2\n---",
    "../../etc/passwd",
    "C:\\con",
    "--> ]]> <!-- & <b>",
    "{'x': 1}",
    "# 1 OPENCV 1 1",
    "камера 左",
    "\u2028\u0085\ufeff\ufffe\x00\x1b[31m",
    "\ud800",
    "true",
    "1e5",
    "~",
    "",
    "   ",
    "x" * 10_000,
    '"a" b: "c"',
)


@pytest.mark.parametrize("format_name", list(FORMATS))
def test_a_file_with_a_nasty_name_is_read_like_any_other(
    format_name: str, consumers: Mapping[str, Callable[..., Any]]
) -> None:
    def read(name: str) -> tuple[str, Any]:
        exported = export_lens(LENS, format_name, camera_name=name, intrinsics=choose_intrinsics(LENS))
        return exported.file_name, consumers[format_name](exported, LENS)

    expected = read("plain")[1]
    for name in NASTY:
        file_name, found = read(name)
        np.testing.assert_array_equal(found, expected, err_msg=repr(name))
        assert re.fullmatch(r"[A-Za-z0-9_-]+\.[a-z]+", file_name)
        assert len(file_name) < 100


@given(st.text(max_size=30))
@settings(max_examples=60, deadline=None)
@example("a\x00b")
def test_names_are_one_line_without_quotes_and_a_plain_stem(name: str) -> None:
    line = one_line(name)
    assert line
    assert line.isprintable()
    assert not set(line) & set("\"'`\\\n\r")
    assert one_line(line) == line
    assert re.fullmatch(r"[A-Za-z0-9_]{1,60}", file_stem(name))
    line.encode()


def test_a_name_stays_readable() -> None:
    assert one_line("Fahrzeug 7,\n vorne  (links)") == "Fahrzeug 7, vorne (links)"
    assert file_stem("Fahrzeug 7, vörne (links)") == "Fahrzeug_7_vorne_links"
    assert (one_line("\n"), file_stem("左")) == ("camera", "camera")


@pytest.mark.parametrize("name", ["true", "1e5", "~", "1.5"])
def test_a_name_stays_a_text_where_it_looks_like_a_number(name: str) -> None:
    def content(format_name: str) -> bytes:
        return export_lens(LENS, format_name, camera_name=name, intrinsics=choose_intrinsics(LENS)).content

    for kind in ("opencv-yaml", "opencv-json"):
        storage = cv2.FileStorage(content(kind).decode(), cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)
        assert storage.getNode("camera_name").string() == name
    assert isinstance(yaml.safe_load(content("ros"))["camera_name"], str)
    assert json.loads(content("opencv-json"))["camera_name"] == name
    assert loadmat(io.BytesIO(content("matlab")))["CameraName"].tolist() == [name]
