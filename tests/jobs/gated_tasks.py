"""Tasks that misbehave in a worker process, by the name of the image they are given."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import Any

from app.jobs.tasks import DetectionResult, ImageHistory, detect_task, history_task


def gated_detect(content: bytes, name: str, parameters: dict[str, Any], **options: Any) -> DetectionResult:
    """Images named ``held...`` say which process works on them and wait until the gate is open, or opened for them."""
    gate = Path(os.environ["TEST_GATE"])
    if name.startswith("held"):
        (gate / f"{name}.pid").write_text(str(os.getpid()))
        deadline = time.monotonic() + 90
        ways = (gate / "open", gate / f"{name}.open")
        while not any(way.exists() for way in ways) and time.monotonic() < deadline:
            time.sleep(0.01)
    return detect_task(content, name, parameters, **options)


def deadly_detect(content: bytes, name: str, parameters: dict[str, Any], **options: Any) -> DetectionResult:
    """Images named ``deadly...`` kill the process that works on them, as a lack of memory would."""
    if name.startswith("deadly"):
        os.kill(os.getpid(), signal.SIGKILL)
    return detect_task(content, name, parameters, **options)


LEFT_BEHIND: list[bytes] = []


def told_detect(content: bytes, name: str, parameters: dict[str, Any], **options: Any) -> DetectionResult:
    """Say which process works on the image, and leave 300 MB behind."""
    (Path(os.environ["TEST_GATE"]) / f"{name}.pid").write_text(str(os.getpid()))
    LEFT_BEHIND.append(b"x" * 300 * 2**20)
    return detect_task(content, name, parameters, **options)


def deadly_history(content: bytes, name: str, parameters: dict[str, Any], **options: Any) -> ImageHistory:
    """Dies of images named ``deadly...`` as ``deadly_detect`` does."""
    if name.startswith("deadly"):
        os.kill(os.getpid(), signal.SIGKILL)
    return history_task(content, name, parameters, **options)
