"""``clearlines demo``: a small synthetic street dataset, ready to be labelled."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from app.commands.serve import import_and_prelabel
from app.commands.synthesize import synthesize_folder
from app.settings import Settings

IMAGES = 12
SEED = 7
NAME = "Demo streets"


def drawn_streets(settings: Settings) -> Path:
    """Return the folder of the demo's images and labels, in the layout of a dataset."""
    return settings.data_dir / "streets"


def prepare_demo(settings: Settings, *, progress: Callable[[int, int], None] | None = None) -> str:
    """Draw the streets, import them without their labels, and queue the run; what is there already stays.

    Returns:
        The dataset's slug.
    """
    streets = drawn_streets(settings)
    images = streets / "images"
    table = images / "images.csv"  # last, so that a drawing that was stopped begins anew
    if not table.is_file():
        synthesize_folder(IMAGES, streets, seed=SEED, progress=progress)
        shutil.copy(streets / "images.csv", table)
    return import_and_prelabel(settings, images, NAME)
