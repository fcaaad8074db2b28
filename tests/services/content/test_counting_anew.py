"""What an upgrade counts of rows that are there is what services and triggers have kept of them all along."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

from alembic import command
from sqlalchemy import select

from app.db.migrations import configuration, run_upgrade
from app.db.models import Image, Segment
from app.services import assigning, reviews, runs
from app.services.candidates import refresh_counts
from tests.services.content.test_tallies import require_exact

KEPT = ("review_status", "prelabel", "n_candidates", "lowest_score", "highest_score")


def kept(place) -> list[tuple[Any, ...]]:
    with place.database.read() as session:
        images = session.scalars(select(Image).order_by(Image.id)).all()
        return [tuple(getattr(image, name) for name in KEPT) for image in images]


def count_anew(place) -> None:
    """Take the counts away, and let the upgrade make them from the rows."""
    options = {"sqlite_begin": "IMMEDIATE", "sqlite_foreign_keys": "OFF"}
    config = configuration()
    with place.database.engine.execution_options(**options).begin() as connection:
        config.attributes["connection"] = connection
        command.downgrade(config, "0005")
    run_upgrade(place.database.engine)


def test_candidates_that_are_out_of_sight_have_no_score(sqlite_place) -> None:
    place = sqlite_place
    slug = place.dataset()
    labelled, detected, other = place.images(slug, "a", "b", "c")
    place.label(labelled, ["keep", "undecided"])
    gone = place.run([labelled, detected], candidates=3)
    place.run([other], candidates=2)
    with place.database.write() as session:
        for segment in session.scalars(select(Segment)):
            segment.score = segment.id / 100
        refresh_counts(session, [labelled, detected, other])
        reviews.set_review(session, other, "discarded", now=place.now)
        assigning.assign(session, place.find(session, slug), ["Ada"], "shares", None, place.now)
        runs.delete_run(session, gone, place.now, grace=timedelta(days=7))
    before = kept(place)
    assert before == [
        ("open", "none", 2, 0.01, 0.02),
        ("open", "none", 0, None, None),
        ("discarded", "done", 2, 0.09, 0.1),
    ]
    count_anew(place)
    assert kept(place) == before
    require_exact(place)
