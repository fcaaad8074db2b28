"""The one rule that says which segments of an image are current, and the counts that follow from it.

A segment is current while no later run replaced it (``retired_at``), and its run isn't deleted. Of a deleted run
the segments that a person decided on stay current: a decision outlives the run that proposed its segment.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import cache
from typing import Any

from sqlalchemy import (
    BindParameter,
    ColumnElement,
    Select,
    Update,
    and_,
    bindparam,
    case,
    exists,
    func,
    or_,
    select,
    update,
)
from sqlalchemy.orm import Session, aliased
from sqlalchemy.sql.elements import SQLCoreOperations
from sqlalchemy.sql.roles import ColumnsClauseRole

from app.db.models import ORIGINS, Image, Run, RunImage, Segment, SegmentState

LISTED = "listed_image_ids"
COUNTS = ("n_candidates", "n_keep", "n_reject", "n_ambiguous", "lowest_score", "highest_score")


def verdict_of_segment() -> ColumnElement[str]:
    """Return the current verdict as an expression; the query must outer-join ``SegmentState``."""
    return func.coalesce(SegmentState.verdict, "undecided")


def is_current() -> ColumnElement[bool]:
    """Return the rule as a condition on ``Segment``, for any query that has it in its FROM."""
    state = aliased(SegmentState)
    of_deleted_run = (
        exists()
        .where(RunImage.id == Segment.run_image_id, Run.id == RunImage.run_id, Run.deleted_at.is_not(None))
        .correlate(Segment)
    )
    decided = exists().where(state.segment_id == Segment.id, state.verdict != "undecided").correlate(Segment)
    return and_(Segment.retired_at.is_(None), or_(~of_deleted_run, decided))


def current_segments(*columns: ColumnsClauseRole | SQLCoreOperations[Any] | type[Any]) -> Select[*tuple[Any, ...]]:
    """Select from the current segments of all images, each joined to its state, in their stable order.

    Args:
        columns: What to select; ``Segment`` and ``verdict_of_segment()`` when left out.
    """
    chosen = columns or (Segment, verdict_of_segment())
    origin = case({name: rank for rank, name in enumerate(ORIGINS)}, value=Segment.origin)
    return (
        select(*chosen)
        .select_from(Segment)
        .outerjoin(SegmentState, SegmentState.segment_id == Segment.id)
        .where(is_current())
        .order_by(Segment.image_id, origin, Segment.ordinal, Segment.id)
    )


def refresh_counts(session: Session, image_ids: Collection[int] | Select[int]) -> None:
    """Write the counts of current segments, and between which scores they are, into the images' rows.

    To be called in the transaction of each change: a run's result, a decision, an import, a run deleted or restored.

    Args:
        session: A writing session.
        image_ids: The images, or a query that selects their ids.
    """
    session.flush()
    if isinstance(image_ids, Select):
        session.execute(_update_of_counts(image_ids))
    else:
        session.execute(_update_of_listed(), {LISTED: list(image_ids)})
    for image in [entry for entry in session.identity_map.values() if isinstance(entry, Image)]:
        session.expire(image, COUNTS)


@cache
def _update_of_listed() -> Update:
    """Return the statement for ids that are given when it is executed; to build it takes longer than to execute it."""
    return _update_of_counts(bindparam(LISTED, expanding=True))


def _update_of_counts(image_ids: Select[int] | BindParameter[Any]) -> Update:
    verdict = verdict_of_segment()
    counts = (
        select(
            Segment.image_id,
            func.count().label("candidates"),
            *(func.count(case((verdict == name, 1))).label(name) for name in ("keep", "reject", "ambiguous")),
            func.min(Segment.score).label("lowest"),
            func.max(Segment.score).label("highest"),
        )
        .outerjoin(SegmentState, SegmentState.segment_id == Segment.id)
        .where(Segment.image_id.in_(image_ids), is_current())
        .group_by(Segment.image_id)
        .subquery()
    )
    of_each_image = (
        select(
            Image.id,
            *(func.coalesce(column, 0).label(column.name) for column in list(counts.c)[1:5]),
            counts.c.lowest,
            counts.c.highest,
        )
        .outerjoin(counts, counts.c.image_id == Image.id)
        .where(Image.id.in_(image_ids))
        .subquery()
    )
    return (
        update(Image)
        .values(
            n_candidates=of_each_image.c.candidates,
            n_keep=of_each_image.c.keep,
            n_reject=of_each_image.c.reject,
            n_ambiguous=of_each_image.c.ambiguous,
            lowest_score=of_each_image.c.lowest,
            highest_score=of_each_image.c.highest,
        )
        .where(Image.id == of_each_image.c.id)
        .execution_options(synchronize_session=False)
    )
