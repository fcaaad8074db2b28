"""Where the demo keeps its things: apart from everything else."""

from __future__ import annotations

import platformdirs

from app.settings import Settings


def demo_settings(settings: Settings) -> Settings:
    """Return the settings with a data folder of the demo's own, unless one is given."""
    if "data_dir" in settings.model_fields_set:
        return settings
    folder = platformdirs.user_data_path("clearlines", appauthor=False) / "demo"
    return settings.model_copy(update={"data_dir": folder})
