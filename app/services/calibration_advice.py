"""Where more lines would help a calibration most, and which images to label next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Calibration, Image, Review

MOST_IMAGES = 10
"""Images that are named."""


@dataclass(frozen=True)
class AdviceImage:
    """An image that nobody has labelled.

    Attributes:
        gain: Expected reduction of the predicted error if its candidates were kept, px.
    """

    image_id: int
    name: str
    gain: float


@dataclass(frozen=True)
class Advice:
    """What would help.

    Attributes:
        cells: Places in the frame, best first, as ``app.calibration.advice`` gives them.
        images: Best first.
    """

    cells: list[dict[str, Any]]
    images: list[AdviceImage]


def advice_of(session: Session, row: Calibration) -> Advice:
    """Return the advice of a finished calibration; images that were labelled or deleted since are left out."""
    stored = row.advice or {"cells": [], "images": []}
    gains: dict[int, float] = {entry["image_id"]: entry["gain"] for entry in stored["images"]}
    still_open = (
        select(Image.id, Image.name)
        .join(Review, Review.image_id == Image.id)
        .where(Image.id.in_(gains), Image.deleted_at.is_(None), Image.camera_id == row.camera_id)
        .where(Image.n_keep == 0, Review.status == "open")
    )
    images = [AdviceImage(image_id, name, gains[image_id]) for image_id, name in session.execute(still_open)]
    best = sorted(images, key=lambda image: (-image.gain, image.name))
    return Advice(stored["cells"], best[:MOST_IMAGES])
