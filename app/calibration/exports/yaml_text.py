"""YAML with comments before it, lists of numbers on one line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import yaml


def commented_yaml(lines: Sequence[str], fields: Mapping[str, Any]) -> bytes:
    """Return UTF-8 YAML.

    Args:
        lines: Comments, each without line breaks.
        fields: Plain numbers, texts, lists and mappings, written in their order.
    """
    head = "".join(f"# {line}\n" for line in lines)
    body = yaml.safe_dump(dict(fields), sort_keys=False, default_flow_style=None, allow_unicode=True, width=10_000)
    return (head + body).encode()
