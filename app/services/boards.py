"""Leaderboards: one best row per method, its numbers with intervals, and its rank as an interval."""

from __future__ import annotations

import csv
import hashlib
import io
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from threading import Lock

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Method, Score, Split, SplitVersion, Submission
from app.errors import InvalidInput
from app.evaluation.bootstrap import DRAWS, FEWEST_CLUSTERS, LEVEL
from app.evaluation.ranking import Rank, ranks
from app.services.access import Viewer, can_see_details
from app.services.board_rows import Entry, best_entries, clusters_in, scored_entries
from app.services.score_totals import Totals, merged_totals, official_warning, shown_totals
from app.services.splits import get_version
from app.services.submission_access import shown_person
from app.services.submission_states import RANK_PROTOCOL
from app.services.submission_views import SplitName

RANKED = ("method", "baseline")
COLUMNS = (
    *("f1", "precision", "recall", "ap", "mean_f1", "completeness", "correctness", "quality"),
    *("offset_mean", "angle_error", "mean_liou", "calibration_rms", "calibration_grid"),
    *("official_precision", "official_recall", "official_f1", "fixed_f1"),
)
"""Metrics of the CSV file."""
MOST_BOARDS = 32


@dataclass(frozen=True)
class BoardMethod:
    """A method as the board names it."""

    slug: str
    name: str
    kind: str
    code_url: str | None
    paper_url: str | None


@dataclass(frozen=True)
class BoardRow:
    """The best submission of a method; a ceiling isn't ranked."""

    rank_low: int | None
    rank_high: int | None
    tied_with: tuple[str, ...]
    method: BoardMethod
    submission_id: int | None
    label: str | None
    person: str | None
    scored_at: datetime | None
    totals: Totals
    warning: str | None


@dataclass(frozen=True)
class Board:
    """The board of a split version."""

    split: SplitName
    version: int
    protocol: str
    protocol_version: str
    draws: int
    level: float
    rows: tuple[BoardRow, ...]


@dataclass(frozen=True)
class Standing:
    """Best entries and their ranks, without names and numbers: what takes long to work out."""

    submissions: tuple[int, ...]
    scores: tuple[int, ...]
    ranks: tuple[Rank | None, ...]


class BoardCache:
    """Remembers standings by what they are made of, so that a board that hasn't changed is answered at once.

    Safe to use from several threads.
    """

    def __init__(self) -> None:
        self._latest: OrderedDict[str, Standing] = OrderedDict()
        self._lock = Lock()

    def get(self, key: str) -> Standing | None:
        """Return a standing that is remembered."""
        with self._lock:
            return self._latest.get(key)

    def put(self, key: str, standing: Standing) -> None:
        """Remember one; the oldest goes."""
        with self._lock:
            self._latest[key] = standing
            while len(self._latest) > MOST_BOARDS:
                self._latest.popitem(last=False)


def board_of(
    session: Session,
    viewer: Viewer,
    split: Split,
    cache: BoardCache,
    *,
    version: int | None = None,
    protocol: str = RANK_PROTOCOL.name,
    protocol_version: str | None = None,
) -> Board:
    """Return a split's board.

    Args:
        session: Any session.
        viewer: Who asks; of a hidden split those below maintainer see three rounded numbers.
        split: The split.
        cache: Of standings.
        version: Number of the version; the newest when left out.
        protocol: What to rank by; only clearlines-v2 ranks.
        protocol_version: The current one when left out.

    Raises:
        NotFound: When there is no such version.
        InvalidInput: When the protocol doesn't rank.
    """
    if protocol != RANK_PROTOCOL.name:
        raise InvalidInput(f"{protocol!r:.60} is no rank key", where="protocol", expected=RANK_PROTOCOL.name)
    chosen = get_version(session, split, version)
    under = protocol_version or RANK_PROTOCOL.version
    hidden = split.visibility == "hidden"
    details = can_see_details(viewer, split.visibility)
    key = _fingerprint(session, chosen, protocol, under)
    standing = cache.get(key)
    if standing is None:
        best = best_entries(scored_entries(session, chosen, protocol, under), hidden=hidden)
        standing = _standing(best, clusters=len(set(clusters_in(session, chosen).tolist())))
        cache.put(key, standing)
    rows = _rows(session, viewer, standing, details=details)
    name = SplitName(split.slug, split.name, split.visibility)
    return Board(name, chosen.number, protocol, under, DRAWS, LEVEL, rows)


def board_csv(board: Board) -> str:
    """Return a board as CSV, one line per row, metrics with the ends of their intervals."""
    columns = [name for name in COLUMNS if any(name in row.totals for row in board.rows)]
    sink = io.StringIO()
    writer = csv.writer(sink, lineterminator="\n")
    head = ["rank_low", "rank_high", "method", "name", "kind", "label", "person", "scored_at", "code_url", "paper_url"]
    writer.writerow([*head, *(f"{name}{end}" for name in columns for end in ("", "_low", "_high")), "warning"])
    for row in board.rows:
        numbers = [(row.totals.get(name) or {}).get(part) for name in columns for part in ("value", "low", "high")]
        method = row.method
        words = [method.slug, method.name, method.kind, row.label, row.person]
        said = [_harmless(word) for word in (*words, row.scored_at and row.scored_at.isoformat())]
        links = [_harmless(method.code_url), _harmless(method.paper_url)]
        writer.writerow([row.rank_low, row.rank_high, *said, *links, *numbers, row.warning])
    return sink.getvalue()


def _harmless(word: str | None) -> str | None:
    """Return a word that no spreadsheet takes for a formula."""
    return f"'{word}" if word and word[0] in "=+-@\t\r" else word


def _fingerprint(session: Session, version: SplitVersion, protocol: str, protocol_version: str) -> str:
    """Return what tells this set of entries from every other: which scores there are, and when the last one came."""
    conditions = (
        Score.split_version_id == version.id,
        Score.protocol == protocol,
        Score.protocol_version == protocol_version,
        Score.status == "done",
        Submission.status == "scored",
        Submission.visibility == "public",
    )
    rows = session.execute(
        select(Score.id, Score.done_at, Submission.method_id)
        .join(Score.submission)
        .where(*conditions)
        .order_by(Score.id)
    ).all()
    text = repr([(version.truth_hash, version.id, *row) for row in rows])
    return hashlib.sha256(text.encode()).hexdigest()


def _standing(best: Sequence[Entry], *, clusters: int) -> Standing:
    kinds = [entry.submission.method.kind in RANKED for entry in best]
    ranked = [entry for entry, counts in zip(best, kinds, strict=True) if counts]
    drawn = np.array([entry.drawn for entry in ranked])
    if clusters < FEWEST_CLUSTERS:  # nothing varies, which says nothing about chance: all are tied
        drawn = np.zeros((len(ranked), 1))
    places = iter(ranks(drawn)) if ranked else iter(())
    found = tuple(next(places) if counts else None for counts in kinds)
    return Standing(tuple(entry.submission.id for entry in best), tuple(entry.score.id for entry in best), found)


def _rows(session: Session, viewer: Viewer, standing: Standing, *, details: bool) -> tuple[BoardRow, ...]:
    found = {
        submission.id: (submission, score, method)
        for submission, score, method in session.execute(
            select(Submission, Score, Method)
            .join(Score, Score.submission_id == Submission.id)
            .join(Method, Method.id == Submission.method_id)
            .where(Score.id.in_(standing.scores))
        )
    }
    slugs = [
        found[submission][2].slug
        for submission, rank in zip(standing.submissions, standing.ranks, strict=True)
        if rank is not None
    ]
    rows = []
    for submission_id, rank in zip(standing.submissions, standing.ranks, strict=True):
        submission, score, method = found[submission_id]
        totals = merged_totals(score.totals)
        rows.append(
            BoardRow(
                rank_low=None if rank is None else rank.low,
                rank_high=None if rank is None else rank.high,
                tied_with=() if rank is None else tuple(slugs[place] for place in rank.tied_with),
                method=BoardMethod(method.slug, method.name, method.kind, method.code_url, method.paper_url),
                submission_id=submission.id,
                label=submission.label,
                person=shown_person(viewer, method, submission.person),
                scored_at=submission.scored_at,
                totals=shown_totals(totals, details=details),
                warning=official_warning(totals) if details else None,
            )
        )
    return tuple(rows)
