"""Where to go on to: never to another site."""

from __future__ import annotations

import re

START = "/"
OWN_PATH = re.compile(r"/(?:[!-.0-\[\]-~][!-\[\]-~]*)?")
"""Begins with one slash: two, or one that leans the other way, would name another site. Plain characters, as browsers
write addresses: others take up to six times the room in a cookie."""


def own_path(given: str) -> str:
    """Return the path where it is one of this site's, the start page's else."""
    return given if OWN_PATH.fullmatch(given) else START
