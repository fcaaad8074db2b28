"""``clearlines baseline``: put our own detectors on a split's board."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from sqlalchemy import func, select

from app.clock import utc_now
from app.commands.stores import opened_stores
from app.db.models import ImageScore, Method, Score, Submission
from app.db.session import Database
from app.jobs.dispatcher import Dispatcher
from app.services.baselines import add_baselines
from app.settings import Settings

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class BaselineRow:
    """A baseline on a board."""

    name: str
    label: str
    status: str
    f1: float | None


def queue_baselines(settings: Settings, slug: str, *, progress: Progress | None = None) -> list[int]:
    """Detect in all images of a split, queue what is found to be scored, and return the submissions' ids.

    Args:
        settings: Say where the database and the blobs are.
        slug: Of the split.
        progress: Called with images done and their total.

    Raises:
        NotFound: When there is no such split.
    """
    with opened_stores(settings) as (database, blobs):
        return add_baselines(database, blobs, slug, utc_now(), max_pixels=settings.max_image_pixels, progress=progress)


def score_queued(settings: Settings, ids: list[int], *, progress: Progress | None = None) -> list[BaselineRow]:
    """Wait until submissions are scored, and return their rows.

    Where a server runs on the same data it scores; else this process does.

    Args:
        settings: Say where the database and the blobs are.
        ids: The submissions.
        progress: Called with images scored and their total.
    """
    with opened_stores(settings) as (database, blobs):

        def report() -> None:
            if progress is not None:
                progress(*_scored_images(database, ids))

        Dispatcher(database, blobs, settings, utc_now).run_until_idle(report)
        with database.read() as session:
            rows = session.execute(
                select(Method.name, Submission.label, Submission.status, Score.f1)
                .join(Submission, Submission.method_id == Method.id)
                .outerjoin(Score, Score.submission_id == Submission.id)
                .where(Submission.id.in_(ids))
                .order_by(Submission.id)
            ).all()
        return [BaselineRow(row.name, row.label or "", row.status, row.f1) for row in rows]


def _scored_images(database: Database, ids: list[int]) -> tuple[int, int]:
    with database.read() as session:
        done = select(func.count(ImageScore.id)).join(Score, Score.id == ImageScore.score_id)
        total = session.scalar(select(func.sum(Submission.n_images)).where(Submission.id.in_(ids)))
        return session.scalar(done.where(Score.submission_id.in_(ids))) or 0, int(total or 0)
