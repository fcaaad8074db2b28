"""The model before any decision exists: trained on synthetic scenes alone, it lies beside the code as JSON."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

from app.errors import BrokenInstallation, InvalidInput
from app.review.suggestion_model import SuggestionModel

PRIOR_FILE = Path(__file__).with_name("prior.json")


@cache
def prior_model() -> SuggestionModel:
    """Return the prior.

    Raises:
        BrokenInstallation: If its file is missing or of other features.
    """
    try:
        return SuggestionModel.from_dict(json.loads(PRIOR_FILE.read_text()))
    except (OSError, ValueError, InvalidInput) as error:
        raise BrokenInstallation(
            "the model that suggests before anything was learnt is missing or out of date",
            where=PRIOR_FILE.name,
            hint="install ClearLines again; in a source tree run python tools/train_prior.py",
        ) from error
