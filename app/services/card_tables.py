"""How well a dataset's candidates do against the labels that were made of them, source by source; remembered."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import asdict
from threading import Lock
from typing import Any

from app.db.session import Database
from app.evaluation.ground_truth import ground_truth
from app.evaluation.table_one import TableRow, table_one
from app.services.cards import labels_mark
from app.services.datasets import get_dataset
from app.services.labelled_contents import Find, LabelledContent, labelled_contents

SHOWN_IMAGES = 300
"""Images that a page's table is computed from: some seconds' work, and enough for two digits."""
MOST_TABLES = 16
"""Tables that are remembered; each is a few numbers."""


class CardTables:
    """Computes tables, one at a time, and remembers them until a label changes. Safe to use from several threads.

    Args:
        database: Where the labels are.
        find: Detects the candidates of images of which they aren't known; those images are left out without it.
        min_length: Labels of less arc length, px, are ignored.
        most: Images that a table is computed from at most, spread evenly over those that are done; all when left out.
    """

    def __init__(
        self, database: Database, find: Find | None = None, *, min_length: float = 0.0, most: int | None = None
    ) -> None:
        self._database = database
        self._find = find
        self._min_length = min_length
        self._most = most
        self._tables: OrderedDict[str, tuple[TableRow, ...]] = OrderedDict()
        self._lock = Lock()

    def table_of(self, slug: str) -> tuple[TableRow, ...]:
        """Return the table of a dataset; empty while no image with candidates is done.

        Raises:
            NotFound: When there is no such dataset.
        """
        with self._lock:  # of several who ask at once, the first computes
            with self._database.read() as session:
                dataset = get_dataset(session, slug)
                mark = labels_mark(session, dataset)
                known = self._tables.get(mark)
                contents = [] if known is not None else labelled_contents(session, dataset, self._find, most=self._most)
            table = _table(contents, self._min_length) if known is None else known
            self._tables[mark] = table
            self._tables.move_to_end(mark)
            while len(self._tables) > MOST_TABLES:
                self._tables.popitem(last=False)
            return table


def table_content(rows: Sequence[TableRow]) -> list[dict[str, Any]]:
    """Return a table as JSON has it: ``None`` where a number isn't defined, as recall without any label."""
    return [
        {name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in each.items()}
        for each in map(asdict, rows)
    ]


def _table(contents: Sequence[LabelledContent], min_length: float) -> tuple[TableRow, ...]:
    known = [
        (each.source, ground_truth(each.kept, each.ambiguous, min_length), each.candidates)
        for each in contents
        if each.candidates is not None
    ]
    return tuple(table_one(known)) if known else ()
