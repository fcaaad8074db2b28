"""Progress in the terminal: one bar, with what is being done, and how long it will take."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TaskID,
    TaskProgressColumn,
    TextColumn,
    TimeRemainingColumn,
)

ProgressCallback = Callable[[int, int], None]
NamedProgressCallback = Callable[[str, int, int], None]


@contextmanager
def progress_bar(label: str, *, console: Console | None = None) -> Iterator[ProgressCallback]:
    """Show a bar while the block runs; the block calls what it gets with ``(done, total)``.

    Where the output is no terminal nothing is drawn, so that logs and pipes stay clean.
    """
    console = console or Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TaskProgressColumn())
    with Progress(*columns, TimeRemainingColumn(), console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task(label, total=None)

        def report(done: int, total: int) -> None:
            progress.update(task, completed=done, total=total)

        yield report


@contextmanager
def progress_bars(*, console: Console | None = None) -> Iterator[NamedProgressCallback]:
    """Show a bar for each thing that is being done; the block calls what it gets with ``(name, done, total)``.

    Those of nothing to do aren't shown; where the output is no terminal nothing is drawn.
    """
    console = console or Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TaskProgressColumn())
    with Progress(*columns, TimeRemainingColumn(), console=console, disable=not console.is_terminal) as progress:
        tasks: dict[str, TaskID] = {}

        def report(name: str, done: int, total: int) -> None:
            if total and name not in tasks:
                tasks[name] = progress.add_task(name, total=total)
            if name in tasks:
                progress.update(tasks[name], completed=done, total=total)

        yield report
