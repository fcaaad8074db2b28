"""Street scenes with exact truth: images through a known lens, and the visible straight edges as labels."""

from __future__ import annotations

from app.synthesis.camera import SyntheticCamera
from app.synthesis.drives import Drive, drive_scenes, plan_drives, synthesize_dataset
from app.synthesis.lens import Lens, draw_lens, make_lens
from app.synthesis.scene import SyntheticScene, synthesize_scene
from app.synthesis.sensor import IDEAL_SENSOR, Sensor

__all__ = [
    "IDEAL_SENSOR",
    "Drive",
    "Lens",
    "Sensor",
    "SyntheticCamera",
    "SyntheticScene",
    "draw_lens",
    "drive_scenes",
    "make_lens",
    "plan_drives",
    "synthesize_dataset",
    "synthesize_scene",
]
