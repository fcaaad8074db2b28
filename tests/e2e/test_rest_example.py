"""The example of the documentation, run as it stands there."""

from __future__ import annotations

import io
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import cv2
import numpy as np

EXAMPLE = Path(__file__).resolve().parent.parent.parent / "docs" / "examples" / "rest_road.py"


def test_the_example_takes_the_whole_road(server: Any, tmp_path: Path) -> None:
    image = np.full((240, 320), 60, np.uint8)
    for x in (40, 150, 250):
        cv2.rectangle(image, (x, 20), (x + 40, 220), 200, -1, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "bars.png"), image)
    arguments = [server.address, tmp_path / "bars.png", "--output", tmp_path / "labels.zip"]
    done = subprocess.run([sys.executable, EXAMPLE, *arguments], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(tmp_path / "labels.zip") as archive:
        content = archive.read("labels/bars_edge_segments_filtered.npy")
    labels = np.load(io.BytesIO(content), allow_pickle=True)
    assert len(labels) >= 4
    assert f"{len(labels)} lines of 1 images" in done.stdout
