"""``clearlines demo``: a small synthetic street dataset, ready to be labelled."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.commands.serve import import_and_prelabel
from app.commands.synthesize import synthesize_folder
from app.settings import Settings

IMAGES = 12
SEED = 7
NAME = "Demo streets"


def prepare_demo(settings: Settings, *, progress: Callable[[int, int], None] | None = None) -> str:
    """Draw the streets, import them without their labels, and queue the run; what is there already stays.

    Returns:
        The dataset's slug.
    """
    streets = settings.data_dir / "streets"
    done = streets / "images.csv"  # written last
    if not done.is_file():
        synthesize_folder(IMAGES, streets, seed=SEED, progress=progress)
    return import_and_prelabel(settings, _images_of(streets), NAME)


def _images_of(streets: Path) -> Path:
    """Return the folder without the labels: in the demo a person makes them."""
    return streets / "images"
