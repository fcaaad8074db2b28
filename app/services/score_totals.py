"""The totals of a score, as far as a viewer may see them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

DIGITS = 3
"""Of the numbers of a hidden split: more digits would tell more of its labels."""
ROUNDED = ("f1", "precision", "recall")
"""What of a hidden split is told at all."""
MORE_THAN_ONE = "the recall of official-v1 is above 1: several predictions count for one label, so its F1 says little"

Totals = dict[str, dict[str, float | None]]


def merged_totals(stored: Mapping[str, Any] | None) -> Totals:
    """Return the totals of all protocols by metric; their names differ.

    Args:
        stored: As ``score_totals`` returned it.
    """
    merged: Totals = {}
    for protocol in ((stored or {}).get("protocols") or {}).values():
        merged |= protocol["totals"]
    return merged


def shown_totals(totals: Totals, *, details: bool) -> Totals:
    """Return what a viewer may see: everything, or three rounded numbers with their intervals."""
    if details:
        return totals
    return {name: {part: _rounded(value) for part, value in totals[name].items()} for name in ROUNDED if name in totals}


def official_warning(totals: Totals) -> str | None:
    """Return what to say beside the official-v1 columns, if anything."""
    recall = (totals.get("official_recall") or {}).get("value")
    return MORE_THAN_ONE if recall is not None and recall > 1 else None


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, DIGITS)
