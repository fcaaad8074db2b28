"""Paths as they are given on the command line, checked before anything that is slow to import or to compute."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from app.errors import InvalidInput, NotFound


def require_there(paths: Iterable[Path]) -> None:
    """Refuse paths that lead nowhere.

    Raises:
        NotFound: Naming the first one.
    """
    for path in paths:
        if not path.exists():
            raise NotFound("there is no such file or folder", where=str(path), hint="is the path right?")


def require_folder_possible(folder: Path) -> None:
    """Refuse an output folder that can't be made because a file is in its place; nothing is made yet.

    Raises:
        InvalidInput: Naming the file.
    """
    file = next((place for place in (folder, *folder.parents) if place.exists()), folder)
    if file.exists() and not file.is_dir():
        raise InvalidInput("a file is where a folder is to be written", where=str(file), expected="a folder")
