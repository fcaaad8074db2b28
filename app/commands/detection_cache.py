"""Detections that are finished, on disk until all are: a pre-labelling that was stopped goes on where it was."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.commands.whole_files import json_bytes, write_whole
from app.errors import ClearLinesError
from app.formats.labelled import LabelledSegments
from app.formats.npz import read_npz, write_npz
from app.jobs.tasks import DetectionResult
from app.vision.code_version import code_version
from app.vision.segments import Segments

FOLDER = ".prelabel"


@dataclass(frozen=True)
class DetectionCache:
    """Finished detections under a folder.

    Attributes:
        folder: Where they are.
        parameters: Of the detection; other parameters are other detections.
    """

    folder: Path
    parameters: Mapping[str, Any]

    def key(self, content: bytes) -> str:
        """Return the name under which the detection of an image file's bytes is kept."""
        settings = json.dumps([code_version(), dict(self.parameters)], sort_keys=True).encode()
        return hashlib.sha256(hashlib.sha256(settings).digest() + hashlib.sha256(content).digest()).hexdigest()

    def put(self, key: str, result: DetectionResult) -> None:
        """Keep a detection; its last file makes it count."""
        write_whole(self.folder / f"{key}.candidates.npz", write_npz(LabelledSegments(result.candidates)))
        write_whole(self.folder / f"{key}.lens.npz", result.lens_segments or b"")
        write_whole(self.folder / f"{key}.json", json_bytes({"milliseconds": result.milliseconds}))

    def milliseconds(self, key: str) -> float | None:
        """Return how long the detection took; ``None`` where it isn't finished."""
        try:
            return float(json.loads((self.folder / f"{key}.json").read_bytes())["milliseconds"])
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def candidates(self, key: str) -> Segments:
        """Return the candidates of a finished detection."""
        return read_npz((self.folder / f"{key}.candidates.npz").read_bytes()).segments

    def lens_segments(self, key: str) -> bytes:
        """Return what the lens is estimated from, npz bytes."""
        return (self.folder / f"{key}.lens.npz").read_bytes()

    def is_whole(self, key: str) -> bool:
        """Whether a detection is finished and can be read."""
        if self.milliseconds(key) is None:
            return False
        try:
            self.candidates(key)
            read_npz(self.lens_segments(key))
        except (OSError, ClearLinesError):
            return False
        return True

    def clear(self) -> None:
        """Remove everything."""
        shutil.rmtree(self.folder, ignore_errors=True)
