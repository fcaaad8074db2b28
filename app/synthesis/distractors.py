"""Why an edge that can be seen is no label: kinds of distractors, and the word that a reviewer would reject it with."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

REASON_OF: Mapping[str, str] = MappingProxyType(
    {
        "arch": "curved",
        "car body": "car",
        "curved guard rail": "curved",
        "curved kerb": "curved",
        "curved lane marking": "lane_marking",
        "curved rail": "curved",
        "hanging wire": "curved",
        "lamp arm": "curved",
        "manhole cover": "curved",
        "person": "other",
        "road patch": "other",
        "road seam": "other",
        "round sign": "curved",
        "shadow": "shadow",
        "tree crown": "other",
        "tree trunk": "other",
        "wheel": "car",
    }
)
"""Reason by kind. A shadow's edge may be straight, but it is an edge of light, not of a thing."""
