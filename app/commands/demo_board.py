"""The demo's leaderboard: the labels that its streets were drawn by, frozen into a split, with the baselines on it."""

from __future__ import annotations

from collections.abc import Callable

from sqlalchemy import select

from app.clock import utc_now
from app.commands.demo import drawn_streets
from app.commands.exchange import import_images
from app.commands.stores import opened_stores
from app.db.models import Split
from app.services.baselines import add_baselines
from app.services.splits import SplitPlan, create_split
from app.settings import Settings

DATASET = "Demo truth"
SPLIT = "Demo streets"
MIN_LENGTH = 100.0
DESCRIPTION = "Synthetic streets of one camera. The labels are exact: they were drawn, not found."


def prepare_board(settings: Settings, *, progress: Callable[[int, int], None] | None = None) -> str:
    """Import the drawn streets with their labels, freeze those and queue the baselines; what is there already stays.

    Args:
        settings: Say where the database, the blobs and the drawn streets lie.
        progress: Called with the images that the baselines were run on and their total.

    Returns:
        The split's slug.
    """
    dataset = import_images(settings, drawn_streets(settings), DATASET)
    with opened_stores(settings) as (database, blobs):
        with database.write() as session:
            split = session.scalars(select(Split).where(Split.name == SPLIT).limit(1)).one_or_none()
            if split is None:
                plan = SplitPlan(SPLIT, MIN_LENGTH, description=DESCRIPTION)
                split = create_split(session, blobs, dataset.slug, plan, utc_now(), person=settings.person)
            slug = split.slug
        if split.deleted_at is None:
            add_baselines(database, blobs, slug, utc_now(), max_pixels=settings.max_image_pixels, progress=progress)
    return slug
