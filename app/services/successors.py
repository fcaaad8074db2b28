"""Which segment stands for one that runs replaced: the last of its chain of replacements."""

from __future__ import annotations

from collections.abc import Mapping

from sqlalchemy import ColumnElement, Select, Subquery, case, select
from sqlalchemy.orm import Session, aliased

from app.db.models import Segment


def successors_of(session: Session, segments: Mapping[int, Segment]) -> dict[int, Segment]:
    """Return the last segment of each chain of replacements, for the segments that were replaced."""
    last = {key: segment for key, segment in segments.items() if segment.retired_at and segment.replaced_by_id}
    open_ends = dict(last)
    while open_ends:
        wanted = {segment.replaced_by_id for segment in open_ends.values()}
        found = {row.id: row for row in session.scalars(select(Segment).where(Segment.id.in_(wanted)))}
        open_ends = {
            key: found[segment.replaced_by_id] for key, segment in open_ends.items() if segment.replaced_by_id in found
        }
        last.update(open_ends)
        open_ends = {key: row for key, row in open_ends.items() if row.retired_at and row.replaced_by_id}
    return {key: segment for key, segment in last.items() if segment.id != key}


def last_of_each(segment_ids: Select[int], name: str) -> Subquery:
    """Return segments with the one that stands for each: columns ``segment_id`` and ``last_id``, the same one if none.

    Args:
        segment_ids: Selects the segments.
        name: Of the part of the query that follows the chains.
    """
    chain = (
        select(Segment.id.label("segment_id"), Segment.id.label("last_id"), _next_of(Segment).label("next_id"))
        .where(Segment.id.in_(segment_ids))
        .cte(name, recursive=True)
    )
    later = aliased(Segment)
    chain = chain.union_all(
        select(chain.c.segment_id, later.id, _next_of(later)).join(later, later.id == chain.c.next_id)
    )
    return select(chain.c.segment_id, chain.c.last_id).where(chain.c.next_id.is_(None)).subquery()


def _next_of(segment: type[Segment]) -> ColumnElement[int | None]:
    return case((segment.retired_at.is_not(None), segment.replaced_by_id))
