"""What every benchmark shares: arguments, a table, and one JSON object as the last line."""

from __future__ import annotations

import argparse
import json
import os
import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
FOLDERS = ("york", "kitti", "carnd")


@dataclass(frozen=True)
class Target:
    """What a figure should reach.

    Attributes:
        figure: Name of the figure.
        bound: The bound.
        at_most: Whether the figure may not be above it; else it may not be below.
    """

    figure: str
    bound: float
    at_most: bool = True

    def met(self, figures: Mapping[str, float | None]) -> bool:
        """Whether a figure reaches the bound; a missing one doesn't."""
        value = figures.get(self.figure)
        return value is not None and (value <= self.bound if self.at_most else value >= self.bound)


def arguments(description: str, *folders: str) -> argparse.Namespace:
    """Read ``--json`` and a folder per name, by default under the data that lies beside the project."""
    return argument_parser(description, *folders).parse_args()


def argument_parser(description: str, *folders: str) -> argparse.ArgumentParser:
    """Return the parser of `arguments`, for a program that takes more.

    Folders of other benchmarks are read as well, so that all of them can be run with the same arguments.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--json", action="store_true", help="print one JSON object as the last line")
    for folder in dict.fromkeys((*folders, *FOLDERS)):
        words = f"default: {DATA / folder}" if folder in folders else argparse.SUPPRESS
        parser.add_argument(f"--{folder}", type=Path, default=DATA / folder, help=words)
    return parser


def show_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table; the first column is text, the others are figures."""
    table = Table(title=title, title_justify="left")
    for index, column in enumerate(columns):
        table.add_column(column, justify="right" if index else "left")
    for row in rows:
        table.add_row(*row)
    Console(width=120).print(table)


def finish(figures: Mapping[str, float | None], targets: Sequence[Target], *, as_json: bool) -> None:
    """Print whether the targets are met and, if asked, everything as the last line."""
    for target in targets:
        word = "met" if target.met(figures) else "NOT MET"
        sign = "<=" if target.at_most else ">="
        print(f"{word}: {target.figure} {figures.get(target.figure)} {sign} {target.bound}")
    load = os.getloadavg()[0]
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, load {load:.1f}")
    if as_json:
        named = {target.figure: {"bound": target.bound, "at_most": target.at_most} for target in targets}
        met = all(target.met(figures) for target in targets)
        print(json.dumps({"figures": dict(figures), "targets": named, "met": met}))
