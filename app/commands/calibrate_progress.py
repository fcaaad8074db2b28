"""Progress of a calibration in the terminal: camera by camera, and what is being done."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

Watch = Callable[[str, int, int], None]


@contextmanager
def calibration_progress(*, console: Console | None = None) -> Iterator[Callable[[str], Watch]]:
    """Show a bar while the block runs; the block gets what gives a camera its watch.

    Where the output is no terminal nothing is drawn.
    """
    console = console or Console(stderr=True)
    columns = (SpinnerColumn(), TextColumn("{task.description}", markup=False), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, disable=not console.is_terminal, transient=True) as progress:
        task = progress.add_task("Calibrating", total=None)

        def of_camera(name: str) -> Watch:
            def watch(stage: str, done: int, total: int) -> None:
                progress.update(task, description=f"Calibrating {name}: {stage}", completed=done, total=total)

            return watch

        yield of_camera
